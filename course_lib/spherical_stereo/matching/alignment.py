"""How the lower camera is turned against the upper one, told by the features of the two images (paper 2, 2.3).

A lower camera turned by small angles w = (w_x, w_y, w_z) about x, y and z sees a point at another azimuth:

    a_l - a_u = -w_z + tan e_l (w_x cos a_l + w_y sin a_l)

A tilt is added to every parallax: at 3 m a degree is a sixth of it. A turned rig is refused here, not corrected.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.matching.epipolar import EPIPOLAR_TOLERANCE
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, nearest_features
from course_lib.spherical_stereo.panorama import azimuth_elevation_of_pixel

MAX_TURN = EPIPOLAR_TOLERANCE  # radians: if the lower camera is turned further, true matches miss the tolerance
MAX_FEATURES = 800  # Upper features that are matched, every k-th of all: enough for a hundredth of a degree.
MIN_AGREEING = 30  # Matches that must agree on the turn; fewer tell nothing.
# Share of all matches that must agree on the turn. Chosen half way on a walk through room 10,021: pairs of one moment
# have 0.86 and more, and 0.36 at most with the lower image of the view before.
MIN_AGREEING_SHARE = 0.6
_NEAR, _STEPS = 0.1, 10


class Alignment(NamedTuple):
    """What the features of two images say of how the cameras stand to each other."""

    turn: np.ndarray | None  # `(3,)` of the lower camera about x, y, z, radians; None if too few matches agree
    agreeing: float | None  # share of all matches that agree on it; None if there are too few to tell

    @property
    def of_one_moment(self) -> bool:
        """False if the matches cannot be those of two cameras at one place."""
        return self.agreeing is None or self.agreeing >= MIN_AGREEING_SHARE

    @property
    def is_upright(self) -> bool:
        """False if the lower camera is turned by more than `MAX_TURN`."""
        return self.turn is None or float(np.linalg.norm(self.turn)) <= MAX_TURN


def camera_alignment(upper: PanoramaFeatures, lower: PanoramaFeatures) -> Alignment:
    """Return the turn w of the lower camera against the upper one, and how many matches agree on it.

    Least squares of the matches within 0.1 radian of the commonest azimuth difference, weighted by Cauchy's function.
    Beyond the paper, which takes the cameras as aligned.
    """
    every = slice(None, None, max(1, len(upper) // MAX_FEATURES))
    thinned = PanoramaFeatures(upper.keypoints[every], upper.descriptors[every], upper.width, upper.height)
    matches = nearest_features(thinned, lower, EPIPOLAR_TOLERANCE)
    gap = matches.azimuth_difference
    if len(gap) < MIN_AGREEING:
        return Alignment(None, None)
    counts, edges = np.histogram(gap, bins=90, range=(-np.pi, np.pi))
    peak = int(np.argmax(np.roll(counts, 1) + counts + np.roll(counts, -1)))
    middle = (edges[peak] + edges[peak + 1]) / 2
    azimuth, elevation = azimuth_elevation_of_pixel(matches.keypoints_lower, lower.width, lower.height)
    # On the sphere an azimuth difference is as long as the cosine of the elevation.
    rows = np.column_stack(
        [np.sin(elevation) * np.cos(azimuth), np.sin(elevation) * np.sin(azimuth), -np.cos(elevation)]
    )
    beyond = np.cos(elevation) * wrap_angle(gap - middle)
    near = np.abs(beyond) < _NEAR
    if near.sum() < MIN_AGREEING:
        return Alignment(None, float(near.mean()))
    rows, beyond, turn = rows[near], beyond[near], np.zeros(3)
    for _ in range(_STEPS):
        residual = beyond - rows @ turn
        scale = max(1.4826 * float(np.median(np.abs(residual))), 1e-4)
        weight = 1 / (1 + (residual / scale) ** 2)
        turn = np.linalg.lstsq(np.sqrt(weight)[:, None] * rows, np.sqrt(weight) * beyond, rcond=None)[0]
    agreeing = int((np.abs(beyond - rows @ turn) < EPIPOLAR_TOLERANCE).sum())
    share = agreeing / len(gap)
    if agreeing < MIN_AGREEING:
        return Alignment(None, share)
    return Alignment(np.array([turn[0], turn[1], wrap_angle(turn[2] - middle)]), share)
