"""Right answers to lesson 04 by other ways than its solutions."""

import numpy as np
from scipy.integrate import trapezoid
from scipy.stats import norm

LIGHT = 299_792_458.0  # m/s


def by_candidates(miss):
    """04.2: of all ranges that are read as `a`, the one with the least `miss(candidates, reading at b, turn at b)`."""

    def answer(a, f_a, b, f_b, farthest):
        candidates = [np.arange(one, farthest, LIGHT / (2 * f_a)) for one in a]
        misses = [miss(some, other, LIGHT / (2 * f_b)) for some, other in zip(candidates, b, strict=True)]
        return [some[k.argmin()] for some, k in zip(candidates, misses, strict=True)]

    return answer


def phasor(r, f):
    return np.exp(4j * np.pi * f * r / LIGHT)


def share_by_search(r, r1, p1, r2, p2, f):
    """By halving an interval, since the reading falls from r2 to r1 with the share."""
    near, far, hand = p1 * phasor(r1, f) / r1**2, p2 * phasor(r2, f) / r2**2, phasor(r, f)
    low, high = np.zeros(len(r)), np.ones(len(r))
    for _ in range(60):
        share = (low + high) / 2
        too_far = ((share * near + (1 - share) * far) / hand).imag > 0
        low, high = np.where(too_far, share, low), np.where(too_far, high, share)
    return (low + high) / 2


def share_by_cross(r, r1, p1, r2, p2, f):
    near, far = ((p / d**2 * phasor(d, f) / phasor(r, f)).imag for d, p in ((r1, p1), (r2, p2)))
    return far / (far - near)


def least_by_parts(n):
    """From P(least > x) = sf(x)^n alone."""
    x = np.linspace(-8, 8, 8001)
    above = norm.sf(x) ** n
    mean, second = x[0] + trapezoid(above, x), x[0] ** 2 + 2 * trapezoid(x * above, x)
    return mean, np.sqrt(second - mean**2)


def least_by_drawing(n):
    least = np.random.default_rng(1).standard_normal((100_000, n), dtype=np.float32).min(axis=1)
    return [least.mean(), least.std()]


def ray_by_ray(ranges, rays):
    return [[r / np.linalg.norm(ray) for r, ray in zip(*row, strict=True)] for row in zip(ranges, rays, strict=True)]


RIGHT = [
    ("04.1", lambda r, rays: r * np.cos(np.arctan(np.hypot(rays[..., 0], rays[..., 1])))),
    ("04.1", lambda r, rays: r / (rays**2).sum(-1) ** 0.5),
    ("04.1", ray_by_ray),
    ("04.2", by_candidates(lambda c, b, turn: 1 - np.cos(2 * np.pi * (c - b) / turn))),
    ("04.2", by_candidates(lambda c, b, turn: np.minimum((c - b) % turn, (b - c) % turn))),
    ("04.3", share_by_search),
    ("04.3", share_by_cross),
    ("04.4", least_by_parts),
    ("04.4", least_by_drawing),
]
