"""The epipolar constraint on the sphere, and the feature matches that obey it (paper 2, 2.3).

With both cameras on one vertical axis, both see a point at one azimuth, and the lower camera at a higher elevation:

    z . (x_upper x x_lower) = cos e_u cos e_l sin(a_l - a_u) = 0,   a_l - a_u is not pi,   e_l > e_u
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from course_lib.spherical_stereo.matching.features import PanoramaFeatures
from course_lib.spherical_stereo.panorama import azimuth_difference

# Radians on the sphere by which a match may miss its epipolar half-circle: 3 columns at 1280 (chosen: AKAZE's own noise
# is about one column, and a lower camera turned by half a degree is still let through).
EPIPOLAR_TOLERANCE = 0.015
MIN_RANGE = 0.3  # metres: no surface is nearer to the rig's axis (chosen; the paper's places keep 0.3 m clear)
MAX_HAMMING = 120  # Bits of 486 in which the descriptors of one point may differ (chosen from a real pair).
RATIO = 0.8  # Hamming distance of the best candidate over that of the second best, at most (Lowe's value)

_BIT_COUNT = np.array([byte.bit_count() for byte in range(256)], dtype=np.uint8)


@dataclass(frozen=True, eq=False)
class EpipolarPairs:
    """Pairs of features that the epipolar constraint allows: arrays `(n,)`, one element a pair."""

    upper: np.ndarray  # index into the features
    lower: np.ndarray
    distance: np.ndarray  # Hamming distance of the descriptors, bits
    disparity: np.ndarray  # e_l - e_u, radians, of either sign
    slope: np.ndarray  # tan e_l - tan e_u, which is baseline / horizontal range for a true pair

    def __len__(self) -> int:
        return len(self.upper)

    def where(self, chosen: np.ndarray) -> EpipolarPairs:
        """Return the pairs that a mask or an index array chooses."""
        return EpipolarPairs(*(getattr(self, name)[chosen] for name in self.__dataclass_fields__))


def epipolar_residual(azimuth_upper, elevation_upper, azimuth_lower, elevation_lower) -> np.ndarray:
    """Return asin(max cos e |sin da|), how far two directions miss the epipolar constraint, radians in [0, pi/2]."""
    gap = np.abs(azimuth_difference(azimuth_lower, azimuth_upper))
    cosine = np.maximum(np.cos(elevation_upper), np.cos(elevation_lower))
    return np.arcsin(np.clip(cosine * np.where(gap > np.pi / 2, 1.0, np.sin(gap)), 0.0, 1.0))


def epipolar_pairs(
    upper: PanoramaFeatures,
    lower: PanoramaFeatures,
    tolerance: float = EPIPOLAR_TOLERANCE,
    max_hamming: int = MAX_HAMMING,
) -> EpipolarPairs:
    """Return the pairs within `tolerance` (radians, below pi/2) of the epipolar constraint and `max_hamming` bits."""
    (azimuth_u, elevation_u), (azimuth_l, elevation_l) = upper.angles(), lower.angles()
    rows, columns = _near_in_azimuth(azimuth_u, elevation_u, azimuth_l, tolerance)
    residual = epipolar_residual(azimuth_u[rows], elevation_u[rows], azimuth_l[columns], elevation_l[columns])
    rows, columns = rows[residual <= tolerance], columns[residual <= tolerance]
    different = np.bitwise_xor(upper.descriptors[rows], lower.descriptors[columns])
    distance = _BIT_COUNT[different].sum(axis=-1, dtype=np.int64)
    near = distance <= max_hamming
    rows, columns, distance = rows[near], columns[near], distance[near]
    e_u, e_l = elevation_u[rows], elevation_l[columns]
    return EpipolarPairs(rows, columns, distance, e_l - e_u, np.tan(e_l) - np.tan(e_u))


def _near_in_azimuth(azimuth_u, elevation_u, azimuth_l, tolerance) -> tuple[np.ndarray, np.ndarray]:
    """Return index pairs whose azimuths differ by at most what `tolerance` is at the upper feature's elevation."""
    if len(azimuth_u) == 0 or len(azimuth_l) == 0:
        return np.zeros(0, int), np.zeros(0, int)
    sine = np.sin(tolerance) / np.cos(elevation_u)
    # Within the tolerance of a pole every azimuth is near; the whole circle is half-open, so that nothing comes twice.
    window = np.where(sine < 1, np.arcsin(np.minimum(sine, 1.0)), np.pi)
    order = np.argsort(azimuth_l, kind="stable")
    # One more turn on either side, so that a window across the seam is one stretch of the list.
    circle = np.concatenate([azimuth_l[order] + turn for turn in (-2 * np.pi, 0.0, 2 * np.pi)])
    first = np.searchsorted(circle, azimuth_u - window, side="left")
    count = np.searchsorted(circle, azimuth_u + window, side="left") - first
    rows = np.repeat(np.arange(len(azimuth_u)), count)
    within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return rows, order[(np.repeat(first, count) + within) % len(order)]


def allowed_by_rig(pairs: EpipolarPairs, baseline: float) -> np.ndarray:
    """Return bool `(n,)`: can a pair be one point around the rig, 0 < tan e_l - tan e_u <= baseline / MIN_RANGE?"""
    return (pairs.disparity > 0) & (pairs.slope > 0) & (pairs.slope <= baseline / MIN_RANGE)


def best_pairs(pairs: EpipolarPairs, ratio: float = RATIO) -> EpipolarPairs:
    """Return the one-to-one pairs in which each feature is clearly the other's nearest, the upper one by `ratio`."""
    if len(pairs) == 0:
        return pairs
    best_upper, second_upper = _two_smallest(pairs.upper, pairs.distance)
    best_lower, second_lower = _two_smallest(pairs.lower, pairs.distance)
    d = pairs.distance
    nearest = (d == best_upper) & (d < second_upper) & (d == best_lower) & (d < second_lower)
    return pairs.where(nearest & (d <= ratio * second_upper))


def _two_smallest(group: np.ndarray, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return for each element the smallest and second smallest value in its group (infinity if there is no second)."""
    order = np.lexsort((value, group))
    starts = np.flatnonzero(np.r_[True, group[order][1:] != group[order][:-1]])
    sizes = np.diff(np.r_[starts, len(group)])
    sorted_value = np.r_[value[order].astype(float), np.inf]
    second = np.where(sizes > 1, sorted_value[np.minimum(starts + 1, len(group))], np.inf)
    smallest, runner_up = np.empty(len(group)), np.empty(len(group))
    smallest[order] = np.repeat(sorted_value[starts], sizes)
    runner_up[order] = np.repeat(second, sizes)
    return smallest, runner_up
