"""Right answers to lesson 20 by other ways than its solutions."""

import numpy as np


def by_roots(rho, rows, height, limit):
    s = np.sqrt(2) * np.pi * rows / height
    roots = np.roots([s / 4, -limit, s * rho**2])
    return min(roots.real) if np.isreal(roots).all() else np.nan


RIGHT = [
    ("20.1", lambda raw, units, invalid: [[np.nan if v == invalid else v / units for v in row] for row in raw]),
    ("20.2", lambda k, s: np.array([[s, 0, (s - 1) / 2], [0, s, (s - 1) / 2], [0, 0, 1]]) @ k),
    ("20.3", lambda u, v, h, d: np.median(d * (1 / np.tan(np.pi * v / h) - 1 / np.tan(np.pi * u / h)))),
    ("20.4", by_roots),
]
