"""A second distance of an object, from the vertical disparity of its matched features (paper 2, 2.3 and 2.4).

The parallax of two box centres is rough. The features that paired the boxes are true points of the visible surface,
matched to about a pixel. Some belong to something in front or behind, so the median of their inverse ranges is taken.
The map's centroid lies behind that surface by about half the object's depth, which is not added here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from course_lib.spherical_stereo.panorama import (
    PanoramaError,
    StereoRig,
    azimuth_elevation,
    azimuth_elevation_of_pixel,
    direction_from_angles,
)
from course_lib.spherical_stereo.ranging.triangulation import OK, PARALLEL, PARALLEL_TOLERANCE

TOO_FEW_MATCHES = "too few matches"
MIN_MATCHES = 3  # With fewer matches a median says nothing about its own spread.
# Standard deviation of a normal distribution over its median absolute deviation.
_NORMAL_OVER_MAD = 1.4826
# Standard deviation of the median over that of the mean, of normally distributed numbers: sqrt(pi / 2).
_MEDIAN_OVER_MEAN = 1.2533


@dataclass(frozen=True)
class DisparityDistance:
    """Horizontal range of one object from its matched features."""

    outcome: str  # "ok", "too few matches", or "parallel"; the numbers are nan unless it is "ok"
    horizontal_range: float  # metres from the rig's axis, the median over the matches
    spread: float  # metres, robust standard deviation of single matches' ranges, the object's depth included
    sigma: float  # metres, standard deviation of the median
    n_matches: int

    def position(self, direction_upper: np.ndarray) -> np.ndarray:
        """Return X = rho (cos a, sin a, tan e) `(3,)` in the direction of the box centre, upper camera, metres."""
        azimuth, elevation = azimuth_elevation(direction_upper)
        return self.horizontal_range / np.cos(elevation)[..., None] * direction_from_angles(azimuth, elevation)


def horizontal_ranges(
    keypoints_upper: np.ndarray, keypoints_lower: np.ndarray, width: int, height: int, baseline: float
) -> np.ndarray:
    """Return horizontal ranges `(k,)` in metres of matched features `(k, 2)`: rho = baseline / (tan e_l - tan e_u).

    A match whose disparity is not positive gives infinity. Source: paper 2, section 2.4.
    """
    slope = _slopes(keypoints_upper, keypoints_lower, width, height)
    return np.where(slope > 0, StereoRig(baseline).baseline / np.where(slope > 0, slope, 1.0), np.inf)


def disparity_distance(match, width: int, height: int, baseline: float) -> DisparityDistance:
    """Return the horizontal range of a matched object from the vertical disparities of its features, robustly.

    rho = baseline / median(tan e_l - tan e_u): noise of pixels moves the slopes evenly to both sides, the ranges not.
    Source: paper 2, section 2.4.
    """
    baseline = StereoRig(baseline).baseline
    slope = _slopes(match.keypoints_upper, match.keypoints_lower, width, height)
    nothing = (float("nan"),) * 3
    if len(slope) < MIN_MATCHES:
        return DisparityDistance(TOO_FEW_MATCHES, *nothing, len(slope))
    middle = float(np.median(slope))
    if middle <= PARALLEL_TOLERANCE:
        return DisparityDistance(PARALLEL, *nothing, len(slope))
    deviation = _NORMAL_OVER_MAD * float(np.median(np.abs(slope - middle)))
    # d rho = rho^2 / baseline d slope, as in the covariance of the triangulation.
    spread = baseline / middle**2 * deviation
    return DisparityDistance(OK, baseline / middle, spread, _MEDIAN_OVER_MEAN * spread / len(slope) ** 0.5, len(slope))


def _slopes(keypoints_upper, keypoints_lower, width, height) -> np.ndarray:
    """tan e_l - tan e_u `(k,)` of matched features."""
    keypoints_upper, keypoints_lower = np.asarray(keypoints_upper), np.asarray(keypoints_lower)
    if keypoints_upper.shape != keypoints_lower.shape or keypoints_upper.ndim != 2:
        raise PanoramaError(
            f"matched keypoints must be two arrays (k, 2) of one length; got {keypoints_upper.shape} and "
            f"{keypoints_lower.shape}"
        )
    _, upper = azimuth_elevation_of_pixel(keypoints_upper, width, height)
    _, lower = azimuth_elevation_of_pixel(keypoints_lower, width, height)
    return np.tan(lower) - np.tan(upper)
