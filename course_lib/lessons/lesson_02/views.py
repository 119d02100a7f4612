"""What a camera sees of a small room's maps, and how far the corridor's map is from the corridor."""

import json

import numpy as np

from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix, state_from_optical_pose
from course_lib.lessons.kit.corridor_views import wagon_run
from course_lib.lessons.lesson_02.small_room import MapQuality, room
from course_lib.paths import data_path
from course_lib.plots.corridor_figures import plane_cut
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

CAMERA = DepthCamera.from_fov(132, 108, 70, 59)
EYE = np.array([1.2, 2.6, 1.2, 0.0, 0.05, np.deg2rad(8)])  # beside the table, looking past the pillar to the door


def row(found: MapQuality) -> str:
    """The numbers of a map in one line; holes with their 95 % interval."""
    low, high = found.holes_interval
    return (
        f"{found.triangles} triangles; map to room: median {1000 * found.median:.1f} mm, 90 % below "
        f"{1000 * found.p90:.0f} mm; holes {100 * found.holes:.1f} % ({100 * low:.1f} to {100 * high:.1f})"
    )


def cut(scene_map: SceneMap, height: float = 1.2) -> np.ndarray:
    """Segments `(n, 2, 2)` [m] in which a map meets the horizontal plane at `height` [m]."""
    return plane_cut(scene_map.vertices, scene_map.faces, 2, height)


def camera_view(scene_map: SceneMap) -> np.ndarray:
    """Depth image [m] of a map of the room from `EYE`."""
    with DepthRenderer(scene_map, CAMERA, exact=True) as renderer:
        return renderer.render(EYE)[0]


def true_view(door_open: bool = True) -> np.ndarray:
    """What a perfect camera at `EYE` measures of the room itself."""
    pose = pose_matrix(EYE)
    return room(door_open).cast(pose[:3, 3], CAMERA.rays() @ (pose[:3, :3] @ BODY_FROM_OPTICAL).T).distance


def shipped_numbers() -> dict:
    """What was measured on the corridor's map when it was made (`.venv/bin/python -m tools.make_data corridor`)."""
    return json.loads(data_path("corridor/summary.json").read_text(encoding="utf-8"))["measured"]["map"]


def corridor_difference(scene_map: SceneMap, true_world: SceneMap, frames: range) -> tuple[float, float, float]:
    """Map and true world as a perfect camera sees them on the wagon's path, compared pixel by pixel up to 11 m.

    Returns the share of pixels where the map has a hole, the share where the two differ by more than 10 cm, and the
    median difference [m] of the others.
    """
    recording = wagon_run()
    states = state_from_optical_pose(recording.camera_to_world[frames])
    images = []
    for scene in (scene_map, true_world):
        with DepthRenderer(scene, recording.camera(), exact=True) as renderer:
            images.append(renderer.render(states))
    mapped, true = (image[np.isfinite(images[1])] for image in images)
    difference = np.abs(mapped - true)[np.isfinite(mapped)]
    changed = difference > 0.1
    return np.isinf(mapped).mean(), changed.sum() / len(true), np.median(difference[~changed])
