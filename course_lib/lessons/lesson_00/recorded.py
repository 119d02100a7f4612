"""What lesson 00 looks at: one frame of the corridor's recording, and what the map would show from other poses."""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, likelihood, valid_pixels
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.geometry import BODY_FROM_OPTICAL, pose_matrix, state_from_optical_pose
from course_lib.lessons.kit.box_world import box_map
from course_lib.lessons.kit.corridor_views import corridor_map, wagon_run
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer

FRAME = 100  # of the corridor run: benches, doors and pillars in view, nothing special (chosen)
CEILING = 2.6  # metres above the floor, in the corridor
_SURFACE = 0.08  # metres: what is nearer to floor or ceiling belongs to it (chosen)
PAIR = 3  # of the room's experiment 1: most objects in view, nothing special (chosen)


class Moment(NamedTuple):
    """One frame of the recording, with all that it is compared with."""

    measured: np.ndarray
    """`(H, W)` metres, NaN where nothing was measured."""
    state: np.ndarray
    """`(6,)` the true pose."""
    renderer: DepthRenderer

    def share(self, states: np.ndarray) -> np.ndarray:
        """l / m `(N,)`: the likelihood, eq. (8), divided by the number of measured pixels: 1 for perfect agreement."""
        return likelihood(self.measured, self.renderer.render(states)) / valid_pixels(self.measured).sum()


@functools.cache
def moment(frame: int = FRAME) -> Moment:
    """A frame of the corridor run with the map's renderer; kept, since a panel asks for it again and again."""
    sequence = wagon_run()
    renderer = DepthRenderer(corridor_map(), sequence.camera())
    return Moment(sequence.depth(frame), state_from_optical_pose(sequence.camera_to_world[frame]), renderer)


def wall_reads(distance: float) -> float:
    """Depth [m] that the renderer gives for a wall `distance` metres ahead: does drawing work on this computer?"""
    wall = box_map(((distance, -9.0, -9.0), (distance + 0.1, 9.0, 9.0)))
    with DepthRenderer(wall, DepthCamera.sr4000()) as renderer:
        return float(renderer.render(np.zeros(6))[0, 72, 88])


def moved(state: np.ndarray, name: str, offsets: np.ndarray) -> np.ndarray:
    """States `(N, 6)`: one state, moved along "x" or "y" (metres) or turned by "yaw" (degrees)."""
    states = np.tile(state, (len(np.atleast_1d(offsets)), 1))
    states[:, {"x": 0, "y": 1, "yaw": 5}[name]] += np.deg2rad(offsets) if name == "yaw" else offsets
    return states


def mean_votes(now: Moment, back: float) -> dict[str, tuple[float, float]]:
    """Mean term of eq. (8), 0 to 1, of the pixels on each surface: at the true pose, and from `back` metres behind it.

    Which surface a pixel sees is what the map shows there from the true pose: floor and ceiling by their heights,
    the side walls with all that stands before them by the side of the camera's path on which they are.
    """
    states = np.stack([now.state, now.state - [back, 0, 0, 0, 0, 0]])
    views = now.renderer.render(states)
    votes = ALPHA / (ALPHA + np.abs(now.measured - views))
    pose = pose_matrix(now.state)
    optical = np.where(np.isfinite(views[0]), views[0], 0)[..., None] * now.renderer.camera.rays()
    seen = optical @ (pose[:3, :3] @ BODY_FROM_OPTICAL).T + pose[:3, 3]
    y, z = seen[..., 1], seen[..., 2]
    floor, ceiling = z < _SURFACE, z > CEILING - _SURFACE
    parts = {"floor": floor, "ceiling": ceiling}
    parts |= {"left side": ~floor & ~ceiling & (y > 0), "right side": ~floor & ~ceiling & (y <= 0)}
    both = valid_pixels(now.measured) & np.isfinite(views).all(axis=0)
    return {name: tuple(votes[:, part & both].mean(axis=1).tolist()) for name, part in parts.items()}


def true_positions(sequence: DepthSequence, frames: range) -> np.ndarray:
    """True camera positions `(T, 3)` [m] of some frames."""
    return sequence.camera_to_world[frames.start : frames.stop : frames.step, :3, 3]
