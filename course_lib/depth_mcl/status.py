"""Say how far a pose can be believed: the four words that all filters here use, and the judge of the paper's filter.

"tracked"          the pose can be relied on: the image agrees with the map, and the covariance is small
"doubtful"         the pose may be right, but this frame and those before it do not show it
"lost"             the image contradicts the pose, or has done so and not yet agreed for long enough
"no measurement"   the pose is only predicted: the frame measured nothing, or the watch refused it (`GuardedLocalizer`)

The weights cannot tell a lost filter from one that holds the track, because they are normalized. Three things can: how
the image agrees with the map as seen from the pose (`agreement`), the covariance (`is_known`), and the frames before,
because walls look alike. Nothing here looks ahead. The paper does not ask; the annealed filter has a judge of its own
(`beyond.being_lost`).
"""

from collections import deque
from typing import Literal, NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import likelihood, paired_pixels

TrackStatus = Literal["tracked", "doubtful", "lost", "no measurement"]

# Metres: a pixel so near to the map agrees with it. All limits below, and those of `beyond.being_lost`, were chosen
# with this value. It is not eq. (8)'s alpha, which was 0.1 m when they were chosen, too, and may change alone.
AGREES_WITHIN = 0.1
MIN_PIXELS = 30  # with fewer measured pixels a frame says nothing: a few stray returns are no view (chosen)

# Support from -1 to 1, chosen on runs that were made to get lost (tests/experiments/test_lost_on_purpose.py), so that a
# lost filter is hardly ever called tracked.
TRACKED_SUPPORT = 0.55  # smallest support of a frame that is tracked
LOST_SUPPORT = 0.45  # support below which a frame is lost
RECOVERED_SUPPORT = 0.7  # smallest support after a loss, because walls that look alike agree by chance
_FRAMES_TO_RECOVER = 3  # in a row with this support
_FRAMES_AVERAGED = 3  # a person who walks through one image must not decide alone
THROUGH_WEIGHT = 3.0  # a pixel behind the map counts as much against a refined pose as three agreeing ones for it

# Metres, radians: largest standard deviations of a pose that is known. A start by hand has exactly these, to rounding.
KNOWN = np.array([0.2, np.deg2rad(20.0)]) + 1e-9
# A filter with more than three free components makes wrong poses fit, too. So it is tracked only if the frame itself
# has `RECOVERED_SUPPORT`, and the position is known to this, metres. The limit was chosen on the frames on which it is
# counted here, and not on fresh ones, so the counts flatter. With 100 and 200 particles on the shipped corridor,
# a real Kinect's kitchen and a small furnished room, none of 811 frames that are wrong by more than 0.2 m or 20 degrees
# is tracked, and 20 of 27 within 5 cm and 5 degrees are.
KNOWN_OF_MORE = 0.08


class Agreement(NamedTuple):
    """How a measured image agrees with the map as seen from one pose; shares of the measured pixels."""

    pixels: int  # how many pixels were measured; with none, the shares are NaN
    score: float  # eq. (8) with its usual alpha, divided by the number of pixels: 1 for perfect agreement
    agreeing: float  # within `AGREES_WITHIN` of the map
    through: (
        float  # more than `AGREES_WITHIN` behind the map, as at a wrong pose; a person or a chair is in front of it
    )

    @property
    def support(self) -> float:
        """Return agreeing - through: -1 to 1, NaN without a pixel."""
        return self.agreeing - self.through

    @property
    def refined_support(self) -> float:
        """Return agreeing - 3 through, the support of a refined pose: 1 at best, NaN without a pixel."""
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
        float(likelihood(measured, images)[0]) / pixels,
        float(np.mean(np.abs(behind) <= AGREES_WITHIN)),
        float(np.mean(behind > AGREES_WITHIN)),
    )


def sigmas(covariance: np.ndarray) -> np.ndarray:
    """Return the standard deviations `(2,)` of position and rotation along the least known direction, m and rad."""
    return np.sqrt([np.linalg.eigvalsh(part)[-1] for part in (covariance[:3, :3], covariance[3:, 3:])])


def is_known(covariance: np.ndarray) -> bool:
    """Return whether a pose with this covariance `(6, 6)` is known to `KNOWN`: 0.2 m and 20 degrees."""
    return not (sigmas(covariance) > KNOWN).any()


class FilterJudge:
    """Judges the frames of the paper's filter, one after the other.

    The mean support of the last three frames decides. After a loss three frames in a row must reach
    `RECOVERED_SUPPORT`. A pose that is not known is doubtful at best.
    """

    def __init__(self, n_free: int) -> None:
        self._is_strict = n_free > 3  # components that the filter estimates
        self._supports: deque[float] = deque(maxlen=_FRAMES_AVERAGED)
        self._lost, self._good_frames = False, 0

    def judge(self, frame: Agreement, covariance: np.ndarray) -> TrackStatus:
        """Return a frame's status; called once per frame. covariance: `(6, 6)` of the error to expect."""
        is_view = frame.pixels >= MIN_PIXELS
        self._supports.append(frame.support if is_view else np.nan)
        support = np.nanmean(self._supports) if is_view else np.nan
        self._good_frames = self._good_frames + 1 if support >= RECOVERED_SUPPORT else 0
        self._lost = support < LOST_SUPPORT or (self._lost and self._good_frames < _FRAMES_TO_RECOVER)
        if frame.pixels == 0:
            return "no measurement"
        if support < LOST_SUPPORT:
            return "lost"
        if self._lost or not support >= TRACKED_SUPPORT or not is_known(covariance):
            return "doubtful"
        if self._is_strict and (frame.support < RECOVERED_SUPPORT or sigmas(covariance)[0] > KNOWN_OF_MORE):
            return "doubtful"
        return "tracked"
