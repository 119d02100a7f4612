"""Directions with noise, the places that they give, and the ellipse of their covariance."""

import numpy as np

from course_lib.spherical_stereo.panorama import direction_from_angles
from course_lib.spherical_stereo.ranging.triangulation import OK, object_position, triangulation_outcome

PIXEL = 2 * np.pi / 1280
"""Radians of one pixel of the room's panoramas, in azimuth and in elevation alike."""
SAMPLES = np.random.default_rng(14).standard_normal((400, 3))
"""Standard normal draws for azimuth, upper and lower elevation; the same for every setting: nothing flickers."""


def directions_to(point: np.ndarray, baseline: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the unit vectors `(3,)` from the upper and the lower camera to a point in the upper camera's frame."""
    upper, lower = (ray / np.linalg.norm(ray) for ray in (point, np.add(point, [0.0, 0.0, baseline])))
    return upper, lower


def noisy_directions(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Return 400 directions `(400, 3)` to one point, with noise of sigma radians on azimuth and both elevations."""
    (x, y, z), noise, end = point, sigma * SAMPLES.T, np.pi / 2 - 1e-6
    elevations = (np.arctan2(height, np.hypot(x, y)) for height in (z, z + baseline))
    upper, lower = (
        direction_from_angles(np.arctan2(y, x) + noise[0], np.clip(e + n, -end, end))
        for e, n in zip(elevations, noise[1:], strict=True)
    )
    return upper, lower


def sampled_places(point: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Return places `(k, 3)` [m] of the noisy directions that have one, and the outcomes `(400,)` of all."""
    upper, lower = noisy_directions(point, baseline, sigma)
    outcomes = triangulation_outcome(upper, lower)
    ok = outcomes == OK
    return object_position(upper[ok], lower[ok], baseline) if ok.any() else np.zeros((0, 3)), outcomes


def ellipse(covariance: np.ndarray, centre: np.ndarray, n_sigma: float = 2.0) -> np.ndarray:
    """Return the outline `(60, 2)` of points n_sigma standard deviations from the centre; covariance `(2, 2)`."""
    values, vectors = np.linalg.eigh(covariance)
    turn = np.linspace(0, 2 * np.pi, 60)
    axes = n_sigma * np.sqrt(np.maximum(values, 0))[:, None] * np.stack([np.cos(turn), np.sin(turn)])
    return centre + (vectors @ axes).T
