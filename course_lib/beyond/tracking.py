"""Does the filter still hold the track? What its weights cannot say: they are normalized among the particles.

The image of every frame is compared with the map as seen from the frame's *estimate*, and a run of such comparisons is
judged frame by frame, looking back only. Nothing here knows the truth.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, likelihood, paired_pixels

TrackStatus = Literal["tracked", "doubtful", "lost"]

# Chosen on development recordings (tests/experiments/test_lost_on_purpose.py), in favour of never calling a lost filter tracked.
TRACKED_SUPPORT = 0.55  # least support, 1 to -1, of a frame that is tracked
LOST_SUPPORT = 0.45  # support below which it is lost
RECOVERED_SUPPORT = 0.7  # least support after it was lost: then it agrees by chance with walls that look alike
_FRAMES_TO_RECOVER = 3  # in a row with such support
_LEAST_PIXELS = 30  # with fewer a frame says nothing: a few stray returns are no view (chosen)
_FRAMES_MEANED = 3  # a person who walks through one image must not decide alone


class Agreement(NamedTuple):
    """How a measured image agrees with the map as seen from one pose; all but `pixels` are shares of these pixels."""

    pixels: int
    """How many pixels were measured; with none, the shares are NaN."""
    score: float
    """Eq. (8) divided by the number of pixels: 1 for perfect agreement."""
    agreeing: float
    """Within `ALPHA`, 0.1 m, of the map."""
    through: float
    """Measured more than `ALPHA` behind the map: what a person or a moved chair cannot do, but a wrong pose does."""

    @property
    def support(self) -> float:
        """What speaks for the pose less what speaks against it, agreeing - through: 1 to -1, NaN without a pixel.

        Pixels in front of the map count for neither (something that the map lacks stands there), nor do holes in it.
        """
        return self.agreeing - self.through


def agreement(measured: np.ndarray, simulated: np.ndarray) -> Agreement:
    """How a measured image `(H, W)` agrees with the image `(H, W)` of the map from one pose; metres.

    measured: NaN = no measurement; simulated: `inf` = nothing hit, as in `likelihood`, and the same errors.
    """
    valid, images = paired_pixels(measured, np.asarray(simulated)[None])
    pixels = int(valid.sum())
    if pixels == 0:
        return Agreement(0, np.nan, np.nan, np.nan)
    behind = np.asarray(measured, dtype=np.float64)[valid] - images[0][valid]  # -inf where the map is empty
    return Agreement(
        pixels,
        float(likelihood(measured, images, ALPHA)[0]) / pixels,
        float(np.mean(np.abs(behind) <= ALPHA)),
        float(np.mean(behind > ALPHA)),
    )


def judge_track(agreements: Sequence[Agreement]) -> list[TrackStatus]:
    """What each frame of a run is, from the frames so far.

    Lost: the mean support of the last three frames is below `LOST_SUPPORT`. Tracked: it reaches `TRACKED_SUPPORT`; once
    lost, only after it reached `RECOVERED_SUPPORT` in three frames one after the other. All else is doubtful, a frame
    with hardly any measurement too. Not seen by this: a pose that is wrong where the map looks alike, along a smooth
    wall or in the next bay.
    """
    statuses, lost, good_frames = [], False, 0
    for index, frame in enumerate(agreements):
        last = agreements[max(0, index + 1 - _FRAMES_MEANED) : index + 1]
        recent = [a.support for a in last if a.pixels >= _LEAST_PIXELS]
        support = np.mean(recent) if frame.pixels >= _LEAST_PIXELS else np.nan
        good_frames = good_frames + 1 if support >= RECOVERED_SUPPORT else 0
        lost = support < LOST_SUPPORT or (lost and good_frames < _FRAMES_TO_RECOVER)
        if support < LOST_SUPPORT:
            statuses.append("lost")
        else:
            statuses.append("tracked" if support >= TRACKED_SUPPORT and not lost else "doubtful")
    return statuses


# Chosen on runs of the annealed filter that were made to get lost (kitchen, shipped corridor, corridor seeds 10,011 to
# 10,014; 243 frames wrong by more than 0.2 m or 20 degrees: 96 % below the limit; 2,066 right ones: 0.1 %).
REFINED_LOST = 0.4
THROUGH_WEIGHT = 3.0  # what a pixel measured behind the map counts against a pose, in pixels that agree


def judge_refined(frame: Agreement) -> TrackStatus:
    """Whether a *refined* pose is wrong, from its own frame: lost where agreeing - 3 through is below `REFINED_LOST`.

    A pose that was refined fits as well as it can. If measurements still lie behind the map, where no light comes from,
    it is in the wrong place, however much agrees; a particle filter's estimate may lag by centimetres and look so.
    With hardly any pixel it is doubtful.
    """
    if frame.pixels < _LEAST_PIXELS:
        return "doubtful"
    return "lost" if frame.agreeing - THROUGH_WEIGHT * frame.through < REFINED_LOST else "tracked"
