"""Does the filter still hold the track? What its weights cannot say: they are normalized among the particles.

The image of every frame is compared with the map as seen from the frame's *estimate*, and a run of such comparisons is
judged frame by frame, looking back only. Nothing here knows the truth.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, NamedTuple

import numpy as np

from course_lib.depth_mcl.likelihood import ALPHA, likelihood, paired_pixels

TrackStatus = Literal["tracked", "doubtful", "lost"]


class Agreement(NamedTuple):
    """How a measured image agrees with the map as seen from one pose; all but `pixels` are shares of these pixels."""

    pixels: int
    """How many pixels were measured; with none, the shares are NaN."""
    score: float
    """Eq. (8) divided by the number of pixels: 1 for perfect agreement."""
    agreeing: float
    """Within 0.1 m of the map (`ALPHA`)."""
    through: float
    """Measured more than 0.1 m behind the map, or where the map is empty: light went through a wall that is there."""


def agreement(measured: np.ndarray, simulated: np.ndarray) -> Agreement:
    """How a measured image `(H, W)` agrees with the image `(H, W)` of the map from one pose; metres."""
    valid, images = paired_pixels(measured, np.asarray(simulated)[None])
    pixels = int(valid.sum())
    if pixels == 0:
        return Agreement(0, np.nan, np.nan, np.nan)
    difference = np.asarray(measured, dtype=np.float64)[valid] - images[0][valid]
    return Agreement(
        pixels,
        float(likelihood(measured, images, ALPHA)[0]) / pixels,
        float(np.mean(np.abs(difference) <= ALPHA)),
        float(np.mean(difference > ALPHA)),
    )


def judge_track(agreements: Iterable[Agreement]) -> list[TrackStatus]:
    """What each frame of a run is: "tracked", "doubtful" or "lost"."""
    return ["tracked" for _ in agreements]
