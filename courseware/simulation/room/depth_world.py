"""A furnished room as paper 1 sees it: its laser-scanned mesh map, and what a carried depth camera measures in it."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.random import Generator

from course_lib.depth_mcl.sequence import write_sequence
from course_lib.geometry import optical_pose, wrap_angle
from course_lib.rendering.camera import DepthCamera
from courseware.simulation.corridor.mesh_building import write_ply
from courseware.simulation.corridor.recorded_runs import smooth_signal
from courseware.simulation.corridor.surface_fusion import FusionModel, fuse, simplify
from courseware.simulation.furniture.solids import merged
from courseware.simulation.room.furnishing import make_look_alike_room
from courseware.simulation.room.scene import NoFreePlace, Room, clear_of, footprint, free_places
from courseware.simulation.sensors.laser_survey import ScannerModel, survey
from courseware.simulation.sensors.ray_casting import WorldCaster
from courseware.simulation.sensors.time_of_flight import TimeOfFlightCamera, TimeOfFlightModel

STREAM = 77  # joins a seed's generators of what the depth camera meets: apart from those of the photographs
MAP, CAMERA, PLACE, WALK, WALK_CAMERA = range(1, 6)
MAX_BEGINNINGS = 100
REFLECTIVITY = 0.6  # of every surface, at 850 nm: textures say nothing of it (chosen: paint and cloth)


@dataclass(frozen=True)
class DepthSurveyModel:
    """How a room is scanned for a mesh map."""

    stations: int = 4  # chosen: a room is scanned from its corners
    scanner: ScannerModel = field(default_factory=lambda: ScannerModel(step_deg=0.3))  # chosen: a room is small
    fusion: FusionModel = field(default_factory=lambda: FusionModel(triangles=60_000))  # chosen


def depth_caster(room: Room) -> WorldCaster:
    """What a depth camera's rays meet in a room."""
    meshes = [*room.shell, *(mesh for thing in room.objects for mesh in thing.meshes)]
    return WorldCaster(*merged(meshes), REFLECTIVITY)


def surveyed_mesh(room: Room, model: DepthSurveyModel, rng: Generator) -> tuple[np.ndarray, np.ndarray]:
    """The room's mesh map, vertices `(V, 3)` metres and faces `(F, 3)`, from scans at free places."""
    stations = tuple((float(x), float(y)) for x, y in free_places(room, model.stations, rng))
    scans = survey(depth_caster(room), model.scanner, rng, stations)
    return simplify(*fuse([scan.as_registered() for scan in scans], model.fusion), model.fusion)


@dataclass(frozen=True)
class WalkModel:
    """How the camera is carried through a room."""

    frames: int = 120  # number of frames; chosen
    frames_per_second: float = 10.0  # frames per second; chosen, within the SR4000's rates
    step: float = 0.08  # m between frames on a straight stretch; chosen: a slow walk
    clearance: float = 0.25  # m from the way to furniture; chosen
    shortest_stretch: float = 0.7  # m from one place to the next; chosen
    rounding: float = 3.0  # frames over which corners of the way are rounded; chosen
    turning: float = 6.0  # frames over which the way's direction is followed; chosen
    height: float = 1.35  # m, camera above the floor; chosen: held before the chest
    height_sway: float = 0.06  # m, one sigma; chosen
    pitch_deg: float = 8.0  # degrees, mean pitch: it looks down a little; chosen
    tilt_sway_deg: float = 6.0  # degrees, one sigma, of roll and pitch; chosen
    look_deg: float = 20.0  # degrees, one sigma, of the view's turn from the way forward; chosen
    sway_frames: float = 8.0  # frames over which the hand sways and the view turns; chosen


