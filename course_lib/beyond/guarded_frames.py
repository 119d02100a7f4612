"""Look at a sensor's frame before it is used: is it a new one, and is it an image of the world at all?

`FrameOrder`: is the frame later than the last one, and another image? `FrameCheck`: did enough pixels measure more than
one value, without noise, as in the last good frames? What lasts `PATIENCE` frames is taken as the world.
"""

from collections import deque
from typing import Literal, NamedTuple

import numpy as np

from course_lib.depth_mcl.status import MIN_PIXELS

Fault = Literal[
    "out of order", "repeated", "no return", "saturated", "noise", "half covered", "few returns", "exposure jump"
]

CLOCK_WAS_SET = 3  # frames in a row, behind the latest but ascending, after which the clock was set back (chosen)
MAX_PERIODS = 1e5  # between two frames: microseconds for seconds give a million, nanoseconds a billion (chosen)
MAX_MISSED = 50  # frames that a gap counts as, at most: after a longer one no motion model knows anything (chosen)

# Limits; in brackets the worst of 1,983 undisturbed frames: data/corridor, corridor seeds 10,001 to 10,003 (also with
# calibration errors and by hand; half the pixels each way), and a real Kinect's kitchen.
MAX_OF_ONE_VALUE = 0.5  # share of the returns: a saturated sensor gives one value everywhere (0.05)
MAX_ROUGHNESS = 0.1  # of the distance: independent values differ by about half of it, surfaces by less (0.024)
COVERED_HALF = 0.1  # of a half's usual returns (0.67); the other half must keep half of its own
FEW_RETURNS = 0.4  # of the usual share of returns (0.86)
ROUGHER = 4.0  # times the usual roughness (1.6): noise beyond what another scene explains
MIN_USUAL_ROUGHNESS = 0.005  # a Kinect rounds its depths, so neighbours are often equal
USUAL_FRAMES = 5  # the median of so many good frames is what is usual
PATIENCE = 10  # frames in a row that differ in the same way: then the world has changed
_MIN_HALF = 0.2  # share of returns that a half must usually have before we miss them


class FrameStatus(NamedTuple):
    """The status of a frame before it is used."""

    fault: Fault | None  # None if it is good
    missed: int  # how many frames should have come since the last one in order, and did not


class FrameOrder:
    """Remembers the last frame's time and images. period: seconds from frame to frame, or None: no frame is missed."""

    def __init__(self, period: float | None = None) -> None:
        if period is not None and not (np.isfinite(period) and period > 0):
            raise ValueError(f"period must be a positive number of seconds, or None where unknown; got {period!r}")
        self.period = period
        self._latest: float | None = None
        self._behind: list[float] = []
        self._images: tuple[np.ndarray, ...] = ()

    def look(self, images: tuple[np.ndarray, ...], time: float | None = None) -> FrameStatus:
        """Return a frame's status; called once for each frame that arrives.

        images: of all cameras of the sensor. "repeated": all of them are those of the last frame, value for value.
        time: seconds, on any clock; None if unknown. Raises `ValueError` for a time that is not finite, or more than
        `MAX_PERIODS` after the last one.
        """
        if time is not None and not np.isfinite(time):
            raise ValueError(f"a frame's time must be a finite number of seconds, or None; got {time!r}")
        missed = 0
        if time is not None:
            if self._latest is not None and time <= self._latest and not self._clock_was_set(time):
                return FrameStatus("out of order", 0)
            if self.period is not None and self._latest is not None:
                if time - self._latest > MAX_PERIODS * self.period:
                    raise ValueError(
                        f"a frame came at {time:g}, {(time - self._latest) / self.period:.1g} periods after the last "
                        "one. Seconds are expected: divide nanoseconds by 1e9. After so long a pause initialize again"
                    )
                missed = int(np.clip(round((time - self._latest) / self.period) - 1, 0, MAX_MISSED))
            self._latest, self._behind = time, []
        images = tuple(np.array(image) for image in images)  # a copy, because a driver may fill the same memory again
        repeated = len(images) == len(self._images) and all(
            np.array_equal(new, old, equal_nan=new.dtype.kind == "f")
            for new, old in zip(images, self._images, strict=True)
        )
        self._images = images
        return FrameStatus("repeated" if repeated else None, missed)

    def _clock_was_set(self, time: float) -> bool:
        """Return whether `CLOCK_WAS_SET` frames came one after the other, all behind the latest."""
        self._behind = [*self._behind, time] if not self._behind or time > self._behind[-1] else [time]
        if len(self._behind) < CLOCK_WAS_SET:
            return False
        self._latest = self._behind[-2]
        return True


