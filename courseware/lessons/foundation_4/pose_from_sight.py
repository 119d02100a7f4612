"""How well directions, ranges and both together fix a pose on a map of objects, and three ways to compute it."""

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo import fit_rigid_2d


def derivatives(objects: np.ndarray, pose: np.ndarray, baseline: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return derivatives of bearings and of ranges by [x, y, theta] `(n, 3)`, and sigma of the ranges per radian [m].

    sigma of a range is sqrt(2) rho^2 / baseline for each radian of a direction's, eq. (14.4) for level rays.
    """
    x, y = (objects - pose[:2]).T
    rho = np.hypot(x, y)
    bearing = np.stack([y / rho**2, -x / rho**2, -np.ones_like(x)], axis=1)
    return bearing, np.stack([-x / rho, -y / rho, 0 * x], axis=1), np.sqrt(2) * rho**2 / baseline


def informations(objects, pose, sigma: float, baseline: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the information `(3, 3)` about the pose in the bearings and in the ranges; sigma of a direction [rad]."""
    bearing, radial, spread = derivatives(objects, pose, baseline)
    return bearing.T @ bearing / sigma**2, (radial / spread[:, None] ** 2).T @ radial / sigma**2


def fit_pose(objects, bearings, ranges, baseline: float, start, use_ranges: bool) -> np.ndarray:
    """Return the pose [x, y, theta] that fits best, by Gauss-Newton; each residual counts by its own sigma."""
    pose = np.array(start)
    for _ in range(8):
        by_bearing, by_range, spread = derivatives(objects, pose, baseline)
        x, y = (objects - pose[:2]).T
        rows, rests = by_bearing, wrap_angle(bearings - np.arctan2(y, x) + pose[2])
        if use_ranges:
            rows = np.vstack([rows, by_range / spread[:, None]])
            rests = np.concatenate([rests, (ranges - np.hypot(x, y)) / spread])
        pose += np.linalg.lstsq(rows, rests, rcond=None)[0]
    return pose


def pose_errors(n: int, sigma: float, baseline: float = 0.3, repeats: int = 200) -> np.ndarray:
    """Return errors of place [m] `(repeats, 3)`: bearings alone, bearings and ranges, the paper's fit of places.

    n objects stand in a random room of 5 x 5 m, at least 1 m away, matched rightly. The first two fits start at the
    true pose, because here the question is how exact they are, and not whether they find it.
    """
    errors = []
    for seed in range(repeats):
        rng = np.random.default_rng(seed)
        pose = np.array([*rng.uniform(1, 4, 2), rng.uniform(-3, 3)])
        objects = rng.uniform(0, 5, (50 * n, 2))
        objects = objects[np.linalg.norm(objects - pose[:2], axis=1) > 1][:n]
        x, y = (objects - pose[:2]).T
        bearings = np.arctan2(y, x) - pose[2] + sigma * rng.standard_normal(n)
        ranges = baseline / (baseline / np.hypot(x, y) + np.sqrt(2) * sigma * rng.standard_normal(n))
        body = ranges[:, None] * np.stack([np.cos(bearings), np.sin(bearings)], axis=1)
        found = [fit_pose(objects, bearings, ranges, baseline, pose, use) for use in (False, True)]
        errors.append([np.hypot(*(one[:2] - pose[:2])) for one in (*found, np.array(fit_rigid_2d(body, objects)))])
    return np.array(errors)
