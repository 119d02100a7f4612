"""What the features of two whole panoramas say about each other before any object is known (2.3).

Are the images exchanged, are they of one moment, and is the lower camera turned against the upper one?
"""

from dataclasses import dataclass
from typing import NamedTuple

import cv2
import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE, RATIO, epipolar_residual
from course_lib.spherical_stereo.matching.features import PanoramaFeatures
from course_lib.spherical_stereo.panorama import PanoramaError, azimuth_elevation_of_pixel

MIN_DISPARITY = 0.0025  # radians, half a row at a height of 640: a smaller one does not tell which camera is higher
MAX_TURN = EPIPOLAR_TOLERANCE  # radians: if the lower camera is turned further, true matches miss the tolerance
MAX_FEATURES = 800  # Upper features that are matched, every k-th of all: enough for a hundredth of a degree.
MIN_AGREEING = 30  # Matches that must agree on the turn; fewer may agree by accident.
# Share of all matches that must agree on the turn. Chosen half way on a walk through room 10,021: pairs of one moment
# have 0.86 and more, and 0.36 at most with the lower image of the view before.
MIN_AGREEING_SHARE = 0.6
NEAR_PEAK = 0.1  # Radians about the commonest azimuth difference: the three bins of 4 degrees that make its peak.
# Steps of the reweighted least squares. On twelve pairs of data/room the turn is then within 1e-4 degrees of its limit.
REWEIGHTINGS = 10


class SwappedImagesError(PanoramaError):
    """The image given as the upper one was taken below the other."""


@dataclass(frozen=True, eq=False)
class FeatureMatches:
    """Matches of features over two whole panoramas, one row a match, before the epipolar constraint is applied."""

    keypoints_upper: np.ndarray  # `(n, 2)` edge coordinates, pixels
    keypoints_lower: np.ndarray
    azimuth_difference: np.ndarray  # a_lower - a_upper `(n,)`, radians
    vertical_disparity: np.ndarray  # e_lower - e_upper `(n,)`, radians, positive for a true match
    epipolar: np.ndarray  # bool `(n,)`: which obey the epipolar constraint within `EPIPOLAR_TOLERANCE`

    def __len__(self) -> int:
        return len(self.epipolar)

    @property
    def epipolar_share(self) -> float:
        """Return the share of the matches that obey the epipolar constraint, in [0, 1]; nan without matches."""
        return float(self.epipolar.mean()) if len(self) else float("nan")


def match_features(upper: PanoramaFeatures, lower: PanoramaFeatures, may_be_swapped: bool = False) -> FeatureMatches:
    """Match whole panoramas without the epipolar constraint. Raises `SwappedImagesError` unless `may_be_swapped`."""
    first, second = _mutual_matches(upper.descriptors, lower.descriptors)
    azimuth_u, elevation_u = (angle[first] for angle in upper.angles())
    azimuth_l, elevation_l = (angle[second] for angle in lower.angles())
    disparity = elevation_l - elevation_u
    epipolar = epipolar_residual(azimuth_u, elevation_u, azimuth_l, elevation_l) <= EPIPOLAR_TOLERANCE
    if not may_be_swapped:
        check_not_swapped(disparity[epipolar])
    gap = np.atleast_1d(wrap_angle(azimuth_l - azimuth_u))
    return FeatureMatches(upper.keypoints[first], lower.keypoints[second], gap, disparity, epipolar)


