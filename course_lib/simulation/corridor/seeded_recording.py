"""A recording of its own for every seed: another day in the building of given data, another run of the wagon.

The building is that of the map; doors, clutter, path, pushing, errors of the camera and its noise are the seed's. Each
has a stream of random numbers to itself, so that two recordings of one seed differ in what they are asked to differ in.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, get_args

import numpy as np
from numpy.random import Generator

from course_lib.rendering.camera import DepthCamera
from course_lib.simulation.corridor.another_day import DayModel, another_day
from course_lib.simulation.corridor.recorded_runs import (
    FloorSurveyModel,
    HandModel,
    PushModel,
    WagonModel,
    draw_pushing,
    hand_run,
    wagon_run,
)
from course_lib.simulation.corridor.recording import record
from course_lib.simulation.corridor.world import Building, draw_building
from course_lib.simulation.sensors.time_of_flight import (
    CalibrationErrors,
    CalibrationModel,
    TimeOfFlightCamera,
    TimeOfFlightModel,
)

Hardship = Literal["focal length", "lens distortion", "mount position", "mount angle", "pushed by hand"]
"""What a recording may have that the shipped one has not."""
HARDSHIPS: tuple[Hardship, ...] = get_args(Hardship)

Carried = Literal["wagon", "hand"]


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
    """The building whose map lies in a folder that `make-data corridor` made: its seed is in summary.json."""
    path = Path(folder) / "summary.json"
    if not path.is_file():
        raise FileNotFoundError(
            f"no summary.json in {folder}: a recording needs the seed of the building whose map is there; "
            "make the folder with make-data corridor, or use --recording shipped"
        )
    return draw_building(building_generator(json.loads(path.read_text(encoding="utf-8"))["seed"]))


def building_generator(seed: int) -> Generator:
    """The generator that `make_corridor_data` draws its building from."""
    return np.random.default_rng(seed).spawn(1)[0]


def record_seed(
    folder: Path,
    building: Building,
    seed: int,
    hardships: Collection[Hardship] = (),
    models: SeedModels | None = None,
    camera: DepthCamera | None = None,
    frames: int | None = None,
    progress: Callable[[Iterable], Iterable] = iter,
    carried: Carried = "wagon",
) -> None:
    """Writes the recording of a seed to a new `folder`. camera: what the user is told (default: the SR4000's).
    frames: only the first so many. carried: on a wagon, or by hand with all six degrees of freedom moving; what else
    the seed draws, the day among it, is the same.

    Raises `ValueError` for an unknown hardship, or a folder that holds a recording.
    """
    unknown = sorted(set(hardships) - set(HARDSHIPS))
    if unknown:
        raise ValueError(f"unknown hardship {unknown[0]!r}: there are {', '.join(HARDSHIPS)}")
    models = models or SeedModels()
    # The seed's own key keeps these streams apart from those of make_corridor_data with the same seed.
    streams = np.random.default_rng([seed, 1]).spawn(6)
    day_rng, path_rng, push_rng, calibration_rng, pattern_rng, noise_rng = streams
    day = another_day(building, models.day, day_rng)
    wagon = dataclasses.replace(models.wagon, start=path_rng.uniform(*models.day.starts))
    pushing = draw_pushing(models.push, wagon.frames, push_rng) if "pushed by hand" in hardships else None
    errors = _only(models.calibration.draw(calibration_rng), hardships)
    instrument = TimeOfFlightCamera(camera or DepthCamera.sr4000(), models.camera, pattern_rng, errors)
    if carried == "wagon":
        run = wagon_run(wagon, day.clutter_boxes, path_rng, pushing)
    else:
        hand = dataclasses.replace(models.hand, start=path_rng.uniform(*models.day.hand_starts))
        run = hand_run(hand, day.clutter_boxes, path_rng)
    record(folder, day.mesh, instrument, run, models.floor_survey, noise_rng, progress, frames)


def _only(drawn: CalibrationErrors, hardships: Collection[Hardship]) -> CalibrationErrors:
    """The drawn errors without those that were not asked for."""
    position = drawn.mount[:3] if "mount position" in hardships else (0.0,) * 3
    angles = drawn.mount[3:] if "mount angle" in hardships else (0.0,) * 3
    return CalibrationErrors(
        drawn.focal_length if "focal length" in hardships else 0.0,
        drawn.radial if "lens distortion" in hardships else 0.0,
        (*position, *angles),
    )