def record_walk(
    folder: Path, seed: int, mesh: DepthSurveyModel = DepthSurveyModel(), walk: WalkModel = WalkModel()
) -> None:
    """Write a seed's recording and its mesh map, map.ply, to a new `folder`. Same seed, same bytes."""
    room = make_look_alike_room(seed)
    vertices, faces = surveyed_mesh(room, mesh, np.random.default_rng([STREAM, seed, MAP]))
    states = walk_states(room, walk, np.random.default_rng([STREAM, seed, WALK]))
    pattern_rng, noise_rng = np.random.default_rng([STREAM, seed, WALK_CAMERA]).spawn(2)
    sensor = TimeOfFlightCamera(DepthCamera.sr4000(), TimeOfFlightModel(), pattern_rng)
    caster = depth_caster(room)
    depths = [sensor.capture(caster, state, noise_rng).depth for state in states]
    times = np.arange(len(states)) / walk.frames_per_second
    write_sequence(folder, sensor.camera.matrix, list(range(len(states))), depths, optical_pose(states), times, "z")
    write_ply(folder / "map.ply", vertices, faces, "generated room, simulated laser survey; CC BY 4.0")


def walk_states(room: Room, model: WalkModel, rng: Generator) -> np.ndarray:
    """True states `(frames, 6)` of the camera. Raises `NoFreePlace` for a room in which nobody can walk."""
    way = smoothed(_way(room, model, rng), model.rounding)
    ahead = np.gradient(way, axis=0)
    # The direction as a vector: at a turn on the spot an angle would jump.
    ahead = smoothed(ahead / np.maximum(np.linalg.norm(ahead, axis=1, keepdims=True), 1e-9), model.turning)
    n = model.frames
    heading = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    heading = smoothed(heading, model.turning) + np.deg2rad(model.look_deg) * smooth_signal(n, model.sway_frames, rng)
    roll, pitch = (np.deg2rad(model.tilt_sway_deg) * smooth_signal(n, model.sway_frames, rng) for _ in range(2))
    z = model.height + model.height_sway * smooth_signal(n, model.sway_frames, rng)
    return np.column_stack([way, z, roll, np.deg2rad(model.pitch_deg) + pitch, wrap_angle(heading)])


def smoothed(values: np.ndarray, width: float) -> np.ndarray:
    """Values `(T,)` or `(T, k)` smoothed by a bell curve of `width` frames; the ends are held."""
    margin = int(4 * width)
    kernel = np.exp(-0.5 * (np.arange(-margin, margin + 1) / width) ** 2)
    kernel /= kernel.sum()
    columns = np.asarray(values, dtype=np.float64).reshape(len(values), -1).T
    padded = np.pad(columns, ((0, 0), (margin, margin)), mode="edge")
    return np.stack([np.convolve(column, kernel, mode="valid") for column in padded], axis=1).reshape(np.shape(values))


def _way(room: Room, model: WalkModel, rng: Generator) -> np.ndarray:
    """Places `(frames, 2)` on straight stretches between free places, each clear of the furniture."""
    footprints = [footprint(item) for item in room.objects]

    def can_go(here: np.ndarray, there: np.ndarray) -> bool:
        between = here + (there - here) * np.linspace(0, 1, 50)[:, None]
        far = np.linalg.norm(there - here) >= model.shortest_stretch
        return bool(far and clear_of(footprints, between, model.clearance).all())

    for _ in range(MAX_BEGINNINGS):
        here = free_places(room, 1, rng)[0]
        stretches, count = [here[None]], 1
        while count < model.frames:
            there = next((p for p in free_places(room, 200, rng) if can_go(here, p)), None)
            if there is None:
                break  # a dead end: the walk begins anew elsewhere
            steps = int(np.ceil(np.linalg.norm(there - here) / model.step))
            stretches.append(here + (there - here) * (np.arange(1, steps + 1) / steps)[:, None])
            here, count = there, count + steps
        else:
            return np.concatenate(stretches)[: model.frames]
    raise NoFreePlace(f"no walk of {model.frames} frames keeps {model.clearance} m from the furniture: less clearance?")
