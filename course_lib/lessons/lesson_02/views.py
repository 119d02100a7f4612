"""What a camera sees of a small room's maps, and how far the corridor's map is from the corridor."""

import functools
import json
from typing import NamedTuple

import numpy as np

from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix, state_from_optical_pose
from course_lib.lessons.kit.corridor_views import wagon_run
from course_lib.lessons.lesson_02.small_room import MapQuality, room
from course_lib.paths import data_path
from course_lib.plots.corridor_figures import plane_cut
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

EYE = np.array([1.2, 2.6, 1.2, 0.0, 0.05, np.deg2rad(8)])  # state of the camera that looks through the room
CUT = 1.2  # metres, height of the cuts


def row(found: MapQuality) -> str:
    """The numbers of a map in one line; holes with their 95 % interval."""
    low, high = found.holes_interval
    return (
        f"{found.triangles} triangles; map to room: median {1000 * found.median:.1f} mm, 90 % below "
        f"{1000 * found.p90:.0f} mm; holes {100 * found.holes:.1f} % ({100 * low:.1f} to {100 * high:.1f})"
    )


def cut(vertices: np.ndarray, faces: np.ndarray, height: float = CUT) -> np.ndarray:
    """Segments `(n, 2, 2)` [m] in which triangles meet the horizontal plane at `height`."""
    return plane_cut(vertices, faces, 2, height)


@functools.cache
def room_cut(door_open: bool) -> np.ndarray:
    mesh = room(door_open).mesh()
    return cut(mesh.vertices, mesh.faces)


@functools.lru_cache(maxsize=64)
def camera_view(scene_map: SceneMap) -> np.ndarray:
    """Depth image [m] of a map of the room from beside the table, looking past the pillar to the door."""
    with DepthRenderer(scene_map, view_camera(), exact=True) as renderer:
        return renderer.render(EYE)[0]


@functools.cache
def true_view(door_open: bool = True) -> np.ndarray:
    """What a perfect camera there measures of the room itself."""
    pose = pose_matrix(EYE)
    rays = view_camera().rays() @ (pose[:3, :3] @ BODY_FROM_OPTICAL).T
    return room(door_open).cast(pose[:3, 3], rays).distance


@functools.cache
def view_camera() -> DepthCamera:
    return DepthCamera.from_fov(132, 108, 70, 59)


def shipped_numbers() -> dict:
    """What was measured on the corridor's map when it was made (`.venv/bin/python -m tools.make_data corridor`)."""
    return json.loads(data_path("corridor/summary.json").read_text(encoding="utf-8"))["measured"]["map"]


class CorridorDifference(NamedTuple):
    """What a perfect camera would see on the wagon's path on the day of the run, against the corridor's map."""

    holes: float
    """share of pixels where the world is hit and the map is not"""
    changed: float
    """share of pixels where the two differ by more than 10 cm"""
    median: float
    """of the difference in the other pixels [m]"""


def corridor_difference(scene_map: SceneMap, true_world: SceneMap, frames: range) -> CorridorDifference:
    """Map and true world drawn from the wagon's true poses of some frames, compared pixel by pixel up to 11 m."""
    recording = wagon_run()
    states = state_from_optical_pose(recording.camera_to_world[list(frames)])
    images = []
    for scene in (scene_map, true_world):
        with DepthRenderer(scene, recording.camera(), exact=True) as renderer:
            images.append(renderer.render(states))
    mapped, true = images
    there = np.isfinite(true)
    hole = there & ~np.isfinite(mapped)
    both = there & ~hole
    difference = np.abs(np.where(both, mapped, 0) - np.where(both, true, 0))
    changed = difference > 0.1
    same = both & ~changed
    return CorridorDifference(
        float(hole.sum() / there.sum()), float(changed.sum() / there.sum()), float(np.median(difference[same]))
    )
