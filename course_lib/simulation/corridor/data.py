"""Everything under data/corridor from one seed: true world, surveyed map, planar map, two recorded runs, checksums.

Everything is made beside its place and put there at the end: a run that is stopped leaves the old data as they were,
and what was made goes, with the next run where this one was killed.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path

import cv2
import numpy as np
from numpy.random import Generator

from course_lib.files import staging_dir
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.measurements import hole_share, map_error, noise_on_a_wall
from course_lib.simulation.corridor.mesh_building import WorldMesh, write_ply, write_world_ply
from course_lib.simulation.corridor.parameters import corridor_parameters
from course_lib.simulation.corridor.planar_map import planar_simplification
from course_lib.simulation.corridor.recorded_runs import (
    FRAME_RATE,
    FloorSurveyModel,
    HandModel,
    WagonModel,
    hand_run,
    steps_and_turns,
    wagon_run,
)
from course_lib.simulation.corridor.recording import record
from course_lib.simulation.corridor.surface_fusion import FusionModel, fuse, simplify
from course_lib.simulation.corridor.world import LENGTH, make_corridor
from course_lib.simulation.data_folder import checksums, require_folder
from course_lib.simulation.sensors.laser_survey import STATIONS, ScannerModel, registration_error, survey
from course_lib.simulation.sensors.ray_casting import WorldCaster
from course_lib.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

# What is made; other files of the folder (its README) stay.
PRODUCTS = (
    "true_world.ply",
    "map.ply",
    "planar_map.ply",
    "wagon",
    "hand",
    "summary.json",
    "PARAMETERS.md",
    "SHA256SUMS",
)
PLANAR_DISTANCE = 0.05  # m within which a triangle belongs to a plane; chosen
PLANAR_LEAST_AREA = 1.0  # m^2; chosen: "large planar segments"

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
    """Makes the data in folder `out` and returns what `summary.json` holds. One seed gives one set of bytes.

    progress(items, text) wraps the loops, for progress bars. Raises `ValueError` where `out` cannot be a folder.
    """
    out, models = require_folder(out), models or CorridorModels()
    generators = np.random.default_rng(seed).spawn(7)
    world_rng, survey_rng, planar_rng, camera_rng, wagon_rng, hand_rng, measure_rng = generators
    with staging_dir(out, PRODUCTS) as folder:
        world = make_corridor(world_rng)
        write_world_ply(folder / "true_world.ply", world.run_day, "corridor, true world of the run day; CC BY 4.0")
        measured = {"map": _make_map(folder, world.survey_day, models, survey_rng, planar_rng, measure_rng, progress)}
        camera = TimeOfFlightCamera(DepthCamera.sr4000(), models.camera, camera_rng)
        wagon = wagon_run(models.wagon, world.clutter_boxes, wagon_rng)
        hand = hand_run(models.hand, world.clutter_boxes, hand_rng)
        for name, run, rng in (("wagon", wagon, wagon_rng), ("hand", hand, hand_rng)):
            measured[name] = _record(folder / name, world.run_day, camera, run, models, rng, progress)
        measured["noise_on_a_wall_m"] = {
            f"{distance} m": noise_on_a_wall(models.camera, distance, measure_rng) for distance in (2, 5, 8)
        }
        summary = {"seed": seed, "models": asdict(models), "measured": _rounded(measured)}
        (folder / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
        (folder / "PARAMETERS.md").write_text(corridor_parameters(models))
        (folder / "SHA256SUMS").write_text(checksums(folder, PRODUCTS))
    return summary


def _make_map(
    folder: Path,
    surveyed: WorldMesh,
    models: CorridorModels,
    rng: Generator,
    planar_rng: Generator,
    measure_rng: Generator,
    progress: Progress,
) -> dict:
    """Surveys the world as it is given, writes map.ply and planar_map.ply; returns what was measured on them."""
    caster = WorldCaster.of(surveyed)
    scans = survey(caster, models.scanner, rng, progress(models.stations, "surveying from the stations"))
    registered = [scan.as_registered() for scan in scans]
    vertices, faces = fuse(registered, models.fusion, lambda slabs: progress(slabs, "fusing the scans"))
    for _ in progress(range(1), "decimating the map"):
        vertices, faces = simplify(vertices, faces, models.fusion)
    write_ply(folder / "map.ply", vertices, faces, "corridor map, simulated laser survey; CC BY 4.0")
    for _ in progress(range(1), "finding the large planes"):
        planar = planar_simplification(SceneMap(vertices, faces), planar_rng, PLANAR_DISTANCE, PLANAR_LEAST_AREA)
    write_ply(folder / "planar_map.ply", planar.vertices, planar.faces, "corridor map, large planes only; CC BY 4.0")
    return {
        "triangles": len(faces),
        "planar_triangles": len(planar.faces),
        "hole_share": hole_share(vertices, faces, caster, LENGTH, measure_rng),
        "registration": registration_error(scans, measure_rng),
        "distance_to_surveyed_world": map_error(vertices, faces, surveyed, measure_rng),
        "planar_distance_to_surveyed_world": map_error(planar.vertices, planar.faces, surveyed, measure_rng),
    }


def _record(
    folder: Path,
    world: WorldMesh,
    camera: TimeOfFlightCamera,
    run: tuple[np.ndarray, np.ndarray],
    models: CorridorModels,
    rng: Generator,
    progress: Progress,
) -> dict:
    """Records one run; returns rates over its pixels and the sizes of its steps."""
    states = run[0]
    text = f"recording the {folder.name} run"
    total = record(folder, world, camera, run, models.floor_survey, rng, lambda items: progress(items, text))
    _shrink(folder / "depth")
    steps, turns = steps_and_turns(states)
    return {
        "frames": len(states),
        "frames_per_second": FRAME_RATE,
        "length_m": float(steps.sum()),
        "step_mean_m": float(steps.mean()),
        "step_max_m": float(steps.max()),
        "turn_max_deg": float(np.rad2deg(turns.max())),
        "no_return_share": total["no_return"] / total["pixels"],
        "nothing_there_share": total["nothing_there"] / total["pixels"],
        "saturated_share": total["saturated"] / total["pixels"],
        "beyond_unambiguous_range_share": total["beyond_range"] / total["pixels"],
        "wrapped_share": total["wrapped"] / total["pixels"],
        "flying_share": total["flying"] / total["pixels"],
    }


def _shrink(folder: Path) -> None:
    """Writes the depth images again as smaller PNGs: in a noisy image nothing repeats, so Huffman coding alone wins."""
    options = [cv2.IMWRITE_PNG_COMPRESSION, 9, cv2.IMWRITE_PNG_STRATEGY, cv2.IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY]
    for path in sorted(folder.glob("*.png")):
        image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        path.write_bytes(cv2.imencode(".png", image, options)[1].tobytes())


def _rounded(value: object) -> object:
    """Numbers to five significant digits, so that the file does not depend on the last bits."""
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, float):
        return float(f"{value:.5g}") if np.isfinite(value) else None
    return value
