"""Everything under data/corridor from one seed: true world, surveyed map, planar map, two recorded runs, checksums."""

import json
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path

import cv2
import numpy as np
import trimesh
from numpy.random import Generator

from course_lib.files import staging_dir
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from courseware.paths import data_path
from courseware.simulation.corridor.mesh_building import WorldMesh, to_polydata, write_ply, write_world_ply
from courseware.simulation.corridor.recorded_runs import (
    FRAME_RATE,
    FloorSurveyModel,
    HandModel,
    WagonModel,
    hand_run,
    steps_and_turns,
    wagon_run,
)
from courseware.simulation.corridor.seeded_recording import SeedModels, record
from courseware.simulation.corridor.surface_fusion import FusionModel, fuse, simplify
from courseware.simulation.corridor.world import LENGTH, make_corridor
from courseware.simulation.data_folder import checksums, parameter_table, parameter_tables
from courseware.simulation.sensors.laser_survey import STATIONS, ScannerModel, registration_error, survey
from courseware.simulation.sensors.ray_casting import WorldCaster
from courseware.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel
from tools.planar_map import planar_simplification

# What is made; other files of the folder (its README) stay.
MADE = ("true_world.ply", "map.ply", "planar_map.ply", "wagon", "hand", "summary.json", "PARAMETERS.md")
PRODUCTS = (*MADE, "SHA256SUMS")
PLANAR_DISTANCE = 0.05  # m within which a triangle belongs to a plane; chosen
PLANAR_MIN_AREA = 1.0  # m^2; chosen: "large planar segments"

Progress = Callable[[Iterable, str], Iterable]


@dataclass(frozen=True)
class CorridorModels:
    """All parameters of the corridor's data. The defaults are the shipped data's; tests take smaller ones."""

    scanner: ScannerModel = field(default_factory=ScannerModel)
    fusion: FusionModel = field(default_factory=FusionModel)
    camera: TimeOfFlightModel = field(default_factory=TimeOfFlightModel)
    wagon: WagonModel = field(default_factory=WagonModel)
    hand: HandModel = field(default_factory=HandModel)
    floor_survey: FloorSurveyModel = field(default_factory=FloorSurveyModel)
    stations: tuple[tuple[float, float], ...] = STATIONS


