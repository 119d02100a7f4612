"""Several photographs of a room from places near each other: what a rig sees that is carried on by a few steps."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from course_lib.geometry import wrap_angle
from course_lib.simulation.room.footprints import clear_of, footprint
from course_lib.simulation.room.look_alike_recording import RecordingModels, measurement_poses, mount_of
from course_lib.simulation.room.look_alike_room import STREAM
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS
from course_lib.simulation.room.scene import Room
from course_lib.simulation.sensors.panorama_camera import photograph, write_photograph
from course_lib.simulation.sensors.panorama_renderer import PanoramaRenderer
from course_lib.simulation.sensors.panorama_rig import stand_up
from course_lib.spherical_stereo.panorama import read_panorama

WALK = 5  # stream of a seed, after those of `look_alike_recording`
MOST_STEPS = 1000  # drawn until one ends at a free place


@dataclass(frozen=True)
class WalkModel:
    """How far apart the views are; each drawn uniformly."""

    step: tuple[float, float] = (0.2, 0.5)  # m, from one view to the next, in any direction; chosen
    turn_deg: float = 20.0  # degrees, greatest change of heading either way; chosen
    clearance: float = 0.3  # m to every footprint, as for the first pose (`free_places`)
    wall: float = 0.5  # m to every wall, likewise


class NearbyView(NamedTuple):
    """One more view: where the rig really stood, and its two panoramas."""

    pose: np.ndarray
    """`(3,)` [x, y, heading], metres and radians."""
    upper_image: np.ndarray
    lower_image: np.ndarray


def experiment_of(k: int) -> int:
    """At which of the two heights pose k is walked on from: by turns, since every view costs as much as a pose."""
    return 1 + k % len(CAMERA_HEIGHTS)


def walk_from(room: Room, pose: np.ndarray, n: int, rng: Generator, model: WalkModel = WalkModel()) -> np.ndarray:
    """Poses `(n, 3)` of n further views, each a step from the one before, all at places where the rig can stand.

    pose: `(3,)` of the first view, which is not repeated. Where no step of `MOST_STEPS` is free the rig turns only.
    """
    footprints = [footprint(item) for item in room.objects]
    low, high = np.asarray(room.walls).min(axis=0) + model.wall, np.asarray(room.walls).max(axis=0) - model.wall
    poses, last = [], np.asarray(pose, dtype=np.float64)
    for _ in range(n):
        lengths, directions = rng.uniform(*model.step, MOST_STEPS), rng.uniform(-np.pi, np.pi, MOST_STEPS)
        places = last[:2] + lengths[:, None] * np.stack([np.cos(directions), np.sin(directions)], axis=1)
        free = (
            clear_of(footprints, places, model.clearance) & (places >= low).all(axis=1) & (places <= high).all(axis=1)
        )
        place = places[np.argmax(free)] if free.any() else last[:2]
        turn = np.deg2rad(rng.uniform(-model.turn_deg, model.turn_deg))
        last = np.array([*place, wrap_angle(last[2] + turn)])
        poses.append(last)
    return np.array(poses).reshape(-1, 3)


def photograph_walks(
    folder: Path, room: Room, seed: int, n_poses: int, n: int, models: RecordingModels, walk: WalkModel
) -> Iterator[list[NearbyView]]:
    """For each pose of `photograph_room` the n views that follow it, at the height of `experiment_of`.

    folder: where the photographs are written and read back from, since JPEG is part of what a camera does.
    """
    mount = mount_of(seed, models)
    with PanoramaRenderer(room, models.width, alone_scale=1) as renderer:
        for k, pose in enumerate(measurement_poses(room, n_poses, seed)):
            rng = np.random.default_rng([STREAM, seed, WALK, k])
            upper, lower = CAMERA_HEIGHTS[experiment_of(k)]
            views = []
            for x, y, heading in walk_from(room, pose, n, rng, walk):
                rig = stand_up(float(x), float(y), float(heading), upper, upper - lower, models.rig, rng, mount)
                images = []
                for state in rig.camera_states():
                    write_photograph(
                        folder / "view.jpg", photograph(renderer.render(state), models.camera, rng), models.camera, rng
                    )
                    images.append(read_panorama(folder / "view.jpg"))
                views.append(NearbyView(np.array([x, y, heading]), *images))
            yield views
