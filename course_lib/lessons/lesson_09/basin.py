"""From how far off Gauss-Newton comes back to the true pose: its basin of convergence."""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.poses import retract
from course_lib.beyond.six_dof.refinement import refine
from course_lib.beyond.six_dof.schedule import STEPS, Level, pyramid
from course_lib.depth_mcl.evaluation import pose_errors
from course_lib.lessons.kit.corridor_views import corridor_map
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.lesson_09.hand import hand_run
from course_lib.rendering.renderer import DepthRenderer

OFFSETS = (0.05, 0.1, 0.15, 0.2, 0.3, 0.4)  # metres; turned by `DEGREES_PER_METRE` as much at once
DEGREES_PER_METRE = 60.0
BACK = (0.05, 2.0)  # metres, degrees: nearer than that it has come back
FRAMES = (15, 30, 45, 60, 75, 90, 105, 120)
SCALES = tuple(step.scale for step in STEPS)  # the filter's own, here all on the coarse image


@functools.cache
def levels() -> list[Level]:
    """The three image sizes of the corridor and the camera carried by hand."""
    return pyramid(DepthRenderer(corridor_map(), hand_run().camera()))


class Basin(NamedTuple):
    """What became of starts, all equally far off."""

    offset: float
    """Metres."""
    end_position: np.ndarray
    """`(F, S)` error after the last step [m]: a row for each of `FRAMES`, a column for each start."""
    end_rotation: np.ndarray
    """`(F, S)` [degrees]."""

    @property
    def back(self) -> np.ndarray:
        """`(F, S)` whether the start came back."""
        return (self.end_position <= BACK[0]) & (self.end_rotation <= BACK[1])


def measure_basin(rng: np.random.Generator, starts: int = 12) -> list[Basin]:
    """Refines true poses that were moved and turned in random directions, `starts` in each of `FRAMES`."""
    coarse, true = levels()[0], hand_run().camera_to_world
    ends: dict[float, list] = {offset: [] for offset in OFFSETS}
    for frame in progress(FRAMES, "from how far off?"):
        coarse.measure(hand_run().depth(frame))
        poses = np.tile(true[frame], (starts, 1, 1))
        for offset in OFFSETS:
            motions = directions(starts, rng) * np.repeat([offset, np.deg2rad(offset * DEGREES_PER_METRE)], 3)
            ends[offset].append(
                pose_errors(refine(coarse.renderer, coarse.measured, retract(poses, motions), SCALES), poses)
            )
    return [
        Basin(offset, np.array([p for p, _ in found]), np.rad2deg([r for _, r in found]))
        for offset, found in ends.items()
    ]


def directions(n: int, rng: np.random.Generator) -> np.ndarray:
    """Motions `(n, 6)` in random directions: three parts of length one, and three more."""
    halves = rng.standard_normal((n, 2, 3))
    return (halves / np.linalg.norm(halves, axis=-1, keepdims=True)).reshape(n, 6)
