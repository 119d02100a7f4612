"""Recordings of a building: a seed gives the day, the run and the camera's errors, each from a stream of its own."""

import dataclasses
import json
from collections import Counter
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, get_args

import numpy as np
from numpy.random import Generator

from course_lib.depth_mcl.sequence import write_sequence
from course_lib.geometry import optical_pose
from course_lib.rendering.camera import DepthCamera
from courseware.simulation.corridor import recorded_runs
from courseware.simulation.corridor.mesh_building import WorldMesh
from courseware.simulation.corridor.recorded_runs import FloorSurveyModel, HandModel, PushModel, Run, WagonModel
from courseware.simulation.corridor.world import Building, DayModel, draw_building, scene_change
from courseware.simulation.sensors import time_of_flight
from courseware.simulation.sensors.ray_casting import WorldCaster
from courseware.simulation.sensors.time_of_flight import CalibrationModel, TimeOfFlightCamera, TimeOfFlightModel

# What a recording may have that the shipped one has not.
Hardship = Literal["focal length", "lens distortion", "mount position", "mount angle", "pushed by hand"]
HARDSHIPS: tuple[Hardship, ...] = get_args(Hardship)


@dataclass(frozen=True)
class SeedModels:
    """All parameters of a seed's recording."""

    day: DayModel = field(default_factory=DayModel)
    wagon: WagonModel = field(default_factory=WagonModel)
    hand: HandModel = field(default_factory=HandModel)
    push: PushModel = field(default_factory=PushModel)
    camera: TimeOfFlightModel = field(default_factory=TimeOfFlightModel)
    calibration: CalibrationModel = field(default_factory=CalibrationModel)
    floor_survey: FloorSurveyModel = field(default_factory=FloorSurveyModel)


def building_of_data(folder: str | Path) -> Building:
    """The building whose map lies in a folder that `tools.make_data corridor` made: its seed is in summary.json."""
    path = Path(folder) / "summary.json"
    if not path.is_file():
        raise FileNotFoundError(
            f"no summary.json in {folder}: a recording needs the seed of the building whose map is there. "
            "Make the folder with python -m tools.make_data corridor, or use --recording shipped"
        )
    # The first stream of the seed is the building's (tools/corridor_data.py).
    return draw_building(np.random.default_rng(json.loads(path.read_text(encoding="utf-8"))["seed"]).spawn(1)[0])


def record(
    folder: Path,
    world: WorldMesh,
    camera: TimeOfFlightCamera,
    run: Run,
    floor_survey: FloorSurveyModel,
    rng: Generator,
    progress: Callable[[Iterable], Iterable] = iter,
    frames: int | None = None,
) -> Counter[str]:
    """Capture a run, or its first `frames`, write what a user is told to `folder`, and return counts over its pixels.

    A user is told nominal intrinsics, the poses as believed, and the line on the floor of the whole run.
    """
    states, times = run
    caster, depths, counts = WorldCaster(world.vertices, world.faces, world.reflectivity), [], Counter()
    for state in progress(states[:frames]):
        frame = camera.capture(caster, state, rng)
        depths.append(frame.depth)
        counts.update(time_of_flight.frame_counts(frame, camera.model))
    path = recorded_runs.survey_floor_line(states, floor_survey, rng)
    n = len(depths)
    write_sequence(folder, camera.camera.matrix, list(range(n)), depths, optical_pose(states[:n]), times[:n], "z", path)
    return counts


def record_seed(
    folder: Path,
    building: Building,
    seed: int,
    hardships: Collection[Hardship] = (),
    models: SeedModels = SeedModels(),
    camera: DepthCamera | None = None,
    frames: int | None = None,
    progress: Callable[[Iterable], Iterable] = iter,
    carried: Literal["wagon", "hand"] = "wagon",
) -> None:
    """Write the recording of a seed to a new `folder`. Raises `ValueError` for an unknown hardship.

    camera: what the user is told (default: the SR4000's). frames: only the first so many. carried: on a wagon, or by
    hand with all six degrees of freedom moving.
    """
    unknown = sorted(set(hardships) - set(HARDSHIPS))
    if unknown:
        raise ValueError(f"unknown hardship {unknown[0]!r}: there are {', '.join(HARDSHIPS)}")
    # The seed's own key keeps these streams apart from those of the data with the same seed.
    streams = np.random.default_rng([seed, 1]).spawn(6)
    day_rng, path_rng, push_rng, calibration_rng, pattern_rng, noise_rng = streams
    mesh, clutter = scene_change(building, models.day, day_rng)
    wagon = dataclasses.replace(models.wagon, start=path_rng.uniform(*models.day.starts))
    pushing = recorded_runs.draw_pushing(models.push, wagon.frames, push_rng) if "pushed by hand" in hardships else None
    drawn = models.calibration.draw(calibration_rng)
    position = drawn.mount[:3] if "mount position" in hardships else (0.0,) * 3
    angles = drawn.mount[3:] if "mount angle" in hardships else (0.0,) * 3
    errors = time_of_flight.CalibrationErrors(
        drawn.focal_length if "focal length" in hardships else 0.0,
        drawn.radial if "lens distortion" in hardships else 0.0,
        (*position, *angles),
    )
    instrument = TimeOfFlightCamera(camera or DepthCamera.sr4000(), models.camera, pattern_rng, errors)
    if carried == "wagon":
        run = recorded_runs.wagon_run(wagon, clutter, path_rng, pushing)
    else:
        hand = dataclasses.replace(models.hand, start=path_rng.uniform(*models.day.hand_starts))
        run = recorded_runs.hand_run(hand, clutter, path_rng)
    record(folder, mesh, instrument, run, models.floor_survey, noise_rng, progress, frames)
