"""A localized recording in three dimensions: the map cut open, the path, what was measured in the worst frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.geometry import rotation_to_z_up, state_from_optical_pose
from course_lib.recordings import Run
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.scene_map import SceneMap
from course_lib.rendering.simplification import simplified
from courseware.plots.figures import BLUE, ORANGE, PURPLE, VERMILION
from courseware.plots.scenes import frustum, map_mesh, new_plotter, path

if TYPE_CHECKING:
    import pyvista

WORST_FRAMES = 3
_POINTS_A_FRAME = 3000  # that are drawn (chosen: enough to see a wall beside the map's)
_HEADROOM = 0.4  # metres above the highest camera at which the map is cut: below most ceilings (chosen)
_AROUND = 8.0  # metres of the map that are shown around the path (chosen: a page is small)
_ROOM = 5.0  # metres of the map that the first view shows at least, to the left and right of the path (chosen)
_FRUSTUM = 0.6  # metres
_FAR_FROM_ZERO = 1000.0  # metres from which on single precision would show


def track_scene(
    scene_map: SceneMap, result: Run, sequence: DepthSequence, up: str | None, near: float, far: float
) -> tuple[pyvista.Plotter, str]:
    """Return the scene, and in a sentence what it shows.

    up: the axis of map and poses that points up; the map is cut open above the camera. None: unknown, up is then what
    the images say in the mean, and the map is drawn clear. near, far: metres between which pixels are measured.
    """
    to_scene = _to_scene(scene_map, up, result.camera_to_world)
    estimated = to_scene @ result.camera_to_world
    true = to_scene @ sequence.camera_to_world[: len(result.frames)] if sequence.has_poses else None
    paths = estimated[:, :3, 3] if true is None else np.concatenate([estimated[:, :3, 3], true[:, :3, 3]])
    around = _around(scene_map, paths, up, to_scene)
    camera, worst = sequence.camera(near, far), worst_frames(result, sequence)
    measured = [_measured(sequence.depth(index), camera, estimated[index]) for index in worst]
    plotter = new_plotter(*_view(paths))
    if up is None:
        plotter.add_mesh(map_mesh(around), color="lightgrey", opacity=0.3)
    else:
        plotter.add_mesh(map_mesh(around, below=paths[:, 2].max() + _HEADROOM), color="lightgrey")
    if true is not None:
        plotter.add_mesh(path(true[:, :3, 3], dashed=True), color="black", line_width=3)
    plotter.add_mesh(path(estimated[:, :3, 3]), color=BLUE, line_width=4)
    for status, colour, size in (("doubtful", ORANGE, 7), ("lost", VERMILION, 10)):
        chosen = estimated[[one == status for one in result.statuses], :3, 3]
        if len(chosen):
            plotter.add_points(chosen.astype(np.float32), color=colour, point_size=size)
    for index, points in zip(worst, measured, strict=True):
        if len(points):
            plotter.add_mesh(points, color=PURPLE, point_size=3)
        shape = frustum(camera, state_from_optical_pose(estimated[index]), max(_FRUSTUM, 1.1 * camera.near))
        plotter.add_mesh(shape, color=PURPLE)
    words = "Estimate: blue line" + (", truth: black, dashed" if true is not None else "")
    words += ", orange where doubtful, red where lost" if set(result.statuses) != {"tracked"} else ""
    frames = ", ".join(str(result.frames[index]) for index in worst)
    return plotter, f"{words}. Measured points of the worst frames ({frames}): purple, at the estimated pose"


def worst_frames(result: Run, sequence: DepthSequence) -> list[int]:
    """Indices of the worst frames in order of time, none of them near another: a tenth of the recording apart."""
    if sequence.has_poses:
        badness = pose_errors(result.camera_to_world, sequence.camera_to_world[: len(result.frames)])[0]
    else:
        badness = -np.nan_to_num(result.scores, nan=np.inf)  # without a measurement there is nothing to draw
    apart, chosen = len(badness) / 10, []
    for index in np.argsort(-badness, kind="stable"):
        if len(chosen) < WORST_FRAMES and all(abs(index - other) >= apart for other in chosen):
            chosen.append(int(index))
    return sorted(chosen)


def _to_scene(scene_map: SceneMap, up: str | None, camera_to_world: np.ndarray) -> np.ndarray:
    """Pose `(4, 4)` of the map's world in the scene's: its up axis up, near zero where it is far from it."""
    matrix = rotation_to_z_up(up or "z")
    if up is None:
        above = -camera_to_world[:, :3, 1].mean(axis=0)  # an optical frame's y points down
        matrix[:3, :3] = Rotation.align_vectors([[0.0, 0.0, 1.0]], [above])[0].as_matrix()
    origin = matrix[:3, :3] @ scene_map.origin
    matrix[:3, 3] = -_FAR_FROM_ZERO * np.round(origin / _FAR_FROM_ZERO)
    return matrix


def _around(scene_map: SceneMap, paths: np.ndarray, up: str | None, to_scene: np.ndarray) -> SceneMap:
    """The map's triangles near the paths, in the scene, seen from above; all of them where none is near."""
    upright = rotation_to_z_up(up or "z")  # turned upright before it is simplified, it is found in the filter's cache
    scene_map = simplified(scene_map.transformed(upright)).transformed(to_scene @ np.linalg.inv(upright))
    low, high = paths[:, :2].min(axis=0) - _AROUND, paths[:, :2].max(axis=0) + _AROUND
    middles = scene_map.vertices[scene_map.faces].mean(axis=1)[:, :2]
    near = ((middles >= low) & (middles <= high)).all(axis=1)
    return SceneMap(scene_map.vertices, scene_map.faces[near]) if near.any() else scene_map


def _view(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From where a path `(N, 3)` and the room around it are seen, so steeply that no wall hides it, and its middle."""
    low, high = points.min(axis=0), points.max(axis=0)
    focus = (low + high) / 2
    return focus + max(_ROOM, float((high - low).max())) * np.array([-0.6, -1.1, 2.2]), focus


def _measured(depth: np.ndarray, camera: DepthCamera, camera_to_world: np.ndarray) -> np.ndarray:
    """Some of a depth image's points `(N, 3)` in the scene, those between the camera's clip planes."""
    points = camera.points(depth)[(depth >= camera.nearest) & (depth <= camera.farthest)]
    points = points[:: max(1, len(points) // _POINTS_A_FRAME)]
    return (points @ camera_to_world[:3, :3].T + camera_to_world[:3, 3]).astype(np.float32)
