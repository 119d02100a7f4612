"""Right answers to lesson 19 by other ways than its solutions."""

import bisect
import math

import numpy as np
from scipy.linalg import block_diag
from scipy.stats import binomtest


def pose(x, y, angle):
    return np.array([[np.cos(angle), -np.sin(angle), x], [np.sin(angle), np.cos(angle), y], [0, 0, 1]])


def by_matrix(x, y, theta, forward, left, turned):
    camera = pose(x, y, theta) @ pose(forward, left, turned)
    return camera[0, 2], camera[1, 2], math.atan2(camera[1, 0], camera[0, 0])


def by_blocks(covariance, sigma_z, sigma_tilt_deg):
    order = [0, 1, 3, 4, 5, 2]
    return block_diag(covariance, sigma_z**2, np.radians(sigma_tilt_deg) ** 2 * np.eye(2))[np.ix_(order, order)]


def wilson(hits, n):
    return binomtest(hits, n).proportion_ci(method="wilson").low


def by_bisection(share, misses):
    return bisect.bisect_left(range(4096), share, misses + 1, key=lambda n: wilson(n - misses, n))


def derivative(theta, forward, left):
    """By differences of 19.1."""
    at = [[by_matrix(*np.add(off, [0, 0, theta]), forward, left, 0) for off in h * np.eye(3)] for h in (1e-6, -1e-6)]
    return (np.array(at[0]) - at[1]).T / 2e-6


RIGHT = [
    ("19.1", by_matrix),
    ("19.2", by_blocks),
    ("19.3", by_bisection),
    ("19.4", lambda p, *given: np.einsum("ia,ab,jb", d := derivative(*given), p, d)),
]
