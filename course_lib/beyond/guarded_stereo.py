"""Pairs of panoramas as they come from a rig that moves: each is looked at first, and says what became of it.

    watched = WatchedRig(localizer, period=1.0)
    for upper, lower, time in pairs:
        outcome = watched.localize(upper, lower, time).outcome      # "ok", or why there is no pose

The localizer itself knows one pair and no other; what only a stream can tell, a pair that came once more or out of
order, is told here. A pair at fault changes nothing for the pairs after it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from course_lib.beyond.guarded_frames import FrameOrder
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.matching.feature_matching import SwappedImagesError
from course_lib.spherical_stereo.pose.localization import OK, SWAPPED, Localization

NO_IMAGE = "no image"
"""What a caller says of a pair that was due and never came."""


class WatchedPair(NamedTuple):
    """What became of a pair."""

    outcome: str
    """ "ok"; "out of order" or "repeated" (guarded_frames.py); or one of the reasons of `pose.localization` and of the
    fit why there is no pose."""
    localization: Localization | None
    """None where the pair was not looked into."""
    missed: int
    """Pairs that should have come before this one, and did not."""


class WatchedRig:
    """A `SemanticLocalizer` that is given one pair after another. period: seconds between pairs; None: unknown."""

    def __init__(self, localizer: SemanticLocalizer, period: float | None = None) -> None:
        self.localizer = localizer
        self._order = FrameOrder(period)

    def localize(self, upper_image: np.ndarray, lower_image: np.ndarray, time: float | None = None) -> WatchedPair:
        """What two panoramas, taken at `time` (seconds; None: unknown), say of the pose.

        Exchanged images, an error of the caller's to `SemanticLocalizer`, are an outcome in a stream: a cable does it.
        Raises `PanoramaError` for what is no pair of panoramas, `ValueError` for a time that is not finite.
        """
        frame = self._order.look((np.asarray(upper_image), np.asarray(lower_image)), time)
        if frame.fault is not None:
            return WatchedPair(frame.fault, None, frame.missed)
        try:
            found = self.localizer.localize(upper_image, lower_image)
        except SwappedImagesError:
            return WatchedPair(SWAPPED, None, frame.missed)
        return WatchedPair(OK if found.status == OK else str(found.reason), found, frame.missed)
