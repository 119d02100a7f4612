"""Pairs of panoramas from a rig that moves: each pair is checked first, and gets an outcome."""

from typing import NamedTuple

import numpy as np

from course_lib.beyond.guarded_frames import FrameOrder
from course_lib.depth_mcl.one_at_a_time import one_at_a_time
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.matching.alignment import SwappedImagesError
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.pose.localization import Localization

NO_IMAGE = "no image"  # The outcome of a pair that was due and never came.


class GuardedPair(NamedTuple):
    """What became of one pair."""

    outcome: str  # "ok"; "out of order" or "repeated"; or the `Reason` why there is no pose
    localization: Localization | None  # None if the pair was not used.
    missed: int  # Pairs that should have come before this one, and did not.


class GuardedRig:
    """A `SemanticLocalizer` that is given one pair after another. period: seconds between pairs; None: unknown."""

    def __init__(self, localizer: SemanticLocalizer, period: float | None = None) -> None:
        self.localizer = localizer
        self._order = FrameOrder(period)

    @one_at_a_time
    def localize(self, upper_image: np.ndarray, lower_image: np.ndarray, time: float | None = None) -> GuardedPair:
        """Return the outcome of two panoramas, taken at `time` (seconds; None: unknown), also of exchanged ones."""
        frame = self._order.look((np.asarray(upper_image), np.asarray(lower_image)), time)
        if frame.fault is not None:
            return GuardedPair(frame.fault, None, frame.missed)
        try:
            found = self.localizer.localize(upper_image, lower_image)
        except SwappedImagesError:
            return GuardedPair(Reason.SWAPPED, None, frame.missed)
        return GuardedPair(found.reason or found.status, found, frame.missed)
