"""Right answers to lesson 19 by other ways than its solutions."""

import bisect
import itertools
import math

import numpy as np
from scipy.linalg import block_diag
from scipy.stats import binomtest


def pose(x, y, angle):
    return np.array([[np.cos(angle), -np.sin(angle), x], [np.sin(angle), np.cos(angle), y], [0, 0, 1]])


def by_matrix(x, y, theta, forward, left, turned):
    camera = pose(x, y, theta) @ pose(forward, left, turned)
    return camera[0, 2], camera[1, 2], math.atan2(camera[1, 0], camera[0, 0])


def by_complex_numbers(x, y, theta, forward, left, turned):
    camera = complex(x, y) + np.exp(1j * theta) * complex(forward, left)
    return [camera.real, camera.imag, np.angle(np.exp(1j * (theta + turned)))]


def by_loops(covariance, sigma_z, sigma_tilt_deg):
    result = np.diag([0, 0, sigma_z**2, *[math.radians(sigma_tilt_deg) ** 2] * 2, 0.0]).tolist()
    for (a, i), (b, j) in itertools.product(enumerate((0, 1, 5)), repeat=2):
        result[i][j] = covariance[a][b]
    return result


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


def by_hand(p, theta, forward, left):
    """J P J' written out: the lever's two numbers times variances and covariances."""
    u = -math.sin(theta) * forward - math.cos(theta) * left
    v = math.cos(theta) * forward - math.sin(theta) * left
    xx, yy = (p[k, k] + 2 * arm * p[k, 2] + arm * arm * p[2, 2] for k, arm in enumerate((u, v)))
    xy = p[0, 1] + v * p[0, 2] + u * p[1, 2] + u * v * p[2, 2]
    xt, yt = p[0, 2] + u * p[2, 2], p[1, 2] + v * p[2, 2]
    return [[xx, xy, xt], [xy, yy, yt], [xt, yt, p[2, 2]]]


RIGHT = [
    ("19.1", by_matrix),
    ("19.1", by_complex_numbers),
    ("19.1", lambda *given: np.array(by_matrix(*given))),
    ("19.2", by_loops),
    ("19.2", by_blocks),
    ("19.2", lambda *given: np.array(by_loops(*given), np.float32)),
    ("19.3", by_bisection),
    ("19.3", lambda share, misses: next(n for n in itertools.count(misses + 1) if wilson(n - misses, n) >= share)),
    ("19.3", lambda *given: float(by_bisection(*given))),
    ("19.4", by_hand),
    ("19.4", lambda p, *given: derivative(*given) @ p @ derivative(*given).T),
    ("19.4", lambda p, *given: np.einsum("ia,ab,jb", d := derivative(*given), p, d)),
    ("19.4", lambda *given: np.array(by_hand(*given), np.float32)),
]