class Looks(NamedTuple):
    """The looks of a depth image, without a map."""

    share: float  # share of the pixels that measured something
    halves: np.ndarray  # `(4,)` the same of the upper, lower, left and right half
    most_of_one_value: float  # share of the returns that have the commonest value
    roughness: float  # median over neighbours in a row of |difference| / distance; NaN if no two neighbours measured


def looks_of(depth: np.ndarray, near: float, far: float) -> Looks:
    """Return the looks of a depth image `(H, W)` in metres; a value outside near and far is no measurement."""
    depth = np.asarray(depth, dtype=np.float64)
    valid = np.isfinite(depth) & (depth >= near) & (depth <= far)
    height, width = valid.shape
    halves = [valid[: height // 2], valid[height // 2 :], valid[:, : width // 2], valid[:, width // 2 :]]
    returns = depth[valid]
    commonest = np.unique(returns, return_counts=True)[1].max() / returns.size if returns.size else 0.0
    both = valid[:, 1:] & valid[:, :-1]
    steps = np.abs(np.diff(np.where(valid, depth, 0.0), axis=1))[both] / depth[:, 1:][both]
    return Looks(
        float(valid.mean()),
        np.array([half.mean() for half in halves]),
        float(commonest),
        float(np.median(steps)) if steps.size else float("nan"),
    )


class FrameCheck:
    """Looks at every frame of one depth camera, in their order. near, far: metres. period: as in `FrameOrder`."""

    def __init__(self, near: float, far: float, period: float | None = None) -> None:
        self.near, self.far = float(near), float(far)
        self._order = FrameOrder(period)
        self._usual: deque[Looks] = deque(maxlen=USUAL_FRAMES)
        self._changed = 0

    def look(self, depth: np.ndarray, time: float | None = None) -> FrameStatus:
        """Return the status of a depth image `(H, W)` in metres, taken at `time` (seconds; None if unknown)."""
        order = self._order.look((np.asarray(depth),), time)
        if order.fault == "out of order":
            return order
        looks = looks_of(depth, self.near, self.far)
        if looks.share * np.size(depth) < MIN_PIXELS:
            fault = "no return"
        elif looks.most_of_one_value > MAX_OF_ONE_VALUE:
            fault = "saturated"
        else:
            fault = "noise" if looks.roughness > MAX_ROUGHNESS else order.fault
        if fault is None:
            change = self._change(looks)
            self._changed = self._changed + 1 if change else 0
            if self._changed > PATIENCE:
                change, self._changed = None, 0
                self._usual.clear()
            if change is None:
                self._usual.append(looks)
            fault = change
        return FrameStatus(fault, order.missed)

    def _change(self, looks: Looks) -> Fault | None:
        """Return the fault that sets a frame apart from the last good ones."""
        if not self._usual:
            return None
        usual = Looks(*(np.median(values, axis=0) for values in zip(*self._usual, strict=True)))
        left = looks.halves / np.maximum(usual.halves, 1e-9)
        covered = (left < COVERED_HALF) & (usual.halves >= _MIN_HALF) & (left[[1, 0, 3, 2]] >= 0.5)
        if covered.any():
            return "half covered"
        if looks.roughness > ROUGHER * max(usual.roughness, MIN_USUAL_ROUGHNESS):
            return "exposure jump"
        return "few returns" if looks.share < FEW_RETURNS * usual.share else None