def make_corridor_data(
    out: str | Path, seed: int, models: CorridorModels | None = None, progress: Progress = lambda items, text: items
) -> dict:
    """Make the data in folder `out` and return what `summary.json` holds. One seed gives one set of bytes.

    progress(items, text) wraps the loops, for progress bars. A run that is stopped leaves the old data as they were.
    """
    models = models or CorridorModels()
    spawned = np.random.default_rng(seed).spawn(7)
    world_rng, survey_rng, planar_rng, camera_rng, wagon_rng, hand_rng, measure_rng = spawned
    with staging_dir(out, PRODUCTS) as folder:
        world = make_corridor(world_rng)
        write_world_ply(folder / "true_world.ply", world.run_day, "corridor, true world of the run day; CC BY 4.0")
        generators = [survey_rng, planar_rng, measure_rng]
        measured = {"map": _make_map(folder, world.survey_day, models, generators, progress)}
        camera = TimeOfFlightCamera(DepthCamera.sr4000(), models.camera, camera_rng)
        wagon = wagon_run(models.wagon, world.clutter_boxes, wagon_rng)
        hand = hand_run(models.hand, world.clutter_boxes, hand_rng)
        for name, run, rng in (("wagon", wagon, wagon_rng), ("hand", hand, hand_rng)):
            measured[name] = _record(folder / name, world.run_day, camera, run, models.floor_survey, rng, progress)
        measured["noise_on_a_wall_m"] = {
            f"{distance} m": noise_on_a_wall(models.camera, distance, measure_rng) for distance in (2, 5, 8)
        }
        summary = {"seed": seed, "models": asdict(models), "measured": _rounded(measured)}
        (folder / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
        (folder / "PARAMETERS.md").write_text(corridor_parameters(models))
        (folder / "SHA256SUMS").write_text(checksums(folder, PRODUCTS))
    return summary


def _make_map(folder: Path, surveyed: WorldMesh, models: CorridorModels, generators: list, progress: Progress) -> dict:
    """Survey the world as it is given, write map.ply and planar_map.ply, and return what was measured on them."""
    rng, planar_rng, measure_rng = generators
    caster = WorldCaster(surveyed.vertices, surveyed.faces, surveyed.reflectivity)
    scans = survey(caster, models.scanner, rng, progress(models.stations, "surveying from the stations"))
    registered = [scan.as_registered() for scan in scans]
    vertices, faces = fuse(registered, models.fusion, lambda slabs: progress(slabs, "fusing the scans"))
    for _ in progress(range(1), "decimating the map"):
        vertices, faces = simplify(vertices, faces, models.fusion)
    write_ply(folder / "map.ply", vertices, faces, "corridor map, simulated laser survey; CC BY 4.0")
    for _ in progress(range(1), "finding the large planes"):
        planar = planar_simplification(SceneMap(vertices, faces), planar_rng, PLANAR_DISTANCE, PLANAR_MIN_AREA)
    write_ply(folder / "planar_map.ply", planar.vertices, planar.faces, "corridor map, large planes only; CC BY 4.0")
    return {
        "triangles": len(faces),
        "planar_triangles": len(planar.faces),
        "hole_share": hole_share(vertices, faces, caster, LENGTH, measure_rng),
        "registration": registration_error(scans, measure_rng),
        "distance_to_surveyed_world": map_error(vertices, faces, surveyed, measure_rng),
        "planar_distance_to_surveyed_world": map_error(planar.vertices, planar.faces, surveyed, measure_rng),
    }


def _record(folder: Path, world: WorldMesh, camera, run: tuple, floor_survey, rng: Generator, progress) -> dict:
    """Record one run; return rates over its pixels and the sizes of its steps."""
    text = f"recording the {folder.name} run"
    total = record(folder, world, camera, run, floor_survey, rng, lambda items: progress(items, text))
    # The images again as smaller PNGs: in a noisy image nothing repeats, so Huffman coding alone wins.
    options = [cv2.IMWRITE_PNG_COMPRESSION, 9, cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY]
    for path in sorted((folder / "depth").glob("*.png")):
        image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        path.write_bytes(cv2.imencode(".png", image, options)[1].tobytes())
    steps, turns = steps_and_turns(run[0])
    counts = {"beyond_range": "beyond_unambiguous_range"}
    shares = ("no_return", "nothing_there", "saturated", "beyond_range", "wrapped", "flying")
    return {
        "frames": len(run[0]),
        "frames_per_second": FRAME_RATE,
        "length_m": float(steps.sum()),
        "step_mean_m": float(steps.mean()),
        "step_max_m": float(steps.max()),
        "turn_max_deg": float(np.rad2deg(turns.max())),
        **{f"{counts.get(name, name)}_share": total[name] / total["pixels"] for name in shares},
    }


def _rounded(value: object) -> object:
    """Numbers to five significant digits, so that the file does not depend on the last bits."""
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, float):
        return float(f"{value:.5g}") if np.isfinite(value) else None
    return value


def map_error(
    map_vertices: np.ndarray, map_faces: np.ndarray, world: WorldMesh, rng: Generator, n_points: int = 50_000
) -> dict[str, float]:
    """Distance in metres from points drawn on the map, by area, to the surface of the surveyed world."""
    corners = map_vertices[map_faces].astype(np.float64)
    areas = trimesh.triangles.area(corners)
    face = rng.choice(len(areas), n_points, p=areas / areas.sum())
    u, v = np.sort(rng.random((2, n_points)), axis=0)
    points = np.einsum("nk,nkd->nd", np.stack([u, v - u, 1 - v], axis=1), corners[face])
    distance = _distance(points, world.vertices, world.faces)
    median, p90 = np.percentile(distance, (50, 90)).tolist()
    return {"median_m": median, "p90_m": p90, "mean_m": float(distance.mean()), "area_m2": float(areas.sum())}


def hole_share(
    map_vertices: np.ndarray, map_faces: np.ndarray, surveyed: WorldCaster, length: float, rng: Generator
) -> float:
    """Share of the surveyed world, as eyes all along the corridor of `length` metres see it, with no map within 5 cm.

    100,000 rays in all directions from places at most 0.6 m beside the middle, 0.4 to 2.0 m above the floor; what they
    meet of the survey day's world counts as mapped where the map lies within 0.05 m.
    """
    eyes = rng.uniform([1.0, -0.6, 0.4], [length - 1.0, 0.6, 2.0], (100_000, 3))
    directions = rng.normal(size=eyes.shape)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    distance = surveyed.cast(eyes, directions).distance
    hit = np.isfinite(distance)
    points = eyes[hit] + directions[hit] * distance[hit][:, None]
    return float((_distance(points, map_vertices, map_faces) > 0.05).mean())


