"""A look at a depth frame before it is used: is it a new one, and is it an image of the world at all?

A particle filter believes every pixel that it is given. A repeated image pulls it back to where the camera was; one
of a single distance, or of noise, pulls it anywhere. So each frame is asked first, by what needs no map:

    time and image    it must be later than the last frame and another image (frame_order.py)
    returns           enough pixels must have measured something
    values            not most of them one value, and not noise: neighbouring pixels mostly see one surface
    change            against the last good frames: the share of returns, of each half too, and the roughness

A change may be the world's: somebody steps before the camera, it turns to a far wall. What lasts longer than
`PATIENCE` frames is taken as the world.
"""

from __future__ import annotations

from collections import deque
from typing import Literal, NamedTuple

import numpy as np

from course_lib.beyond.frame_order import FrameOrder

Fault = Literal[
    "out of order", "repeated", "no return", "saturated", "noise", "half covered", "few returns", "exposure jump"
]

# Limits, each with its reason; in brackets the worst of 1,983 undisturbed development frames: data/corridor, corridor
# seeds 10,001 to 10,003 (wagon, less kind, and by hand; half the pixels each way), and a real Kinect's kitchen.
LEAST_PIXELS = 30  # with fewer a frame says nothing (tracking.py has the same)
MOST_OF_ONE_VALUE = 0.5  # share of the returns: a sensor at its stop gives one value (0.05)
GREATEST_ROUGHNESS = 0.1  # of the distance: independent values differ by about half of it, surfaces by less (0.024)
COVERED_HALF = 0.1  # of a half's usual returns (0.67); the other half must keep half of its own
FEW_RETURNS = 0.4  # of the usual share of returns (0.86)
ROUGHER = 4.0  # times the usual roughness (1.6): noise beyond what another scene explains
LEAST_ROUGHNESS = 0.005  # taken for usual where it is less: a Kinect rounds its depths, and neighbours are often equal
USUAL_FRAMES = 5  # good frames whose median is what is usual
PATIENCE = 10  # frames in a row that differ in the same way: then it is the world that has changed
_LEAST_HALF = 0.2  # share of returns that a half must usually have, to be missed


class Looks(NamedTuple):
    """What a depth image looks like, without a map."""

    share: float
    """Of the pixels that measured something, 0 to 1."""
    halves: np.ndarray
    """`(4,)` the same of the upper, lower, left and right half."""
    most_of_one_value: float
    """Share of the returns that have the commonest value, 0 to 1."""
    roughness: float
    """Median over neighbours in a row of |difference| / distance; NaN without two neighbours that measured."""


class Seen(NamedTuple):
    """What a frame is."""

    fault: Fault | None
    """None: it is good."""
    missed: int
    """How many frames should have come before it, and did not."""


def looks_of(depth: np.ndarray, near: float, far: float) -> Looks:
    """What a depth image `(H, W)` in metres looks like; what is not between near and far is no measurement."""
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
    """Looks at every frame of one depth camera, in the order in which they arrive.

    near, far: what the camera can measure, metres. period: seconds from frame to frame; None: gaps are not told.
    """

    def __init__(self, near: float, far: float, period: float | None = None) -> None:
        self.near, self.far = float(near), float(far)
        self._order = FrameOrder(period)
        self._usual: deque[Looks] = deque(maxlen=USUAL_FRAMES)
        self._changed = 0

    def look(self, depth: np.ndarray, time: float | None = None) -> Seen:
        """What is wrong with a depth image `(H, W)` in metres, if anything, and how many frames are missing before it.

        time: seconds; None: unknown. Raises `ValueError` for a time that is not finite.
        """
        place = self._order.look((np.asarray(depth),), time)
        if place.order == "out of order":
            return Seen("out of order", place.missed)
        looks = looks_of(depth, self.near, self.far)
        fault = alone_wrong(looks, np.size(depth))
        if fault is None and place.order == "repeated":
            fault = "repeated"
        if fault is not None:
            return Seen(fault, place.missed)
        change = self._change(looks)
        self._changed = self._changed + 1 if change else 0
        if change and self._changed <= PATIENCE:
            return Seen(change, place.missed)
        if change:
            self._usual.clear()
            self._changed = 0
        self._usual.append(looks)
        return Seen(None, place.missed)

    def _change(self, looks: Looks) -> Fault | None:
        """What sets a frame apart from the last good ones."""
        if not self._usual:
            return None
        share = np.median([one.share for one in self._usual])
        halves = np.median([one.halves for one in self._usual], axis=0)
        roughness = np.median([one.roughness for one in self._usual])  # NaN, where one has none, tells nothing
        left = looks.halves / np.maximum(halves, 1e-9)
        covered = (left < COVERED_HALF) & (halves >= _LEAST_HALF) & (left[[1, 0, 3, 2]] >= 0.5)
        if covered.any():
            return "half covered"
        if looks.roughness > ROUGHER * max(roughness, LEAST_ROUGHNESS):
            return "exposure jump"
        return "few returns" if looks.share < FEW_RETURNS * share else None


def alone_wrong(looks: Looks, pixels: int) -> Fault | None:
    """What is wrong with a frame whatever came before: no return, saturated, or noise; None: nothing.

    pixels: of the image.
    """
    if looks.share * pixels < LEAST_PIXELS:
        return "no return"
    if looks.most_of_one_value > MOST_OF_ONE_VALUE:
        return "saturated"
    return "noise" if looks.roughness > GREATEST_ROUGHNESS else None
