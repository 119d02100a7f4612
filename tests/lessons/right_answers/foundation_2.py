"""Right answers to F2 by other ways than its solutions."""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from course_lib.geometry import rotation_exp, rotation_log, rotation_mean


def door_by_rodrigues(points, hinge, axis, angle):
    """Without a matrix: the three parts of Rodrigues' formula, point by point."""
    k, opened = axis / np.linalg.norm(axis), []
    for v in points - hinge:
        opened.append(hinge + v * np.cos(angle) + np.cross(k, v) * np.sin(angle) + k * (k @ v) * (1 - np.cos(angle)))
    return opened


def mean_by_small_steps(rotations, weights):
    """From the chordal mean on, until nothing moves."""
    M, w = rotation_mean(rotations, weights), weights / np.sum(weights)
    while np.linalg.norm(step := w @ rotation_log(M.T @ rotations)) > 1e-7:
        M = M @ rotation_exp(0.7 * step)
    return M


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


def end_by_integration(v, omega):
    """By Gauss's rule over the way."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    return weights / 2 @ Rotation.from_rotvec((nodes[:, None] + 1) / 2 * omega).apply(v)


RIGHT = [
    ("F2.1", door_by_rodrigues),
    ("F2.1", lambda p, h, a, t: Rotation.from_rotvec(t * a / np.sqrt(a @ a)).apply(p - h) + h),
    ("F2.2", mean_by_small_steps),
    ("F2.2", mean_by_search),
    ("F2.3", end_by_matrix),
    ("F2.3", end_by_integration),
]
