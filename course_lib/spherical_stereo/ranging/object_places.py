"""Where matched objects are: X = d x_hat with d from the box centres, the paper's way, or from the features inside.

The sections before give the pieces (2.3: matched features, 2.4: triangulation); here each match gets an outcome, a
place and a covariance.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.detection.boxes import box_centre
from course_lib.spherical_stereo.detection.localizer_input import LocalizerError
from course_lib.spherical_stereo.panorama import StereoRig, azimuth_elevation, pixel_to_direction
from course_lib.spherical_stereo.ranging.triangulation import (
    OK,
    triangulate,
    triangulation_covariance,
    triangulation_outcome,
)
from course_lib.spherical_stereo.ranging.vertical_disparity import disparity_distance

DISTANCES = ("box_centre", "disparity")
BOX_CENTRE_SIGMA = 0.0075
"""Radians, standard deviation of a box centre's azimuth and elevation (chosen: 1.5 pixels at a width of 1280)."""
CENTROID_SIGMA = 0.1
"""Metres, standard deviation in each direction of the object's centroid about the point that its box's centre shows: a
box is of the visible side (chosen). Without it, objects close by would seem certain to a centimetre."""
SURFACE_SIGMA = 0.15
"""Metres, how far an object's centroid is from the surface that its features lie on, as a standard deviation (chosen:
about a quarter of a sofa's depth). It is added to what the disparities say, which know nothing of the inside."""


class Place(NamedTuple):
    """Place of one object, body frame with the origin at the upper camera."""

    outcome: str
    """ "ok", "parallel", "diverging", "azimuth gap" or "too few matches"."""
    position: np.ndarray
    """X `(3,)`, metres; NaN unless the outcome is "ok"."""
    covariance: np.ndarray
    """`(2, 2)` of its horizontal part, square metres; NaN unless the outcome is "ok"."""


def place_objects(
    matches: Sequence,
    pairs: Sequence[tuple[int, int]],
    upper_detections: Sequence,
    lower_detections: Sequence,
    rig: StereoRig,
    distance: str,
    width: int,
    height: int,
) -> list[Place]:
    """The place of every match: X = d x_hat, x_hat the direction of the box centre in the upper image.

    pairs: indices (upper, lower) of the matches' detections. distance: "box_centre", d from both box centres, or
    "disparity", d from the matched features, for which the matches must carry them (else `LocalizerError`).
    width, height: of the panoramas, pixels. Source: paper 2, section 2.4.
    """
    if not pairs:
        return []
    upper_centres = box_centre([upper_detections[i].box for i, _ in pairs])
    from_upper = pixel_to_direction(upper_centres, width, height)
    if distance == "disparity":
        return [
            _from_features(match, direction, rig.baseline, width, height)
            for match, direction in zip(matches, from_upper, strict=True)
        ]
    from_lower = pixel_to_direction(box_centre([lower_detections[j].box for _, j in pairs]), width, height)
    return _from_box_centres(from_upper, from_lower, rig.baseline)


def _from_box_centres(from_upper: np.ndarray, from_lower: np.ndarray, baseline: float) -> list[Place]:
    """Places of directions `(n, 3)`, all that have one at once."""
    outcomes = triangulation_outcome(from_upper, from_lower)
    positions, covariances = np.full((len(outcomes), 3), np.nan), np.full((len(outcomes), 2, 2), np.nan)
    ok = outcomes == OK
    directions = from_upper[ok], from_lower[ok]
    positions[ok] = triangulate(*directions, baseline)[:, None] * directions[0]
    noise = triangulation_covariance(*directions, baseline, BOX_CENTRE_SIGMA, BOX_CENTRE_SIGMA)
    covariances[ok] = noise[:, :2, :2] + CENTROID_SIGMA**2 * np.eye(2)
    return [Place(str(outcome), *place) for outcome, *place in zip(outcomes, positions, covariances, strict=True)]


def _from_features(match, from_upper: np.ndarray, baseline: float, width: int, height: int) -> Place:
    if not hasattr(match, "keypoints_upper"):
        raise LocalizerError('distance="disparity" needs ObjectMatch with its features, not a pair of indices')
    measured = disparity_distance(match, width, height, baseline)
    if measured.outcome != OK:
        return _nowhere(measured.outcome)
    azimuth, _ = azimuth_elevation(from_upper)
    along = np.array([np.cos(azimuth), np.sin(azimuth)])
    across = np.array([-along[1], along[0]])
    variance_along = measured.sigma**2 + SURFACE_SIGMA**2
    variance_across = (measured.horizontal_range * BOX_CENTRE_SIGMA) ** 2 + CENTROID_SIGMA**2
    covariance = variance_along * np.outer(along, along) + variance_across * np.outer(across, across)
    return Place(OK, measured.position(from_upper), covariance)


def _nowhere(outcome: str) -> Place:
    return Place(outcome, np.full(3, np.nan), np.full((2, 2), np.nan))
