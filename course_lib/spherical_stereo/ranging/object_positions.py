"""Where matched objects are (paper 2, section 2.4): X = d x_hat, with d from the box centres, as in the paper, or from
the vertical disparity of the matched features.

The parallax of two box centres is rough. The features that paired the boxes are true points of the visible surface,
matched to about a pixel. Some belong to something in front or behind, so the median of their inverse ranges is taken.
The map's centroid lies behind that surface by about half the object's depth, which is not added here.
"""

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from course_lib.spherical_stereo import panorama
from course_lib.spherical_stereo.detection.detected_object import DetectionError, box_centre, canonical_label
from course_lib.spherical_stereo.outcomes import ObjectOutcome
from course_lib.spherical_stereo.panorama import StereoRig, View, direction_from_angles, pixel_to_direction
from course_lib.spherical_stereo.ranging import triangulation
from course_lib.spherical_stereo.ranging.triangulation import triangulate

Distance = Literal["box_centre", "disparity"]
DISTANCES: tuple[Distance, ...] = ("box_centre", "disparity")
MIN_MATCHES = 3  # With fewer matches a median says nothing about its own spread.
_NORMAL_OVER_MAD = 1.4826  # standard deviation of a normal distribution over its median absolute deviation
_MEDIAN_OVER_MEAN = 1.2533  # standard deviation of the median over that of the mean, of normal numbers: sqrt(pi / 2)


class Noise(NamedTuple):
    """What makes a position uncertain, as standard deviations, all chosen."""

    box_centre: float = 0.0075  # radians, of a box centre's azimuth and elevation: 1.5 pixels at a width of 1280
    centroid: float = 0.1  # metres, of the object's centroid about the point that its box's centre shows
    surface: float = 0.15  # metres, from the centroid to the surface with the features: a quarter of a sofa's depth


class ObjectPosition(NamedTuple):
    """Position of one object, body frame with the origin at the upper camera. NaN unless the outcome is "ok"."""

    outcome: ObjectOutcome
    position: np.ndarray = np.full(3, np.nan)  # X `(3,)`, metres
    covariance: np.ndarray = np.full((2, 2), np.nan)  # of its horizontal part, square metres

    @property
    def horizontal_range_m(self) -> float:
        """Return d cos e, from the rig's axis."""
        return float(np.hypot(*self.position[:2]))

    @property
    def horizontal_sigma_m(self) -> float:
        """Return one standard deviation of the horizontal range: sqrt(h' C h), h the unit vector to the object."""
        towards = self.position[:2] / self.horizontal_range_m
        return float(np.sqrt(towards @ self.covariance @ towards))


class DisparityDistance(NamedTuple):
    """Horizontal range of one object from its matched features. NaN unless the outcome is "ok"."""

    outcome: ObjectOutcome  # OK, TOO_FEW_DISPARITIES or PARALLEL
    horizontal_range: float = float("nan")  # metres from the rig's axis, the median over the matches
    sigma: float = float("nan")  # metres, standard deviation of the median


class MeasuredObject(NamedTuple):
    """A matched object with both its distances."""

    upper: int
    lower: int
    label: str
    n_matches: int
    azimuth_deg: float
    box_centre: ObjectPosition
    disparity: ObjectPosition


def max_range(baseline: float, sigma: float = Noise().box_centre) -> float:
    """Return the horizontal range (m) at which the parallax is its own sigma: baseline / (sqrt(2) sigma), radians."""
    return baseline / (2**0.5 * sigma)


def disparity_distance(match, width: int, height: int, baseline: float) -> DisparityDistance:
    """Return the horizontal range of a matched object from the vertical disparities of its features, robustly.

    rho = baseline / median(tan e_l - tan e_u): noise of pixels moves the slopes evenly to both sides, the ranges not.
    """
    _, upper = panorama.azimuth_elevation_of_pixel(match.keypoints_upper, width, height)
    _, lower = panorama.azimuth_elevation_of_pixel(match.keypoints_lower, width, height)
    slope = np.tan(lower) - np.tan(upper)
    if len(slope) < MIN_MATCHES:
        return DisparityDistance(ObjectOutcome.TOO_FEW_DISPARITIES)
    middle = float(np.median(slope))
    if middle <= triangulation.PARALLEL_TOLERANCE:
        return DisparityDistance(ObjectOutcome.PARALLEL)
    deviation = _NORMAL_OVER_MAD * float(np.median(np.abs(slope - middle)))
    # d rho = rho^2 / baseline d slope, as in the covariance of the triangulation.
    spread = baseline / middle**2 * deviation
    return DisparityDistance(ObjectOutcome.OK, baseline / middle, _MEDIAN_OVER_MEAN * spread / len(slope) ** 0.5)


