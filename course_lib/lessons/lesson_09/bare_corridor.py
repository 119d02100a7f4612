"""A corridor that shows nothing along its axis, and a camera that slides through it."""

from typing import NamedTuple

import numpy as np

from course_lib.beyond import AnnealedLocalizer
from course_lib.depth_mcl import DepthCamera, DepthRenderer, SceneMap
from course_lib.lessons.kit.box_world import box_map

STEP = 0.1  # metres between two images
NOISE = 0.01  # metres, of every pixel
_FRAMES = 8
_START = np.array([0.0, 0.1, 1.3, 0.0, 0.05, 0.1])


def bare_corridor(pillar: bool = False) -> SceneMap:
    """Floor, ceiling and two walls along x, 100 m long; with a pillar 4 m ahead of the start."""
    walls = [
        ((-50, -1.2, -0.1), (50, 1.2, 0.0)), ((-50, -1.2, 2.5), (50, 1.2, 2.6)),
        ((-50, -1.3, 0.0), (50, -1.2, 2.5)), ((-50, 1.2, 0.0), (50, 1.3, 2.5)),
    ]  # fmt: skip
    return box_map(*walls, *([((4.0, 0.9, 0.0), (4.3, 1.2, 2.5))] if pillar else []))


class Slide(NamedTuple):
    """What the filter made of a camera that slides along the axis."""

    along: np.ndarray
    """`(T,)` error along the axis [m], its sign kept."""
    sigma_along: np.ndarray
    """`(T,)` what the filter expects of it, one sigma [m]."""
    across: np.ndarray
    """`(T,)` error across the axis [m]."""
    sigma_across: np.ndarray
    """`(T,)` [m]."""
    statuses: list[str]


def slide(pillar: bool = False, odometer: bool = False, seed: int = 10_001) -> Slide:
    """Eight images, `STEP` apart along the axis; odometer: the filter is told each step."""
    rng, camera = np.random.default_rng(seed), DepthCamera.sr4000().resized(88, 72)
    yaw, pitch = _START[5], _START[4]
    # The step along the world's x, in the camera's own axes (right, down, forward).
    told = STEP * np.array([np.sin(yaw), np.cos(yaw) * np.sin(pitch), np.cos(yaw) * np.cos(pitch), 0, 0, 0])
    errors, sigmas, statuses = [], [], []
    with DepthRenderer(bare_corridor(pillar), camera) as renderer:
        localizer = AnnealedLocalizer(renderer, seed=seed)
        localizer.initialize(_START)
        for frame in range(_FRAMES):
            true = _START + np.eye(6)[0] * STEP * frame
            depth = renderer.render(true)[0] + NOISE * rng.standard_normal(camera.shape)
            depth = np.where(np.isfinite(depth), depth, np.nan).astype(np.float32)
            found = localizer.step(depth, told if odometer and frame else None)
            errors.append(found.state[:2] - true[:2])
            sigmas.append(np.sqrt(np.diag(found.error_covariance)[:2]))
            statuses.append(found.status)
    errors, sigmas = np.array(errors), np.array(sigmas)
    return Slide(errors[:, 0], sigmas[:, 0], np.abs(errors[:, 1]), sigmas[:, 1], statuses)
