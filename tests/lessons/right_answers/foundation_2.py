"""Right answers to F2 by other ways than its solutions."""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from course_lib.geometry import rotation_exp, rotation_log, rotation_mean


def mean_by_search(rotations, weights):
    """The least weighted sum of squared angles."""
    start = rotation_mean(rotations, weights)
    rests = lambda x: (np.sqrt(weights)[:, None] * rotation_log((start @ rotation_exp(x)).T @ rotations)).ravel()  # noqa: E731
    return start @ rotation_exp(least_squares(rests, np.zeros(3), xtol=1e-10).x)


def end_by_matrix(v, omega):
    """By the exponential of a four-by-four matrix."""
    twist = np.zeros((4, 4))
    twist[:3, :3], twist[:3, 3] = np.cross(np.eye(3), omega), v
    return expm(twist)[:3, 3]


RIGHT = [
    ("F2.1", lambda p, h, a, t: Rotation.from_rotvec(t * a / np.sqrt(a @ a)).apply(p - h) + h),
    ("F2.2", mean_by_search),
    ("F2.3", end_by_matrix),
]
