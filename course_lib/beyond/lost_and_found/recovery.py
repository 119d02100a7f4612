"""Notice that the filter is lost, or was carried away while it could not see, and search.

A global search begins if the filter was lost for some frames in a row, or if the camera was covered. The filter goes on
and suggests its pose as one candidate among others. The search decides.
"""

from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.being_lost import CONFIRMED, Debt, judge_refined
from course_lib.beyond.lost_and_found.global_search import GlobalSearch, PoseCandidates, same_place
from course_lib.beyond.six_dof.localizer import AnnealedEstimate, AnnealedLocalizer
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer

# All chosen on development recordings (the kitchen, the shipped corridor, corridor seeds from 10,001 on).
LOST = 3  # frames in a row: a filter that is lost for a frame or two often finds itself
UNKNOWN = 12  # the same, if the images agree and only the covariance is wide: along a bare wall no search helps soon
COVERED = 3  # frames in a row without a measurement, in which the camera may have been carried away
PATIENCE = 20  # frames of a search that cannot decide, after which a filter that is tracked is believed

Mode = Literal["following", "searching", "found again"]  # the last if the search set the filter to a new place


class RecoveryEstimate(NamedTuple):
    """The result of one frame."""

    estimate: AnnealedEstimate  # at best "doubtful" while a search goes on or the start is unconfirmed
    mode: Mode
    candidates: PoseCandidates | None  # the answer of the search, while there is one


class RecoveringLocalizer:
    """Follow the camera as `AnnealedLocalizer` does, and search when it is lost. search: arguments of `GlobalSearch`.

    A start may be wrong, and one image can agree by chance. So the status is at best "doubtful" until `CONFIRMED` good
    frames after it. The search is made when it is needed for the first time. It raises `ValueError` for a map without
    free space.
    """

    takes = frozenset({"increment", "gravity"})  # what `step` can use in addition to the image

    def __init__(self, renderer: DepthRenderer, n_particles: int = 200, *, seed: int = 0, **search: object) -> None:
        self.renderer = renderer
        self.localizer = AnnealedLocalizer(renderer, n_particles, seed=seed)
        self.motion = self.localizer.motion
        self.searching = False
        self._search: GlobalSearch | None = None
        self._of_search = {"seed": seed, **search}
        self._debt = Debt()  # of good frames, after a start that no image has confirmed yet
        self._lost = self._covered = self._searched = 0
        self._down = np.array([0.0, 1.0, 0.0])  # in the camera, of the last frame that was tracked: upright

    @property
    def search(self) -> GlobalSearch:
        """Return the search, made at first use."""
        if self._search is None:
            self._search = GlobalSearch(self.renderer, **self._of_search)
        return self._search

    @one_at_a_time
    def initialize(self, state0: np.ndarray) -> None:
        """Say where the camera is, as `AnnealedLocalizer.initialize` does."""
        self.localizer.initialize(state0)
        self._down = _down_in_camera(np.asarray(state0, dtype=np.float64))
        self._debt = Debt()
        for _ in range(CONFIRMED):
            self._debt.add()
        self._lost, self._covered, self.searching = 0, 0, False

    @one_at_a_time
    def step(
        self, depth: np.ndarray, increment: np.ndarray | None = None, gravity: np.ndarray | None = None
    ) -> RecoveryEstimate:
        """Return where the camera is, from a depth image; arguments and errors as in `AnnealedLocalizer.step`.

        gravity: `(3,)` down in the camera's optical frame; without it a search measures it in the image, or assumes the
        last tilt.
        """
        estimate = self.localizer.step(depth, increment)
        if estimate.status == "no measurement":
            self._covered += 1
            return RecoveryEstimate(estimate, self._mode(), None)
        self._lost = self._lost + 1 if estimate.status == "lost" else 0
        confirmed = self._debt.is_paid(estimate.status == "tracked")
        frames = UNKNOWN if confirmed and judge_refined(estimate.agreement) != "lost" else LOST
        if not self.searching and (self._covered >= COVERED or self._lost >= frames):
            self.searching, self._searched = True, 0
            self.search.forget()
        self._covered = 0
        if not self.searching:
            self._down = _down_in_camera(estimate.state)
            estimate = estimate if confirmed else _doubtful(estimate)
            return RecoveryEstimate(estimate, "following", None)
        candidates = self.search.step(depth, gravity, suggested=estimate.state, assumed=self._down)
        self._searched += 1
        mode = self._decide(estimate, candidates)
        if mode == "found again":
            estimate = self.localizer.step(depth)
        elif mode == "searching":
            estimate = _doubtful(estimate)
        estimate = estimate._replace(renders=estimate.renders + candidates.renders)
        return RecoveryEstimate(estimate, mode, candidates)

    def _decide(self, estimate: AnnealedEstimate, candidates: PoseCandidates) -> Mode:
        """End the search if it knows, and set the filter to the pose that it found, unless it is there already."""
        if candidates.status == "found":
            best = candidates.poses[0].state
            self.searching, self._lost, self._debt = False, 0, Debt()
            if same_place(optical_pose(best), optical_pose(estimate.state)):
                return "following"
            self.localizer.initialize(best)
            return "found again"
        self.searching = self._searched < PATIENCE or estimate.status != "tracked"
        return self._mode()

    def _mode(self) -> Mode:
        return "searching" if self.searching else "following"


def _doubtful(estimate: AnnealedEstimate) -> AnnealedEstimate:
    return estimate._replace(status="doubtful") if estimate.status == "tracked" else estimate


def _down_in_camera(state: np.ndarray) -> np.ndarray:
    """Return the world's down `(3,)` in the optical frame of a state `(6,)`."""
    return -optical_pose(state)[2, :3]
