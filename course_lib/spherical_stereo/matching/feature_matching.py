"""Matching whole panoramas: what the pair of images says about itself before any object is known (paper 2, 2.3)."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE, epipolar_residual
from course_lib.spherical_stereo.matching.features import PanoramaFeatures
from course_lib.spherical_stereo.panorama import PanoramaError, azimuth_difference

# Hamming distance of the best candidate over that of the second best, at most (Lowe's value for distances).
RATIO = 0.8
# Disparities below this, radians, say nothing about which camera is higher (half a row at a height of 640).
SMALLEST_DISPARITY = 0.0025


class SwappedImagesError(PanoramaError):
    """The image given as the upper one was taken below the other."""


@dataclass(frozen=True, eq=False)
class FeatureMatches:
    """Matches of features over two whole panoramas; one row a match, before the epipolar constraint is applied.

    keypoints_upper, keypoints_lower: `(n, 2)` edge coordinates, pixels. azimuth_difference: a_lower - a_upper `(n,)`,
    radians. vertical_disparity: e_lower - e_upper `(n,)`, radians, positive for a true match. epipolar: bool `(n,)`,
    which matches obey the epipolar constraint within `tolerance` radians on the sphere.
    """

    keypoints_upper: np.ndarray
    keypoints_lower: np.ndarray
    azimuth_difference: np.ndarray
    vertical_disparity: np.ndarray
    epipolar: np.ndarray
    tolerance: float

    def __len__(self) -> int:
        return len(self.epipolar)

    @property
    def epipolar_share(self) -> float:
        """Share of the matches that obey the epipolar constraint, in [0, 1]; nan without matches."""
        return float(self.epipolar.mean()) if len(self) else float("nan")


def match_features(
    upper: PanoramaFeatures, lower: PanoramaFeatures, tolerance: float = EPIPOLAR_TOLERANCE
) -> FeatureMatches:
    """Matches of the features of two whole panoramas, found without the epipolar constraint and then tested by it.

    Nearest neighbour in Hamming distance, mutual and with the ratio test (`RATIO`). As the constraint has no part in
    the search, the share that obeys it tells how well the images are aligned.
    Raises `SwappedImagesError`, and `PanoramaError` for unlike sizes. Source: paper 2, section 2.3.
    """
    if (upper.width, upper.height) != (lower.width, lower.height):
        raise PanoramaError(
            f"the two images must have one size; got {upper.width} x {upper.height} (upper) and "
            f"{lower.width} x {lower.height} (lower)"
        )
    matches = nearest_features(upper, lower, tolerance)
    check_not_swapped(matches.vertical_disparity[matches.epipolar])
    return matches


def nearest_features(upper: PanoramaFeatures, lower: PanoramaFeatures, tolerance: float) -> FeatureMatches:
    """`match_features` of images that may well be swapped, or turned against each other."""
    first, second = _mutual_matches(upper.descriptors, lower.descriptors)
    (azimuth_u, elevation_u), (azimuth_l, elevation_l) = (
        (angles[0][chosen], angles[1][chosen]) for angles, chosen in ((upper.angles(), first), (lower.angles(), second))
    )
    return FeatureMatches(
        upper.keypoints[first],
        lower.keypoints[second],
        np.atleast_1d(azimuth_difference(azimuth_l, azimuth_u)),
        elevation_l - elevation_u,
        epipolar_residual(azimuth_u, elevation_u, azimuth_l, elevation_l) <= tolerance,
        tolerance,
    )


def _mutual_matches(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Index arrays of descriptors that are each other's nearest, and pass the ratio test."""
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
    """Raises `SwappedImagesError` when vertical disparities (radians, `(n,)`) say that upper and lower are swapped.

    For a true pair they are positive; unrelated images give either sign like a coin. The images count as swapped when
    negative signs lead by more than 3 sqrt(n), three standard deviations of a coin. Disparities below
    `SMALLEST_DISPARITY` (far things, one image given twice) do not count. Source: paper 2, section 2.3.
    """
    told = disparity[np.abs(disparity) > SMALLEST_DISPARITY]
    negative = int((told < 0).sum())
    if 2 * negative - len(told) > 3 * np.sqrt(len(told)):
        raise SwappedImagesError(
            f"upper and lower image seem to be swapped: {negative} of {len(told)} matched features lie lower in the "
            "image given as the lower one, but a camera further down sees them higher. Swap the two images"
        )
