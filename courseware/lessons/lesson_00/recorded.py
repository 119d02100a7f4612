"""What lesson 00 looks at: one frame of the corridor's recording, and what the map would show from other poses."""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, likelihood, valid_pixels
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer
from courseware.lessons.kit.box_world import box_map
from courseware.lessons.kit.corridor_data import corridor_map, wagon_run

FRAME = 100  # of the corridor run: benches, doors and pillars in view, nothing special (chosen)


class Moment(NamedTuple):
    """One frame: the measured depths `(H, W)` [m], the true pose `(6,)`, and a renderer of the map."""

    measured: np.ndarray
    state: np.ndarray
    renderer: DepthRenderer

    def share(self, states: np.ndarray) -> np.ndarray:
        """Return l / m `(N,)`: eq. (8) divided by the number of measured pixels. 1 is perfect agreement."""
        return likelihood(self.measured, self.renderer.render(states)) / valid_pixels(self.measured).sum()


@functools.cache
def moment() -> Moment:
    """Return frame `FRAME` of the corridor run."""
    run = wagon_run()
    state = state_from_optical_pose(run.camera_to_world[FRAME])
    return Moment(run.depth(FRAME), state, DepthRenderer(corridor_map(), run.camera()))


def wall_reads(distance: float) -> float:
    """Return the depth [m] that the renderer gives for a wall `distance` metres ahead. It shows that drawing works."""
    wall = box_map(((distance, -9.0, -9.0), (distance + 0.1, 9.0, 9.0)))
    with DepthRenderer(wall, DepthCamera.sr4000()) as renderer:
        return float(renderer.render(np.zeros(6))[0, 72, 88])


def moved(state: np.ndarray, name: str, offsets: np.ndarray) -> np.ndarray:
    """Return states `(N, 6)`: one state, moved along "x" or "y" (metres) or turned by "yaw" (degrees)."""
    by = np.deg2rad(offsets) if name == "yaw" else offsets
    return state + np.outer(by, np.eye(6)[{"x": 0, "y": 1, "yaw": 5}[name]])


def mean_votes(now: Moment, back: float) -> dict[str, tuple[float, float]]:
    """Return the mean term of eq. (8) on each surface, at the true pose and from `back` metres behind it.

    The map tells which surface a pixel sees from the true pose. Things in front of a side wall belong to it.
    """
    views = now.renderer.render(np.stack([now.state, now.state - [back, 0, 0, 0, 0, 0]]))
    votes = ALPHA / (ALPHA + np.abs(now.measured - views))
    both = valid_pixels(now.measured) & np.isfinite(views).all(axis=0)
    pose = optical_pose(now.state)
    seen = now.renderer.camera.points(np.where(both, views[0], 0)) @ pose[:3, :3].T + pose[:3, 3]
    floor, ceiling, left = seen[..., 2] < 0.08, seen[..., 2] > 2.6 - 0.08, seen[..., 1] > 0  # the ceiling is at 2.6 m
    side = ~floor & ~ceiling
    parts = {"floor": floor, "ceiling": ceiling, "left side": side & left, "right side": side & ~left}
    return {name: tuple(votes[:, part & both].mean(axis=1).tolist()) for name, part in parts.items()}
