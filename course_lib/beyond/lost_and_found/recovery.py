"""Carried away while it could not see: the filter notices by its raw score, and searches.

A short and a long running mean of the raw score are kept (augmented MCL: Thrun, Burgard, Fox, Probabilistic Robotics,
8.3.5). A global search begins if the short mean falls well below the long one and the pose cannot be right, or if the
camera was covered. The filter goes on and suggests its pose as one candidate among others. The search decides.
"""

from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.lost_and_found.global_search import TILT_SIGMA, GlobalSearch, PoseCandidates, same_place
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer

# All chosen on development recordings (the kitchen, the shipped corridor, corridor seeds from 10,001 on).
SHORT, LONG = 0.4, 0.03  # shares of a new frame in the two means
ALARM = 0.8  # the short mean below this share of the long one
COVERED = 3  # frames in a row without a measurement, in which the camera may have been carried away
PATIENCE = 20  # frames of a search that cannot decide, after which a filter that is tracked is believed
UNKNOWN_TILT_SIGMA = np.deg2rad(15.0)  # of the last tracked frame's tilt, which serves without an accelerometer


Mode = Literal["following", "searching", "found again"]  # the last if the search set the filter to a new place


class RecoveryEstimate(NamedTuple):
    """What one frame gave."""

    estimate: AnnealedEstimate  # Of the filter; its status says what it is worth.
    mode: Mode
    candidates: PoseCandidates | None  # The answer of the search, while there is one.
    short: float
    long: float  # The two means of the raw score.


class RecoveringLocalizer:
    """`AnnealedLocalizer` that searches when it is lost. search: arguments of `GlobalSearch`; others as there."""

    def __init__(self, renderer: DepthRenderer, n_particles: int = 200, *, seed: int = 0, **search: object) -> None:
        self.localizer = AnnealedLocalizer(renderer, n_particles, seed=seed)
        self.search = GlobalSearch(renderer, seed=seed, **search)
        self.searching = False
        self._short: float | None = None
        self._long: float | None = None
        self._covered = self._searched = 0
        self._down = np.array([0.0, 1.0, 0.0])  # in the camera, of the last frame that was tracked: upright

    @one_at_a_time
    def initialize(self, state0: np.ndarray) -> None:
        """Say where the camera is, as `AnnealedLocalizer.initialize` does."""
        self.localizer.initialize(state0)
        self._down = _down_in_camera(np.asarray(state0, dtype=np.float64))
        self._short = self._long = None
        self._covered, self.searching = 0, False

    @one_at_a_time
    def step(
        self, depth: np.ndarray, increment: np.ndarray | None = None, gravity: np.ndarray | None = None
    ) -> RecoveryEstimate:
        """Return where the camera is, from a depth image; arguments and errors as in `AnnealedLocalizer.step`.

        gravity: `(3,)` down in the camera's optical frame; without it a search assumes the last tilt.
        """
        estimate = self.localizer.step(depth, increment)
        if estimate.status == "no measurement":
            self._covered += 1
            return RecoveryEstimate(estimate, self._mode(), None, self._short or 0.0, self._long or 0.0)
        self._remember(estimate)
        alarm = estimate.status == "lost" and self._short < ALARM * self._long
        if not self.searching and (self._covered >= COVERED or alarm):
            self.searching, self._searched = True, 0
            self.search.forget()
        self._covered = 0
        if not self.searching:
            self._down = _down_in_camera(estimate.state)
            return RecoveryEstimate(estimate, "following", None, self._short, self._long)
        tilt = TILT_SIGMA if gravity is not None else UNKNOWN_TILT_SIGMA
        candidates = self.search.step(depth, self._down if gravity is None else gravity, tilt, estimate.state)
        self._searched += 1
        mode = self._decide(estimate, candidates)
        if mode == "found again":
            estimate = self.localizer.step(depth)
        return RecoveryEstimate(estimate, mode, candidates, self._short, self._long)

    def _decide(self, estimate: AnnealedEstimate, candidates: PoseCandidates) -> Mode:
        """End the search if it knows, and set the filter to the pose that it found, unless it is there already."""
        if candidates.status == "found":
            best = candidates.poses[0].state
            self.searching, self._short = False, self._long
            if same_place(optical_pose(best), optical_pose(estimate.state)):
                return "following"
            self.localizer.initialize(best)
            return "found again"
        self.searching = self._searched < PATIENCE or estimate.status != "tracked"
        return self._mode()

    def _mode(self) -> Mode:
        return "searching" if self.searching else "following"

    def _remember(self, estimate: AnnealedEstimate) -> None:
        self._short = _mean(self._short, estimate.score, SHORT)
        if not self.searching:  # a lost filter does not score as usual
            self._long = _mean(self._long, estimate.score, LONG)


def _mean(before: float | None, new: float, share: float) -> float:
    return new if before is None else (1 - share) * before + share * new


def _down_in_camera(state: np.ndarray) -> np.ndarray:
    """Return the world's down `(3,)` in the optical frame of a state `(6,)`."""
    return -optical_pose(state)[2, :3]
