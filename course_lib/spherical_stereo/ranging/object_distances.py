"""Both distances of every matched object, side by side, with what pixel noise makes of them (paper 2, 2.4)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from course_lib.spherical_stereo.detection.boxes import box_centre
from course_lib.spherical_stereo.matching.object_matching import ObjectMatch
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, azimuth_elevation, pixel_to_direction
from course_lib.spherical_stereo.ranging.triangulation import (
    OK,
    object_position,
    triangulation_covariance,
    triangulation_outcome,
)
from course_lib.spherical_stereo.ranging.vertical_disparity import disparity_distance


@dataclass(frozen=True)
class Measurement:
    """One distance and its name: outcome is "ok" or why there is none (then the numbers are nan).

    distance_m: d along the upper camera's direction of the box centre. horizontal_range_m: d cos e, from the rig's
    axis. horizontal_sigma_m: one standard deviation of it.
    """

    outcome: str
    distance_m: float
    horizontal_range_m: float
    horizontal_sigma_m: float


@dataclass(frozen=True)
class MeasuredObject:
    """A matched object: indices of its detections, class, matched features, azimuth, and its distance in both ways."""

    upper: int
    lower: int
    label: str
    n_matches: int
    azimuth_deg: float
    box_centre: Measurement
    disparity: Measurement


def measure_objects(
    matches: Sequence[ObjectMatch],
    upper_detections: Sequence,
    lower_detections: Sequence,
    size: tuple[int, int],
    rig: StereoRig,
    sigma_pixels: float = 1.0,
) -> list[MeasuredObject]:
    """Every matched object with both its distances, in the order of the upper detections.

    size: (width, height) of the panoramas, pixels. sigma_pixels: standard deviation of a box centre's u and v, pixels;
    of the disparities, the spread of the features themselves tells. Raises `PanoramaError` for boxes outside the image
    or a sigma that is negative. Source: paper 2, section 2.4.
    """
    measured = []
    for match in sorted(matches, key=lambda m: m.upper):
        boxes = [np.asarray(d.box) for d in (upper_detections[match.upper], lower_detections[match.lower])]
        upper, lower = (pixel_to_direction(box_centre(box), *size) for box in boxes)
        measured.append(
            MeasuredObject(
                match.upper,
                match.lower,
                match.label,
                match.n_matches,
                float(np.degrees(azimuth_elevation(upper)[0])),
                measure_box_centres(upper, lower, size, rig, sigma_pixels),
                _from_disparities(match, upper, size, rig),
            )
        )
    return measured


def measure_box_centres(
    direction_upper: np.ndarray, direction_lower: np.ndarray, size: tuple[int, int], rig: StereoRig, sigma_pixels: float
) -> Measurement:
    """The paper's distance, from two directions `(3,)` of box centres, with sigma propagated from pixels.

    sigma_rho^2 = h' C h, with C of `triangulation_covariance` and h the horizontal unit vector towards the object.
    Raises `PanoramaError` for directions that are none or a sigma that is negative. Source: paper 2, section 2.4.
    """
    if not sigma_pixels >= 0:
        raise PanoramaError(f"sigma_pixels must not be negative; got {sigma_pixels!r}")
    outcome = str(triangulation_outcome(direction_upper, direction_lower))
    if outcome != OK:
        return Measurement(outcome, float("nan"), float("nan"), float("nan"))
    position = object_position(direction_upper, direction_lower, rig.baseline)
    covariance = triangulation_covariance(
        direction_upper,
        direction_lower,
        rig.baseline,
        2 * np.pi / size[0] * sigma_pixels,
        np.pi / size[1] * sigma_pixels,
    )
    horizontal = float(np.hypot(position[0], position[1]))
    towards = np.array([position[0], position[1], 0.0]) / horizontal
    return Measurement(OK, float(np.linalg.norm(position)), horizontal, float(np.sqrt(towards @ covariance @ towards)))


def _from_disparities(match: ObjectMatch, direction_upper: np.ndarray, size, rig: StereoRig) -> Measurement:
    found = disparity_distance(match, *size, rig.baseline)
    distance = found.distance(direction_upper) if found.outcome == OK else float("nan")
    return Measurement(found.outcome, distance, found.horizontal_range, found.sigma)
