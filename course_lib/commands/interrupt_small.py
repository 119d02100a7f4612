"""Commands of minutes made short for `interrupt`: less to simulate or measure; what they write, and how, is theirs."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path


def corridor() -> None:
    """Two coarse scans, and runs of three and four frames."""
    from course_lib.simulation.corridor import data
    from course_lib.simulation.corridor.recorded_runs import HandModel, WagonModel
    from course_lib.simulation.corridor.surface_fusion import FusionModel
    from course_lib.simulation.sensors.laser_survey import ScannerModel

    data.CorridorModels = partial(
        data.CorridorModels,
        scanner=ScannerModel(step_deg=0.8),
        fusion=FusionModel(voxel=0.08, truncation=0.24, triangles=8000, least_component=20),
        wagon=WagonModel(frames=3),
        hand=HandModel(frames=4),
        stations=((8.3, 0.3), (11.3, -0.4)),
    )


def room() -> None:
    """Four small pairs of panoramas, from one place."""
    from course_lib.simulation.room import data
    from course_lib.simulation.room.survey import RoomSurveyModel

    survey = RoomSurveyModel(places=3, width=320, fewest_pixels=10)
    data.RoomModels = partial(data.RoomModels, width=320, places=(3,), survey=survey)


def finale() -> None:
    """Two coarse scans, and small panoramas from three places for the semantic map."""
    from course_lib.simulation.corridor.surface_fusion import FusionModel
    from course_lib.simulation.room import finale_data
    from course_lib.simulation.room.depth_world import DepthSurveyModel
    from course_lib.simulation.room.look_alike_recording import RecordingModels
    from course_lib.simulation.room.survey import RoomSurveyModel
    from course_lib.simulation.sensors.laser_survey import ScannerModel

    recording = RecordingModels(survey=RoomSurveyModel(places=3, width=320, fewest_pixels=5))
    fusion = FusionModel(voxel=0.08, truncation=0.24, triangles=3_000)
    mesh = DepthSurveyModel(stations=2, scanner=ScannerModel(step_deg=2.0), fusion=fusion)
    finale_data.FinaleModels = partial(finale_data.FinaleModels, recording=recording, mesh=mesh)


def bench() -> None:
    """What measures is the program in the folder that MEASURED names."""
    from course_lib.commands import bench as command

    command.ROOT = Path(os.environ["MEASURED"])


SMALL: dict[str, Callable[[], None]] = {
    "make-data_corridor": corridor,
    "make-data_room": room,
    "make-data_finale": finale,
    "bench": bench,
}
