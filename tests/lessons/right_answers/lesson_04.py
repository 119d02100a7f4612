"""Right answers to lesson 04 by other ways than its solutions."""

import numpy as np
from scipy.integrate import trapezoid
from scipy.stats import norm

LIGHT = 299_792_458.0  # m/s


def by_candidates(miss):
    """04.2: of all ranges that are read as `a`, the one with the least `miss(candidates, reading at b, turn at b)`."""

    def answer(a, f_a, b, f_b, farthest):
        candidates = [np.arange(one, farthest, LIGHT / (2 * f_a)) for one in a]
        return [c[miss(c, other, LIGHT / (2 * f_b)).argmin()] for c, other in zip(candidates, b, strict=True)]

    return answer


def hands(r, r1, p1, r2, p2, f):
    """Both phasors, turned so that the reading r points along the real axis."""
    return [p / d**2 * np.exp(4j * np.pi * f * (d - r) / LIGHT) for d, p in ((r1, p1), (r2, p2))]


def share_by_search(*pixel):
    """By halving an interval, since the reading falls from r2 to r1 with the share."""
    near, far = hands(*pixel)
    share = np.full(len(near), 0.5)
    for k in range(2, 60):
        share += np.where((share * near + (1 - share) * far).imag > 0, 1, -1) / 2.0**k
    return share


def share_by_cross(*pixel):
    near, far = hands(*pixel)
    return far.imag / (far - near).imag


def least_by_parts(n):
    """From P(least > x) = sf(x)^n alone."""
    x = np.linspace(-8, 8, 8001)
    above = norm.sf(x) ** n
    mean = x[0] + trapezoid(above, x)
    return mean, np.sqrt(x[0] ** 2 + 2 * trapezoid(x * above, x) - mean**2)


def least_by_drawing(n):
    least = np.random.default_rng(1).standard_normal((100_000, n), dtype=np.float32).min(axis=1)
    return [least.mean(), least.std()]


RIGHT = [
    ("04.1", lambda r, rays: r * np.cos(np.arctan(np.hypot(rays[..., 0], rays[..., 1])))),
    ("04.1", lambda r, rays: r / (rays**2).sum(-1) ** 0.5),
    (
        "04.1",
        lambda r, rays: [[r[v, u] / np.linalg.norm(rays[v, u]) for u in range(r.shape[1])] for v in range(len(r))],
    ),
    ("04.2", by_candidates(lambda c, b, turn: 1 - np.cos(2 * np.pi * (c - b) / turn))),
    ("04.2", by_candidates(lambda c, b, turn: np.minimum((c - b) % turn, (b - c) % turn))),
    ("04.3", share_by_search),
    ("04.3", share_by_cross),
    ("04.4", least_by_parts),
    ("04.4", least_by_drawing),
]
