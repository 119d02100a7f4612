"""A room of look-alikes surveyed and photographed from a seed. Every random thing has a stream of its own."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.panorama import read_panorama
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.simulation.room.furnishing import STREAM, LookAlikeLimits, make_look_alike_room
from courseware.simulation.room.measurement_places import CAMERA_HEIGHTS
from courseware.simulation.room.scene import Room, clear_of, footprint, free_places
from courseware.simulation.room.stereo_photographs import photograph_pair, write_poses
from courseware.simulation.room.survey import RoomSurveyModel, UnseenObject, survey_room
from courseware.simulation.sensors import panorama_rig
from courseware.simulation.sensors.panorama_renderer import PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import Mount, PanoramaCameraModel, RigModel

SURVEY, MOUNT, PLACES, POSE, WALK = range(1, 6)  # streams of a seed, beside the room's own
HEADINGS_A_PLACE = 2  # as in the paper's table 1
MAX_ROOMS = 20  # drawn for a seed until the survey sees every object
MAX_STEPS = 1000  # drawn until one ends at a free place


@dataclass(frozen=True)
class RecordingModels:
    """How a room of look-alikes is drawn, surveyed and photographed; the defaults are those of the reported table."""

    limits: LookAlikeLimits = field(default_factory=LookAlikeLimits)
    rig: RigModel = field(default_factory=RigModel)
    camera: PanoramaCameraModel = field(default_factory=PanoramaCameraModel)
    survey: RoomSurveyModel = field(default_factory=RoomSurveyModel)
    width: int = 1280  # pixels
    tilt_deg: float | None = None  # of the lower camera against the upper; None: drawn from the rig's model


def surveyed_room(seed: int, models: RecordingModels) -> tuple[Room, SemanticMap]:
    """The room of a seed and its map; a room with an object that the survey sees from nowhere is drawn again."""
    for draw in range(MAX_ROOMS):
        room = make_look_alike_room(seed, draw, models.limits)
        try:
            return room, survey_room(room, models.survey, np.random.default_rng([STREAM, seed, SURVEY, draw]))
        except UnseenObject as error:
            unseen = error
    raise unseen


def measurement_poses(room: Room, n: int, seed: int) -> np.ndarray:
    """Poses `(n, 3)` of the rig, two headings a place; fewer poses are the first of more. Source: paper 2, table 1"""
    rng = np.random.default_rng([STREAM, seed, PLACES])
    first, quarters = rng.uniform(-np.pi, np.pi, 1000), rng.integers(1, 4, 1000)
    places = free_places(room, -(-n // HEADINGS_A_PLACE), rng)
    turns = range(HEADINGS_A_PLACE)
    poses = [(x, y, first[k] + t * quarters[k] * np.pi / 2) for k, (x, y) in enumerate(places) for t in turns]
    return np.array(poses[:n])


def mount_of(seed: int, models: RecordingModels) -> Mount:
    """How the two cameras of a seed's rig sit: one mount for all its poses."""
    mount = panorama_rig.assemble(models.rig, np.random.default_rng([STREAM, seed, MOUNT]))
    return mount if models.tilt_deg is None else mount.tilted(models.tilt_deg)


def photograph_room(folder: Path, room: Room, seed: int, n_poses: int, models: RecordingModels) -> list[Path]:
    """Write a recording for each of the paper's heights, `experiment_1` and `experiment_2`; return their folders."""
    mount, poses, folders = mount_of(seed, models), measurement_poses(room, n_poses, seed), []
    with PanoramaRenderer(room, models.width, alone_scale=1) as renderer:
        for number, (upper, lower) in CAMERA_HEIGHTS.items():
            folders.append(folder / f"experiment_{number}")
            folders[-1].mkdir()
            entries = []
            for k, pose in enumerate(poses):
                rng = np.random.default_rng([STREAM, seed, POSE, number, k])
                rig = panorama_rig.stand_up(pose, upper, upper - lower, models.rig, rng, mount)
                entries.append(photograph_pair(renderer, rig, folders[-1], f"{k:02d}", models.camera, rng))
            write_poses(folders[-1], seed, models.width, round(upper - lower, 6), entries)
    return folders


@dataclass(frozen=True)
class WalkModel:
    """How far apart the views are; each drawn uniformly."""

    step: tuple[float, float] = (0.2, 0.5)  # m, from one view to the next, in any direction; chosen
    turn_deg: float = 20.0  # degrees, greatest change of heading either way; chosen
    clearance: float = 0.3  # m to every footprint, as for the first pose (`free_places`)
    wall: float = 0.5  # m to every wall, likewise


class NearbyView(NamedTuple):
    """One more view: where the rig really stood, and its two panoramas."""

    pose: np.ndarray  # `(3,)` [x, y, heading], metres and radians
    upper_image: np.ndarray
    lower_image: np.ndarray


def experiment_of(k: int) -> int:
    """At which of the two heights pose k is walked on from: by turns, since every view costs as much as a pose."""
    return 1 + k % len(CAMERA_HEIGHTS)


def walk_from(room: Room, pose: np.ndarray, n: int, rng: Generator, model: WalkModel = WalkModel()) -> np.ndarray:
    """Poses `(n, 3)` of n further views, each a free step from the one before, or a turn only where none is free."""
    footprints = [footprint(item) for item in room.objects]
    low, high = np.asarray(room.walls).min(axis=0) + model.wall, np.asarray(room.walls).max(axis=0) - model.wall
    poses, last = [], np.asarray(pose, dtype=np.float64)
    for _ in range(n):
        lengths, directions = rng.uniform(*model.step, MAX_STEPS), rng.uniform(-np.pi, np.pi, MAX_STEPS)
        places = last[:2] + lengths[:, None] * np.stack([np.cos(directions), np.sin(directions)], axis=1)
        inside = (places >= low).all(axis=1) & (places <= high).all(axis=1)
        free = inside & clear_of(footprints, places, model.clearance)
        place = places[np.argmax(free)] if free.any() else last[:2]
        turn = np.deg2rad(rng.uniform(-model.turn_deg, model.turn_deg))
        last = np.array([*place, wrap_angle(last[2] + turn)])
        poses.append(last)
    return np.array(poses).reshape(-1, 3)


def photograph_walks(
    folder: Path, room: Room, seed: int, n_poses: int, n: int, models: RecordingModels, walk: WalkModel
) -> Iterator[list[NearbyView]]:
    """For each pose of `photograph_room` the n views that follow it, written to `folder` as JPEG and read back."""
    mount = mount_of(seed, models)
    with PanoramaRenderer(room, models.width, alone_scale=1) as renderer:
        for k, pose in enumerate(measurement_poses(room, n_poses, seed)):
            rng = np.random.default_rng([STREAM, seed, WALK, k])
            upper, lower = CAMERA_HEIGHTS[experiment_of(k)]
            views = []
            for place in walk_from(room, pose, n, rng, walk):
                rig = panorama_rig.stand_up(place, upper, upper - lower, models.rig, rng, mount)
                images = []
                for state in rig.camera_states():
                    panorama_rig.write_photograph(folder / "view.jpg", renderer.render(state), models.camera, rng)
                    images.append(read_panorama(folder / "view.jpg").image)
                views.append(NearbyView(place, *images))
            yield views