def _distance(points: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Distances `(n,)` of points `(n, 3)` from a surface, metres."""
    nearest = to_polydata(vertices, faces).find_closest_cell(points, return_closest_point=True)[1]
    return np.linalg.norm(points - nearest, axis=1)


def noise_on_a_wall(model: TimeOfFlightModel, distance: float, rng: Generator, reflectivity: float = 0.72) -> float:
    """Standard deviation in metres over 50 frames of the central pixels' depth of a wall met squarely at `distance`.

    nan where fewer than nine in ten of the pixels come back.
    """
    vertices = np.array([[distance, y, z] for y in (-5.0, 5.0) for z in (-5.0, 5.0)])
    wall = WorldCaster(vertices, np.array([[0, 1, 2], [1, 3, 2]]), reflectivity)
    camera = TimeOfFlightCamera(DepthCamera.sr4000().resized(44, 36), model, rng)
    depths = np.stack([camera.capture(wall, np.zeros(6), rng).depth for _ in range(50)])[:, 14:22, 18:26]
    return float(np.sqrt(np.nanmean(np.nanvar(depths, axis=0)))) if np.isfinite(depths).mean() >= 0.9 else float("nan")


# What flatters the results: what the simulation grants, what is real, and the hardship that takes it away in a seed's
# recording. Where there is no hardship, the effect is not measured.
IDEALIZATIONS = (
    ("focal lengths are exactly those told", "wrong by 1 %", "focal length"),
    ("no lens distortion is left over", "half a pixel in the corners", "lens distortion"),
    ("the camera sits exactly where it is told to, z included", "5 mm off on each axis", "mount position"),
    ("roll, pitch and heading of the mount are exact", "0.3 degrees off on each axis", "mount angle"),
    (
        "the wagon keeps its speed within 1.5 % and its heading within a degree or two",
        "pushed by hand: speed varies by tens of percent, stops, sways with each step",
        "pushed by hand",
    ),
    ("the principal point is exactly that told", "a pixel or two off; acts much like 0.3 degrees", ""),
    ("the first pose is exact", "measured with a tape", ""),
    ("true poses are exact, and of the very instant of each image", "surveyed and synchronized", ""),
    ("the floor is level and flat; wheels lift by at most 2 mm, 0.2 degrees", "thresholds, cables, slopes", ""),
    ("people stand still", "they walk, and follow whom they watch", ""),
    ("light takes one path", "corners and glossy floors send it over two", ""),
    ("an image is taken in an instant", "four exposures, blurred and torn by motion", ""),
    ("the camera is warm and its error patterns do not drift", "centimetres in the first half hour", ""),
    ("surfaces are Lambertian; glass is not there at all", "gloss, mirrors, glass doors, sunlight", ""),
    ("one building and one map, whatever the seed", "every building is another", ""),
)


def corridor_parameters(models: object) -> str:
    """PARAMETERS.md for `models`, a `CorridorModels`: their tables, those of the recordings, and the idealizations."""
    seeds = SeedModels()
    own = [parameter_table(model) for model in (seeds.day, seeds.push, seeds.calibration)]
    return "\n".join([parameter_tables(models, "corridor"), *own, _idealization_table()])


def _idealization_table() -> str:
    """The idealizations as Markdown, with the effects that `demo corridor --idealizations` measured."""
    stored = json.loads(data_path("corridor/results/kindnesses.json").read_text())["hardships"]
    errors = {name: (row["median_m"]["median"], row["median_timed_m"]["median"]) for name, row in stored.items()}
    effects = {name: " / ".join(f"{1000 * error:.0f}" for error in pair) + " mm" for name, pair in errors.items()}
    rows = [f"| {granted} | {real} | {effects.get(name, 'not measured')} |" for granted, real, name in IDEALIZATIONS]
    none, everything = effects["none"], effects["all"]
    head = f"""## What the simulation grants

Median errors of the paper's method (nearest point of the path / same frame) on recordings with one
hardship alone, the median over three tuning seeds at 44 x 36 pixels, 120 frames. With none of them: {none}; with all
that are measured, as in the second part of table 1: {everything}.

| granted | real | median error with it |
|---|---|---|"""
    return "\n".join([head, *rows, ""])