def position_objects(
    matches: Sequence,
    pairs: Sequence[tuple[int, int]],
    upper: View,
    lower: View,
    rig: StereoRig,
    distance: Distance = "box_centre",
    noise: Noise = Noise(),  # noqa: B008 (it cannot change)
    furthest: float = np.inf,
) -> list[ObjectPosition]:
    """Return X = d x_hat of every match, x_hat the direction of the box centre in the upper image.

    pairs: indices (upper, lower) of the matches' detections. furthest: metres, horizontal, before "too far".
    """
    if not pairs:
        return []
    from_upper = pixel_to_direction(box_centre([upper.detections[i].box for i, _ in pairs]), *upper.size)
    if distance == "disparity":
        found = [
            _from_features(match, direction, rig.baseline, upper.size, noise)
            for match, direction in zip(matches, from_upper, strict=True)
        ]
    else:
        from_lower = pixel_to_direction(box_centre([lower.detections[j].box for _, j in pairs]), *lower.size)
        found = _from_box_centres(from_upper, from_lower, rig.baseline, noise)
    return [ObjectPosition(ObjectOutcome.TOO_FAR) if one.horizontal_range_m > furthest else one for one in found]


def measure_objects(
    matches: Sequence, upper: View, lower: View, rig: StereoRig, sigma_pixels: float = 1.0
) -> list[MeasuredObject]:
    """Return every matched object with both its distances, in the order of the upper detections."""
    matches = sorted(matches, key=lambda m: m.upper)
    pairs = [(match.upper, match.lower) for match in matches]
    noise = Noise(2 * np.pi / upper.width * sigma_pixels, 0.0, 0.0)
    by_boxes, by_features = (position_objects(matches, pairs, upper, lower, rig, way, noise) for way in DISTANCES)
    centres = box_centre(np.array([upper.detections[i].box for i, _ in pairs]).reshape(-1, 4))
    azimuths = np.degrees(panorama.azimuth_elevation_of_pixel(centres, *upper.size)[0]).tolist()
    return [
        MeasuredObject(m.upper, m.lower, canonical_label(m.label), m.n_matches, *found)
        for m, *found in zip(matches, azimuths, by_boxes, by_features, strict=True)
    ]


def _from_box_centres(from_upper, from_lower, baseline: float, noise: Noise) -> list[ObjectPosition]:
    """Return the positions of directions `(n, 3)`, all that have one at once."""
    outcomes = triangulation.triangulation_outcome(from_upper, from_lower)
    found = [ObjectPosition(ObjectOutcome(outcome)) for outcome in outcomes]
    ok = np.flatnonzero(outcomes == ObjectOutcome.OK)
    directions = from_upper[ok], from_lower[ok]
    positions = triangulate(*directions, baseline)[:, None] * directions[0]
    sigmas = noise.box_centre, noise.box_centre
    of_angles = triangulation.triangulation_covariance(*directions, baseline, *sigmas)
    for i, position, covariance in zip(ok, positions, of_angles, strict=True):
        found[i] = ObjectPosition(ObjectOutcome.OK, position, covariance[:2, :2] + noise.centroid**2 * np.eye(2))
    return found


def _from_features(match, from_upper: np.ndarray, baseline: float, size, noise: Noise) -> ObjectPosition:
    """Return X = rho (cos a, sin a, tan e) in the direction of the box centre, upper camera."""
    if not hasattr(match, "keypoints_upper"):
        raise DetectionError('distance="disparity" needs ObjectMatch with its features, not a pair of indices')
    measured = disparity_distance(match, *size, baseline)
    if measured.outcome != ObjectOutcome.OK:
        return ObjectPosition(measured.outcome)
    azimuth, elevation = panorama.azimuth_elevation(from_upper)
    along = direction_from_angles(azimuth, 0.0)[:2]
    across = np.array([-along[1], along[0]])
    variance_along = measured.sigma**2 + noise.surface**2
    variance_across = (measured.horizontal_range * noise.box_centre) ** 2 + noise.centroid**2
    covariance = variance_along * np.outer(along, along) + variance_across * np.outer(across, across)
    position = measured.horizontal_range / np.cos(elevation)[..., None] * direction_from_angles(azimuth, elevation)
    return ObjectPosition(ObjectOutcome.OK, position, covariance)
