"""Right answers to lesson 19 by other ways than its solutions."""

import math

import numpy as np
from scipy.stats import binomtest


def by_matrix(x, y, theta, forward, left, turned):
    """Two poses as homogeneous matrices, one after the other."""

    def pose(x, y, angle):
        return np.array([[np.cos(angle), -np.sin(angle), x], [np.sin(angle), np.cos(angle), y], [0, 0, 1]])

    camera = pose(x, y, theta) @ pose(forward, left, turned)
    return camera[0, 2], camera[1, 2], math.atan2(camera[1, 0], camera[0, 0])


def by_complex_numbers(x, y, theta, forward, left, turned):
    camera = complex(x, y) + np.exp(1j * theta) * complex(forward, left)
    return [camera.real, camera.imag, np.angle(np.exp(1j * (theta + turned)))]


def by_loops(covariance, sigma_z, sigma_tilt_deg):
    result = [[0.0] * 6 for _ in range(6)]
    for a, i in enumerate((0, 1, 5)):
        for b, j in enumerate((0, 1, 5)):
            result[i][j] = covariance[a][b]
    result[2][2] = sigma_z**2
    result[3][3] = result[4][4] = math.radians(sigma_tilt_deg) ** 2
    return result


def by_blocks(covariance, sigma_z, sigma_tilt_deg):
    tilt = np.radians(sigma_tilt_deg)
    return np.block(
        [
            [covariance[:2, :2], np.zeros((2, 3)), covariance[:2, 2:]],
            [np.zeros((3, 2)), np.diag([sigma_z**2, tilt**2, tilt**2]), np.zeros((3, 1))],
            [covariance[2:, :2], np.zeros((1, 3)), covariance[2:, 2:]],
        ]
    )


def low(hits, n, z=1.96):
    p = hits / n
    return (p + z * z / 2 / n - z * math.sqrt(p * (1 - p) / n + z * z / 4 / n / n)) / (1 + z * z / n)


def first(enough, begin=1):
    n = begin
    while not enough(n):
        n += 1
    return n


def by_bisection(share, misses):
    below, enough = misses, 4096
    while enough - below > 1:
        middle = (below + enough) // 2
        below, enough = (below, middle) if low(middle - misses, middle) >= share else (middle, enough)
    return enough


def by_scipy(share, misses):
    def lower(n):
        return binomtest(n - misses, n).proportion_ci(confidence_level=0.95, method="wilson").low

    return first(lambda n: lower(n) >= share, misses + 1)


def derivative(theta, forward, left):
    """By differences of 19.1."""
    step, columns = 1e-6, []
    for direction in np.eye(3):
        ends = [
            np.array(by_matrix(*(np.array([0.0, 0.0, theta]) + side * step * direction), forward, left, 0.0))
            for side in (1, -1)
        ]
        columns.append((ends[0] - ends[1]) / (2 * step))
    columns[2][2] = 1.0
    return np.column_stack(columns)


def by_hand(p, theta, forward, left):
    """J P J' written out: the lever's two numbers times variances and covariances."""
    u = -math.sin(theta) * forward - math.cos(theta) * left
    v = math.cos(theta) * forward - math.sin(theta) * left
    xx = p[0, 0] + 2 * u * p[0, 2] + u * u * p[2, 2]
    yy = p[1, 1] + 2 * v * p[1, 2] + v * v * p[2, 2]
    xy = p[0, 1] + v * p[0, 2] + u * p[1, 2] + u * v * p[2, 2]
    xt, yt = p[0, 2] + u * p[2, 2], p[1, 2] + v * p[2, 2]
    return [[xx, xy, xt], [xy, yy, yt], [xt, yt, p[2, 2]]]


RIGHT = [
    ("19.1", by_matrix),
    ("19.1", by_complex_numbers),
    ("19.1", lambda *given: np.array(by_matrix(*given))),
    ("19.2", by_loops),
    ("19.2", by_blocks),
    ("19.2", lambda p, z, t: np.array(by_loops(p, z, t), np.float32)),
    ("19.3", by_bisection),
    ("19.3", by_scipy),
    ("19.3", lambda share, misses: float(by_bisection(share, misses))),
    ("19.4", by_hand),
    ("19.4", lambda p, theta, f, left: derivative(theta, f, left) @ p @ derivative(theta, f, left).T),
    ("19.4", lambda p, theta, f, left: np.einsum("ia,ab,jb", d := derivative(theta, f, left), p, d)),
    ("19.4", lambda p, theta, f, left: np.array(by_hand(p, theta, f, left), np.float32)),
]
