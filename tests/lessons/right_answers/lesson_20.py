"""Right answers to lesson 20 by other ways than its solutions."""

import numpy as np


def metres(raw, units, invalid):
    depth = raw.astype(float) / units
    depth[raw == invalid] = np.nan
    return depth


def baselines(u, v, h, d):
    return d * (np.tan(np.pi * (0.5 - v / h)) - np.tan(np.pi * (0.5 - u / h)))


def by_bisection(rho, rows, height, limit):
    """The error falls up to a baseline of 2 rho, where it is least."""
    low, high, sigma = 1e-9 * rho, 2 * rho, np.sqrt(2) * np.pi * rows / height
    for _ in range(80):
        middle = (low + high) / 2
        enough = rho**2 / middle / np.cos(np.arctan(middle / (2 * rho))) ** 2 * sigma <= limit
        low, high = (low, middle) if enough else (middle, high)
    return high if high < 2 * rho else np.nan


def by_roots(rho, rows, height, limit):
    s = np.sqrt(2) * np.pi * rows / height
    roots = np.roots([s / 4, -limit, s * rho**2])
    return min(roots.real) if np.isreal(roots).all() else np.nan


RIGHT = [
    ("20.1", metres),
    ("20.1", lambda raw, units, invalid: [[np.nan if v == invalid else v / units for v in row] for row in raw]),
    ("20.2", lambda k, s: np.array([[s, 0, (s - 1) / 2], [0, s, (s - 1) / 2], [0, 0, 1]]) @ k),
    ("20.2", lambda k, s: np.array([[s, 0, s / 2 - 0.5], [0, s, s / 2 - 0.5], [0, 0, 1]]) @ k),
    ("20.3", lambda *given: np.array([np.median(baselines(*given))])),
    ("20.3", lambda u, v, h, d: np.median(d * (1 / np.tan(np.pi * v / h) - 1 / np.tan(np.pi * u / h)))),
    ("20.4", by_bisection),
    ("20.4", by_roots),
]
