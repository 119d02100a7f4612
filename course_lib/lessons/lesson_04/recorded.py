"""Recorded frames of the corridor beside their truth: how many pixels are how far off."""

import functools

import numpy as np
from scipy.spatial import cKDTree

from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.lesson_04.time_of_flight import MODEL
from course_lib.paths import data_path
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap


@functools.cache
def true_world() -> SceneMap:
    """The corridor as it was on the day of the recording, people and all. No filter ever sees it."""
    return SceneMap.load(data_path("corridor/true_world.ply"))


def true_depths(recording: DepthSequence, camera: DepthCamera, frames: range) -> np.ndarray:
    """`(n, H, W)` true depths [m] of recorded frames: the true world drawn from the true poses."""
    states = state_from_optical_pose(recording.camera_to_world[list(frames)])
    with DepthRenderer(true_world(), camera.with_clip_planes(0.1, 40.0), exact=True) as renderer:
        return renderer.render(states)


KINDS = ("no measurement", "within 5 cm", "5 to 30 cm off", "wrapped", "other, mostly edges")


def kinds_of(measured: np.ndarray, true: np.ndarray, repeats: float = MODEL.unambiguous_range) -> dict[str, np.ndarray]:
    """Which pixels are of each of `KINDS`, a mask of the images' shape. Wrapped: about one whole c / 2f too near."""
    error = measured - true
    lost = np.isnan(measured)
    with np.errstate(invalid="ignore"):
        close, middling = np.abs(error) <= 0.05, (np.abs(error) > 0.05) & (np.abs(error) <= 0.3)
        wrapped = np.abs(error + repeats) < 0.1 * repeats
    rest = ~(lost | close | middling | wrapped)
    return dict(zip(KINDS, (lost, close, middling, wrapped, rest), strict=True))


def sort_errors(measured: np.ndarray, true: np.ndarray, repeats: float = MODEL.unambiguous_range) -> dict[str, float]:
    """Share of all pixels in each of `KINDS`."""
    return {kind: float(mask.mean()) for kind, mask in kinds_of(measured, true, repeats).items()}


def on_a_surface(points: np.ndarray, true: np.ndarray, camera: DepthCamera, within: float = 0.1) -> float:
    """Share of measured points `(n, 3)` (optical frame, metres) within so many metres of a point that is truly seen."""
    surface = camera.points(np.where(np.isfinite(true), true, np.nan)).reshape(-1, 3)
    distances, _ = cKDTree(surface[np.isfinite(surface).all(axis=1)]).query(points)
    return float(np.mean(distances <= within))
