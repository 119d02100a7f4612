"""Whether a sensor's frame is a new one: later than the last, and not the last image once more. Both methods ask it.

A driver that stumbles hands out the old image under a new time, or an image that was overtaken; after a stall frames
are missing. None of it can be seen in the image alone, so what the last frames were must be remembered.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

Order = Literal["in order", "out of order", "repeated"]

CLOCK_WAS_SET = 3  # frames in a row, behind the latest but ascending, after which the clock was set back (chosen)
MOST_MISSED = 50  # frames that a gap is counted as, at most: after a longer one no motion model knows anything (chosen)


class Place(NamedTuple):
    """Where a frame stands among those before it."""

    order: Order
    missed: int
    """How many frames should have come since the last one that came in order, and did not."""


class FrameOrder:
    """Remembers the last frame's time and image.

    period: seconds from one frame to the next; without it (None), or without times, a gap cannot be told.
    Raises `ValueError` for a period that is not positive and finite.
    """

    def __init__(self, period: float | None = None) -> None:
        if period is not None and not (np.isfinite(period) and period > 0):
            raise ValueError(f"period must be a positive number of seconds, or None where unknown; got {period!r}")
        self.period = period
        self._latest: float | None = None
        self._behind: list[float] = []
        self._image: tuple[np.ndarray, ...] = ()

    def look(self, images: tuple[np.ndarray, ...], time: float | None = None) -> Place:
        """Where a frame stands; called once for each that arrives.

        images: of all cameras of the sensor. A frame is repeated where *all* of them are those of the last frame, value
        for value (NaN equals NaN): a real sensor's noise never comes twice. time: seconds, on any clock; None: unknown.
        Raises `ValueError` for a time that is not finite.
        """
        if time is not None and not np.isfinite(time):
            raise ValueError(f"a frame's time must be a finite number of seconds, or None; got {time!r}")
        missed = 0
        if time is not None:
            if self._latest is not None and time <= self._latest and not self._clock_was_set(time):
                return Place("out of order", 0)
            missed = self._missed(time)
            self._latest, self._behind = time, []
        images = tuple(np.array(image) for image in images)  # of its own: a driver may fill the same memory again
        repeated = len(images) == len(self._image) and all(
            np.array_equal(new, old, equal_nan=new.dtype.kind == "f")
            for new, old in zip(images, self._image, strict=True)
        )
        self._image = images
        return Place("repeated" if repeated else "in order", missed)

    def _clock_was_set(self, time: float) -> bool:
        """Whether as many frames as `CLOCK_WAS_SET` came one after the other, all behind the latest."""
        self._behind = [*self._behind, time] if not self._behind or time > self._behind[-1] else [time]
        if len(self._behind) < CLOCK_WAS_SET:
            return False
        self._latest = self._behind[-2]
        return True

    def _missed(self, time: float) -> int:
        if self.period is None or self._latest is None:
            return 0
        return int(min(max(round((time - self._latest) / self.period) - 1, 0), MOST_MISSED))
