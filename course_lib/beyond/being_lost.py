"""Is the filter lost? This module alone decides whether a pose is "tracked", "doubtful" or "lost".

Weights cannot say it, because they are normalized. Three things can: how the image agrees with the map (`agreement`);
the covariance (`is_known`); and the frames before, because walls look alike (`Debt`). Nothing here looks ahead.
"""

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, likelihood, paired_pixels

TrackStatus = Literal["tracked", "doubtful", "lost"]

MIN_PIXELS = 30  # with fewer a frame says nothing: a few stray returns are no view (chosen)

# Of `judge_track`; chosen (experiments/lost_on_purpose.py) so that a lost filter is hardly ever called tracked.
TRACKED_SUPPORT = 0.55  # smallest support, -1 to 1, of a frame that is tracked
LOST_SUPPORT = 0.45  # support below which it is lost
RECOVERED_SUPPORT = 0.7  # smallest support after it was lost, because walls that look alike agree by chance
_FRAMES_TO_RECOVER = 3  # in a row with this support
_FRAMES_MEANED = 3  # a person who walks through one image must not decide alone

# Of `judge_refined`; chosen on runs that were made to get lost (kitchen, shipped corridor, corridor seeds 10,011 to
# 10,014): 96 % of 243 frames wrong by more than 0.2 m or 20 degrees are below the limit, and 0.1 % of 2,066 right ones.
REFINED_LOST = 0.4
THROUGH_WEIGHT = 3.0  # a pixel measured behind the map counts against a pose as much as so many agreeing ones for it

# Of `TrackJudge`; chosen on the kitchen, the shipped corridor, and walks through rooms (seeds from 10,041 on).
FALLEN = 0.85  # of the usual support: a frame that agrees less is doubtful
MEMORY = 0.1  # share of a new frame in the usual support
# Metres, radians: largest standard deviations of a pose that is known. A start by hand has exactly these, to rounding.
KNOWN = np.array([0.2, np.deg2rad(20.0)]) + 1e-9
CONFIRMED = 3  # good frames that make up for any number of bad ones


class Agreement(NamedTuple):
    """How a measured image agrees with the map as seen from one pose; shares of the measured pixels."""

    pixels: int  # How many pixels were measured; with none, the shares are NaN.
    score: float  # Eq. (8) divided by the number of pixels: 1 for perfect agreement.
    agreeing: float  # Within `ALPHA`, 0.1 m, of the map.
    through: float  # More than `ALPHA` behind the map, as a wrong pose has it, but no person or moved chair.

    @property
    def support(self) -> float:
        """Return agreeing - through: -1 to 1, NaN without a pixel."""
        return self.agreeing - self.through

    @property
    def refined_support(self) -> float:
        """The same for a refined pose, agreeing - 3 through: 1 at best, NaN without a pixel."""
        return self.agreeing - THROUGH_WEIGHT * self.through

    @property
    def contradicts(self) -> bool:
        """Return whether surfaces of the map stand where the camera looked through; where the map is empty, none do."""
        return not self.refined_support >= 0.0


NOTHING_MEASURED = Agreement(0, np.nan, np.nan, np.nan)


def agreement(measured: np.ndarray, simulated: np.ndarray) -> Agreement:
    """Compare a measured image `(H, W)`, NaN = no measurement, with the map's image from one pose, `inf` = a miss."""
    valid, images = paired_pixels(measured, np.asarray(simulated)[None])
    pixels = int(valid.sum())
    if pixels == 0:
        return NOTHING_MEASURED
    behind = np.asarray(measured, dtype=np.float64)[valid] - images[0][valid]  # -inf where the map is empty
    return Agreement(
        pixels,
        float(likelihood(measured, images, ALPHA)[0]) / pixels,
        float(np.mean(np.abs(behind) <= ALPHA)),
        float(np.mean(behind > ALPHA)),
    )


def sigmas(covariance: np.ndarray) -> np.ndarray:
    """Return the standard deviations `(2,)` of position and rotation along the least known direction, m and rad."""
    return np.sqrt([np.linalg.eigvalsh(part)[-1] for part in (covariance[:3, :3], covariance[3:, 3:])])


def is_known(covariance: np.ndarray) -> bool:
    """Return whether a pose with this covariance `(6, 6)` is known to `KNOWN`: 0.2 m and 20 degrees."""
    return not (sigmas(covariance) > KNOWN).any()


class Debt:
    """Good frames that are owed after bad ones, as many as there were bad ones, at most `CONFIRMED`."""

    def __init__(self) -> None:
        self._frames = 0

    def add(self) -> None:
        """Take a bad frame into account."""
        self._frames = min(self._frames + 1, CONFIRMED)

    def is_paid(self, good: bool) -> bool:
        """Take a frame that is not bad into account; return whether no good frame is owed any more."""
        self._frames = max(self._frames - bool(good), 0)
        return self._frames == 0


def judge_track(agreements: Sequence[Agreement]) -> list[TrackStatus]:
    """Return the status of each frame of the paper's filter, from the frames so far.

    The mean support of the last three frames decides. Once lost, three frames in a row must reach `RECOVERED_SUPPORT`
    before a frame is tracked again.
    """
    statuses, lost, good_frames = [], False, 0
    for index, frame in enumerate(agreements):
        last = agreements[max(0, index + 1 - _FRAMES_MEANED) : index + 1]
        recent = [a.support for a in last if a.pixels >= MIN_PIXELS]
        support = np.mean(recent) if frame.pixels >= MIN_PIXELS else np.nan
        good_frames = good_frames + 1 if support >= RECOVERED_SUPPORT else 0
        lost = support < LOST_SUPPORT or (lost and good_frames < _FRAMES_TO_RECOVER)
        if support < LOST_SUPPORT:
            statuses.append("lost")
        else:
            statuses.append("tracked" if support >= TRACKED_SUPPORT and not lost else "doubtful")
    return statuses


def judge_refined(frame: Agreement) -> TrackStatus:
    """Return the status of a *refined* pose from its own image: lost if agreeing - 3 through is below `REFINED_LOST`.

    If measurements still lie behind the map after refinement, the pose is wrong, however much else agrees.
    """
    if frame.pixels < MIN_PIXELS:
        return "doubtful"
    return "lost" if frame.refined_support < REFINED_LOST else "tracked"


class TrackJudge:
    """The status of each frame of the annealed filter; it remembers the usual support and the debt of good frames."""

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
