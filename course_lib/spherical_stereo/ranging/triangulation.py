"""From two directions to a position: X = d x_hat, how sure it is, and when there is none (paper 2, section 2.4).

Upper camera, lower camera and point make a triangle. Its angle at the point is the parallax e_l - e_u, its angle at the
lower camera pi/2 - e_l, so the law of sines gives d. The rays of two box centres do not quite meet: the distance comes
from the elevations, the azimuth from the upper camera.
"""

import numpy as np

from course_lib.spherical_stereo.matching.epipolar import epipolar_residual
from course_lib.spherical_stereo.outcomes import ObjectOutcome
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, azimuth_elevation, direction_from_angles

PARALLEL_TOLERANCE = 1e-3  # radians of parallax below which rays count as parallel: 300 m at a baseline of 0.3 m
# Epipolar residual, radians, above which two box centres are not one object's (chosen: 20 columns at 1280, 0.6 of the
# width of a chair three metres away).
AZIMUTH_GAP_TOLERANCE = 0.1
_NO_DISTANCE = [ObjectOutcome.AZIMUTH_GAP, ObjectOutcome.DIVERGING, ObjectOutcome.PARALLEL]  # the first one counts


class TriangulationError(ValueError):
    """Two directions that give no distance; `outcome` says why: parallel, diverging, or an azimuth gap."""

    def __init__(self, message: str, outcome: ObjectOutcome):
        super().__init__(message)
        self.outcome = outcome


def triangulation_outcome(direction_upper: np.ndarray, direction_lower: np.ndarray) -> np.ndarray:
    """Return the outcomes `(...)` of two directions `(..., 3)`. One straight up or down counts as parallel."""
    _, upper, _, lower, residual = _angles(direction_upper, direction_lower)
    parallax = lower - upper
    upright = np.pi / 2 - np.maximum(np.abs(upper), np.abs(lower)) <= PARALLEL_TOLERANCE
    return np.select(
        [residual > AZIMUTH_GAP_TOLERANCE, parallax < -PARALLEL_TOLERANCE, (parallax <= PARALLEL_TOLERANCE) | upright],
        _NO_DISTANCE,
        ObjectOutcome.OK,
    )


def triangulate(direction_upper: np.ndarray, direction_lower: np.ndarray, baseline: float) -> np.ndarray:
    """Return distances d `(...)` in metres along the upper camera's directions: the object is at X = d x_hat_upper.

    d = baseline cos e_l / sin(e_l - e_u),    horizontally rho = d cos e_u = baseline / (tan e_l - tan e_u)

    Directions `(..., 3)` in the body frame, broadcast together; baseline in metres. Raises `TriangulationError` if any
    pair has another outcome than "ok", `PanoramaError` for directions that are none, or a baseline that is not
    positive. Source: paper 2, section 2.4.
    """
    baseline = StereoRig(baseline).baseline
    outcome = triangulation_outcome(direction_upper, direction_lower)
    _, upper, _, lower, residual = _angles(direction_upper, direction_lower)
    for name in _NO_DISTANCE:
        if (outcome == name).any():
            first = tuple(np.argwhere(outcome == name)[0])
            e_u, e_l, gap = np.degrees([upper[first], lower[first], residual[first]])
            raise TriangulationError(
                f"{name}: the elevations are {e_u:.3f} (upper) and {e_l:.3f} degrees, and the directions {gap:.2f} "
                "degrees apart across the epipolar half-circle",
                name,
            )
    return baseline * np.cos(lower) / np.sin(lower - upper)


def object_position(direction_upper: np.ndarray, direction_lower: np.ndarray, baseline: float) -> np.ndarray:
    """Return positions X = d x_hat `(..., 3)` in metres, in the upper camera's frame (x forward, y left, z up)."""
    unit = direction_from_angles(*azimuth_elevation(direction_upper))
    return triangulate(direction_upper, direction_lower, baseline)[..., None] * unit


def triangulation_covariance(
    direction_upper: np.ndarray,
    direction_lower: np.ndarray,
    baseline: float,
    sigma_azimuth: float | np.ndarray,
    sigma_elevation: float | np.ndarray,
) -> np.ndarray:
    """Return covariances `(..., 3, 3)` of X = d x_hat, square metres, from noise of the two directions (first order).

    C = J diag(s_a^2, s_e^2, s_e^2) J'  with J the derivative of

    X(a, e_u, e_l) = rho (cos a, sin a, tan e_u),      rho = baseline / (tan e_l - tan e_u)
    d rho / d e_u = rho^2 sec^2 e_u / baseline,        d rho / d e_l = -rho^2 sec^2 e_l / baseline

    sigma_azimuth: of the upper camera's azimuth, sigma_elevation: of either camera's elevation, radians, independent.
    Source: paper 2, section 2.4.
    """
    for sigma in (np.asarray(sigma_azimuth), np.asarray(sigma_elevation)):
        if not (np.isfinite(sigma).all() and (sigma >= 0).all()):
            raise PanoramaError(f"a sigma must be finite radians, not negative; got {sigma}")
    azimuth, upper, _, lower, _ = _angles(direction_upper, direction_lower)
    rho = triangulate(direction_upper, direction_lower, baseline) * np.cos(upper)
    azimuth, sigma_azimuth, sigma_elevation = np.broadcast_arrays(azimuth, sigma_azimuth, sigma_elevation)[:3]
    along = np.stack([np.cos(azimuth), np.sin(azimuth), np.broadcast_to(np.tan(upper), azimuth.shape)], axis=-1)
    by_azimuth = rho[..., None] * np.stack([-np.sin(azimuth), np.cos(azimuth), np.zeros_like(azimuth)], axis=-1)
    secant_upper, secant_lower = 1 / np.cos(upper) ** 2, 1 / np.cos(lower) ** 2
    by_upper = (rho**2 * secant_upper / baseline)[..., None] * along
    by_upper[..., 2] += rho * secant_upper
    by_lower = -(rho**2 * secant_lower / baseline)[..., None] * along
    jacobian = np.stack([by_azimuth, by_upper, by_lower], axis=-1)
    variance = np.stack([sigma_azimuth, sigma_elevation, sigma_elevation], axis=-1) ** 2
    return (jacobian * variance[..., None, :]) @ np.swapaxes(jacobian, -1, -2)


def _angles(direction_upper, direction_lower):
    """Return azimuth and elevation of both directions, broadcast together, and their epipolar residual, radians."""
    angles = np.broadcast_arrays(*azimuth_elevation(direction_upper), *azimuth_elevation(direction_lower))
    return *angles, epipolar_residual(*angles)
