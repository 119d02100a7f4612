"""Directions with noise, the places that they give, and the ellipse of their covariance."""

import numpy as np

from course_lib.spherical_stereo.panorama import direction_from_angles
from course_lib.spherical_stereo.ranging.triangulation import OK, object_position, triangulation_outcome

PIXEL = 2 * np.pi / 1280
"""Radians of one pixel of the room's panoramas, in azimuth and in elevation alike."""
N_SAMPLES = 400
SAMPLES = np.random.default_rng(14).standard_normal((N_SAMPLES, 3))
"""Standard normal draws for azimuth, upper and lower elevation; the same for every setting: nothing flickers."""


def directions_to(point: np.ndarray, baseline: float) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors `(..., 3)` from the upper and the lower camera to points `(..., 3)` in the upper camera's frame."""
    point = np.asarray(point, dtype=np.float64)
    rays = point, point + np.array([0.0, 0.0, baseline])
    upper, lower = (ray / np.linalg.norm(ray, axis=-1, keepdims=True) for ray in rays)
    return upper, lower


def noisy_directions(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Directions `(N_SAMPLES, 3)` to one point, with noise of sigma radians on the azimuth and both elevations."""
    x, y, z = point
    azimuth, horizontal = np.arctan2(y, x), np.hypot(x, y)
    elevations = np.arctan2(z, horizontal), np.arctan2(z + baseline, horizontal)
    noise = sigma * SAMPLES.T
    end = np.pi / 2 - 1e-6
    upper, lower = (
        direction_from_angles(azimuth + noise[0], np.clip(e + n, -end, end))
        for e, n in zip(elevations, noise[1:], strict=True)
    )
    return upper, lower


def sampled_places(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Places `(k, 3)`, metres, of the noisy directions that have one, and the outcomes `(N_SAMPLES,)` of all."""
    upper, lower = noisy_directions(point, baseline, sigma)
    outcomes = triangulation_outcome(upper, lower)
    ok = outcomes == OK
    if not ok.any():
        return np.zeros((0, 3)), outcomes
    return object_position(upper[ok], lower[ok], baseline), outcomes


def ellipse(covariance: np.ndarray, centre: np.ndarray, n_sigma: float = 2.0) -> np.ndarray:
    """Outline `(60, 2)` of the points that are n_sigma standard deviations from the centre; covariance `(2, 2)`."""
    values, vectors = np.linalg.eigh(covariance)
    turn = np.linspace(0, 2 * np.pi, 60)
    axes = n_sigma * np.sqrt(np.maximum(values, 0))[:, None] * np.stack([np.cos(turn), np.sin(turn)])
    return centre + (vectors @ axes).T
