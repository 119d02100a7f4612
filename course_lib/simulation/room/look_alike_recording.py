"""A room of look-alikes surveyed, and photographed by the paper's rig at both heights, from a seed.

Every random thing has a stream of its own (room, survey, mount, places, each pose), so that another tilt of the lower
camera, or another number of poses, changes nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from course_lib.simulation.room.footprints import free_places
from course_lib.simulation.room.look_alike_room import STREAM, LookAlikeLimits, make_look_alike_room
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS
from course_lib.simulation.room.scene import Room
from course_lib.simulation.room.stereo_photographs import photograph_pair, write_poses
from course_lib.simulation.room.survey import RoomSurveyModel, UnseenObject, survey_room
from course_lib.simulation.sensors.panorama_camera import PanoramaCameraModel
from course_lib.simulation.sensors.panorama_renderer import PanoramaRenderer
from course_lib.simulation.sensors.panorama_rig import Mount, RigModel, assemble, stand_up
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SURVEY, MOUNT, PLACES, POSE = range(1, 5)  # streams of a seed, beside the room's own
HEADINGS_A_PLACE = 2  # as in the paper's table 1
MOST_ROOMS = 20  # drawn for a seed until the survey sees every object


@dataclass(frozen=True)
class RecordingModels:
    """How a room of look-alikes is drawn, surveyed and photographed; the defaults are those of the reported table.

    tilt_deg: None, or the lower camera's tilt against the upper, degrees, instead of one drawn from the rig's model.
    """

    limits: LookAlikeLimits = field(default_factory=LookAlikeLimits)
    rig: RigModel = field(default_factory=RigModel)
    camera: PanoramaCameraModel = field(default_factory=PanoramaCameraModel)
    survey: RoomSurveyModel = field(default_factory=RoomSurveyModel)
    width: int = 1280  # pixels
    tilt_deg: float | None = None


def surveyed_room(seed: int, models: RecordingModels) -> tuple[Room, SemanticMap]:
    """The room of a seed and its map; a room with an object that the survey sees from nowhere is drawn again."""
    for draw in range(MOST_ROOMS):
        room = make_look_alike_room(seed, draw, models.limits)
        try:
            return room, survey_room(room, models.survey, np.random.default_rng([STREAM, seed, SURVEY, draw]))
        except UnseenObject as error:
            unseen = error
    raise unseen


def measurement_poses(room: Room, n: int, seed: int) -> np.ndarray:
    """Where the rig stands: `(n, 3)` [x, y, heading], metres and radians; two headings at every place.

    The first is drawn from the whole circle, the second is a quarter, half or three quarters of a turn further, as in
    the paper's table 1. Fewer poses are the first of more.
    """
    rng = np.random.default_rng([STREAM, seed, PLACES])
    n_places = -(-n // HEADINGS_A_PLACE)
    first, quarters = rng.uniform(-np.pi, np.pi, 1000), rng.integers(1, 4, 1000)
    places = free_places(room, n_places, rng)
    poses = [
        (x, y, first[k] + turn * quarters[k] * np.pi / 2)
        for k, (x, y) in enumerate(places)
        for turn in range(HEADINGS_A_PLACE)
    ]
    return np.array(poses[:n])


def mount_of(seed: int, models: RecordingModels) -> Mount:
    """How the two cameras of a seed's rig sit: one mount for all its poses."""
    mount = assemble(models.rig, np.random.default_rng([STREAM, seed, MOUNT]))
    return mount if models.tilt_deg is None else mount.tilted(models.tilt_deg)


def photograph_room(folder: Path, room: Room, seed: int, n_poses: int, models: RecordingModels) -> list[Path]:
    """Writes a recording for each of the paper's heights, `experiment_1` and `experiment_2`; returns their folders."""
    mount, poses, folders = mount_of(seed, models), measurement_poses(room, n_poses, seed), []
    with PanoramaRenderer(room, models.width, alone_scale=1) as renderer:
        for number, (upper, lower) in CAMERA_HEIGHTS.items():
            folders.append(folder / f"experiment_{number}")
            folders[-1].mkdir()
            entries = []
            for k, (x, y, heading) in enumerate(poses):
                rng = np.random.default_rng([STREAM, seed, POSE, number, k])
                rig = stand_up(float(x), float(y), float(heading), upper, upper - lower, models.rig, rng, mount)
                entries.append(photograph_pair(renderer, rig, folders[-1], f"{k:02d}", models.camera, rng))
            write_poses(folders[-1], seed, models.width, round(upper - lower, 6), entries)
    return folders
