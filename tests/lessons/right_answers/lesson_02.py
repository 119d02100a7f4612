"""Right answers to lesson 02 by other ways than its solutions."""

import math
from itertools import accumulate

import numpy as np


def elevation(p):
    return math.asin(p[2] / math.hypot(*p))


def simulated_sigma(n_steps, spacing, sigma_place, sigma_heading, runs=10_000):
    """The same sigma by simulation: rows of stations with random errors."""
    rng = np.random.default_rng(0)
    x, y, heading = np.zeros((3, runs))
    for _ in range(n_steps):
        ahead, left = sigma_place * rng.normal(size=(2, runs)) + [[spacing], [0]]
        x = x + np.cos(heading) * ahead - np.sin(heading) * left
        y = y + np.sin(heading) * ahead + np.cos(heading) * left
        heading = heading + sigma_heading * rng.normal(size=runs)
    return np.std(y)


RIGHT = [
    ("02.1", lambda p: np.stack([np.linalg.norm(p, axis=1), np.angle(p[:, 0] + 1j * p[:, 1]), [*map(elevation, p)]])),
    ("02.2", lambda steps: np.stack(list(accumulate(steps, np.matmul, initial=np.eye(4))))[:, :3, 3]),
    ("02.3", lambda s, m, limit: sum(not any(np.linalg.norm(m - p, axis=1) <= limit) for p in s) / len(s)),
    ("02.4", simulated_sigma),
    ("02.4", lambda n, d, p, h: math.sqrt(n * p * p + sum((d * h * k) ** 2 for k in range(n)))),
    ("02.4", lambda n, d, p, h: math.sqrt(n * p * p + (n - 1) * n * (2 * n - 1) / 6 * (d * h) ** 2)),
]
