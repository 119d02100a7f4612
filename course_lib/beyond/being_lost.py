"""Judge whether the annealed filter is lost. `depth_mcl.status` explains the words, and judges the paper's filter.

A refined pose fits as well as it can, so one image says more of it (`judge_refined`). The covariance and the frames
before say the rest (`TrackJudge`), because walls look alike. Nothing here looks ahead.
"""

import numpy as np

from course_lib.depth_mcl.status import MIN_PIXELS, Agreement, TrackStatus, is_known

# Of `judge_refined`; chosen with `AGREES_WITHIN` = 0.1 m on runs that were made to get lost (kitchen, shipped corridor,
# corridor seeds 10,011 to 10,014): 96 % of 243 frames wrong by more than 0.2 m or 20 degrees are below the limit, and
# 0.1 % of 2,066 right ones.
REFINED_LOST = 0.4

# Of `TrackJudge`; chosen with the same value on the kitchen, the shipped corridor, and walks through rooms (seeds from
# 10,041 on).
FALLEN = 0.85  # of the usual support: a frame that agrees less is doubtful
MEMORY = 0.1  # share of a new frame in the usual support
CONFIRMED = 3  # good frames that make up for any number of bad ones


class Debt:
    """Counts how many good frames must come before a pose is trusted: one for each bad frame, at most `CONFIRMED`."""

    def __init__(self) -> None:
        self._frames = 0

    def add(self) -> None:
        """Take a bad frame into account."""
        self._frames = min(self._frames + 1, CONFIRMED)

    def is_paid(self, good: bool) -> bool:
        """Take a frame that is not bad into account; return whether enough good frames have come."""
        self._frames = max(self._frames - bool(good), 0)
        return self._frames == 0


def judge_refined(frame: Agreement) -> TrackStatus:
    """Return the status of a *refined* pose from its own image: lost if agreeing - 3 through is below `REFINED_LOST`.

    If measurements still lie behind the map after refinement, the pose is wrong, however much else agrees.
    """
    if frame.pixels < MIN_PIXELS:
        return "doubtful"
    return "lost" if frame.refined_support < REFINED_LOST else "tracked"


class TrackJudge:
    """Judges the frames of the annealed filter, one after the other; it remembers the usual support and the debt."""

    def __init__(self) -> None:
        self._usual_support: float | None = None
        self._debt = Debt()
        self._lost_for = self._known_for = 0  # frames of the last loss without a known pose, and with one since

    def doubts(self, agreement: Agreement) -> bool:
        """Return whether a frame agrees clearly less than usual."""
        return self._usual_support is not None and agreement.support < FALLEN * self._usual_support

    def judge_image(self, agreement: Agreement) -> TrackStatus:
        """Return what a frame's own image says of its refined pose."""
        status = judge_refined(agreement)
        return "doubtful" if status == "tracked" and self.doubts(agreement) else status

    def judge(self, image: TrackStatus, agreement: Agreement, covariance: np.ndarray, has_rivals: bool) -> TrackStatus:
        """Return a frame's status; called once per frame. image: `judge_image` of it. covariance: `(6, 6)`.

        After lost frames it stays lost for as many frames as it was lost, at least `CONFIRMED`, and is doubtful until
        the debt of good frames without a rival is paid.
        """
        status = image if is_known(covariance) else "lost"
        if status == "lost":
            self._debt.add()
            self._lost_for, self._known_for = self._lost_for + 1, 0
        else:
            self._known_for += 1
            if not self._debt.is_paid(status == "tracked" and not has_rivals):
                status = "doubtful" if self._known_for >= max(self._lost_for, CONFIRMED) else "lost"
            self._lost_for *= status == "lost"
        if status == "tracked" or self._usual_support is None:
            usual, support = self._usual_support, agreement.support
            self._usual_support = support if usual is None else (1 - MEMORY) * usual + MEMORY * support
        return status