def _mutual_matches(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return index arrays of descriptors that are each other's nearest and pass the ratio test."""
    if len(first) < 2 or len(second) < 2:
        return np.zeros(0, int), np.zeros(0, int)
    matcher = cv2.BFMatcher(cv2.NORM_HAMMING)
    back = np.array([match.trainIdx for match in matcher.match(second, first)])
    kept = [
        (best.queryIdx, best.trainIdx)
        for best, runner_up in matcher.knnMatch(first, second, k=2)
        if best.distance <= RATIO * runner_up.distance and back[best.trainIdx] == best.queryIdx
    ]
    rows, columns = np.array(kept, dtype=int).reshape(-1, 2).T
    return rows, columns


def check_not_swapped(disparity: np.ndarray) -> None:
    """Raise `SwappedImagesError` if negative disparities `(n,)` lead by 3 sqrt(n), three sigmas of a coin."""
    clear = disparity[np.abs(disparity) > MIN_DISPARITY]
    negative = int((clear < 0).sum())
    if 2 * negative - len(clear) > 3 * np.sqrt(len(clear)):
        raise SwappedImagesError(
            f"upper and lower image seem to be swapped: {negative} of {len(clear)} matched features lie lower in the "
            "image given as the lower one, but a camera further down sees them higher. Swap the two images"
        )


class Alignment(NamedTuple):
    """How the features of two images say that the cameras stand to each other."""

    turn: np.ndarray | None  # `(3,)` of the lower camera about x, y, z, radians; None if too few matches agree
    agreeing: float | None  # share of all matches that agree on it; None if there are too few to tell

    @property
    def of_one_moment(self) -> bool:
        """Return False if the matches cannot be those of two cameras at one place."""
        return self.agreeing is None or self.agreeing >= MIN_AGREEING_SHARE

    @property
    def is_upright(self) -> bool:
        """Return False if the lower camera is turned by more than `MAX_TURN`."""
        return self.turn is None or float(np.linalg.norm(self.turn)) <= MAX_TURN


def camera_alignment(upper: PanoramaFeatures, lower: PanoramaFeatures) -> Alignment:
    """Return the turn w of the lower camera against the upper one, and how many matches agree on it.

    a_l - a_u = -w_z + tan e_l (w_x cos a_l + w_y sin a_l)  for small angles w about x, y and z

    Least squares of the matches within `NEAR_PEAK` of the commonest azimuth difference, weighted by Cauchy's function.
    The paper takes the cameras as aligned. A tilt is added to every parallax: at 3 m a degree is a sixth of it.
    """
    every = slice(None, None, max(1, len(upper) // MAX_FEATURES))
    thinned = PanoramaFeatures(upper.keypoints[every], upper.descriptors[every], upper.width, upper.height)
    matches = match_features(thinned, lower, may_be_swapped=True)
    gap = matches.azimuth_difference
    if len(gap) < MIN_AGREEING:
        return Alignment(None, None)
    counts, edges = np.histogram(gap, bins=90, range=(-np.pi, np.pi))
    peak = int(np.argmax(np.roll(counts, 1) + counts + np.roll(counts, -1)))
    middle = (edges[peak] + edges[peak + 1]) / 2
    azimuth, elevation = azimuth_elevation_of_pixel(matches.keypoints_lower, lower.width, lower.height)
    # On the sphere an azimuth difference is as long as the cosine of the elevation.
    sine, cosine = np.sin(elevation), np.cos(elevation)
    rows = np.column_stack([sine * np.cos(azimuth), sine * np.sin(azimuth), -cosine])
    beyond = cosine * wrap_angle(gap - middle)
    near = np.abs(beyond) < NEAR_PEAK
    if near.sum() < MIN_AGREEING:
        return Alignment(None, float(near.mean()))
    rows, beyond, turn = rows[near], beyond[near], np.zeros(3)
    for _ in range(REWEIGHTINGS):
        residual = beyond - rows @ turn
        scale = max(1.4826 * float(np.median(np.abs(residual))), 1e-4)
        weight = 1 / (1 + (residual / scale) ** 2)
        turn = np.linalg.lstsq(np.sqrt(weight)[:, None] * rows, np.sqrt(weight) * beyond, rcond=None)[0]
    agreeing = int((np.abs(beyond - rows @ turn) < EPIPOLAR_TOLERANCE).sum())
    share = agreeing / len(gap)
    if agreeing < MIN_AGREEING:
        return Alignment(None, share)
    return Alignment(np.array([turn[0], turn[1], wrap_angle(turn[2] - middle)]), share)
