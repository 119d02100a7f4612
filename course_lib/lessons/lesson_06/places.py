"""A frame of the wagon's run, and what cameras see that stand in a row along one axis of the state."""

import functools
from collections import namedtuple

import numpy as np

from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.corridor_views import corridor_map, wagon_run
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth

FRAME = 100  # of the wagon's run: two people stand before the camera who are not in the map
N_PLACES = 41  # cameras along one axis
REACH = {"x": 1.0, "y": 0.4, "z": 0.4, "roll": 15.0, "pitch": 15.0, "yaw": 15.0}  # to each side, metres or degrees
UNIT = {axis: "m" if axis in "xyz" else "degrees" for axis in REACH}
Scene = namedtuple("Scene", "measured truth renderer")


@functools.cache
def small_scene(width: int = 44, height: int = 36) -> Scene:
    """The frame as an image `(H, W)` [m], the true state `(6,)`, and the fastest renderer for small images: rays."""
    sequence = wagon_run()
    camera = sequence.camera()
    small = camera.resized(width, height)
    truth = state_from_optical_pose(sequence.camera_to_world[FRAME])
    renderer = DepthRenderer(corridor_map(), small, "ray", exact=True)
    return Scene(subsample_depth(sequence.depth(FRAME), camera, small), truth, renderer)


def offsets(axis: str) -> np.ndarray:
    """Where the cameras of a row stand, `(N_PLACES,)` metres or degrees from the truth."""
    return np.linspace(-REACH[axis], REACH[axis], N_PLACES)


@functools.cache
def views_along(axis: str) -> np.ndarray:
    """Simulated images `(N_PLACES, 36, 44)` of the cameras along one axis."""
    scene = small_scene()
    states = np.tile(scene.truth, (N_PLACES, 1))
    states[:, list(REACH).index(axis)] += offsets(axis) if UNIT[axis] == "m" else np.deg2rad(offsets(axis))
    return scene.renderer.render(states)
