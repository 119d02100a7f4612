"""Right answers to lesson 14 by other ways than its solutions."""

import itertools
import math

import numpy as np

PI = np.pi


def place(upper, lower, width, baseline):
    """Without d: the horizontal range, and the height from it."""
    a, e_u = (0.5 - (upper[0] + upper[2]) / 2 / width) * 2 * PI, (0.5 - (upper[1] + upper[3]) / width) * PI
    rho = baseline / (np.tan((0.5 - (lower[1] + lower[3]) / width) * PI) - np.tan(e_u))
    return [rho * np.cos(a), rho * np.sin(a), rho * np.tan(e_u)]


def slope(e_u, e_l):
    return np.tan(e_l) - np.tan(e_u)


def sigma(rho, e_u, e_l, b, s, s_b):
    return np.sqrt((rho**2 / b * s) ** 2 * (np.cos(e_u) ** -4 + np.cos(e_l) ** -4) + (rho / b * s_b) ** 2)


def sigma_by_differences(rho, e_u, e_l, b, s, s_b):
    """Derivatives of (14.3) by small steps."""
    ends = [[(b + d) / slope(e_u + u, e_l + low) for u, low, d in way * 1e-6 * np.eye(3)] for way in (1, -1)]
    return np.linalg.norm(np.subtract(*ends) / 2e-6 * np.array([[s], [s], [s_b]]), axis=0)


def range_or_nan(slope_of):
    """A range from `slope_of(slopes)`, NaN where that is not positive."""
    return lambda e_u, e_l, b: b / slope_of(slope(e_u, e_l)) if slope_of(slope(e_u, e_l)) > 0 else math.nan


def of_positive(slopes):
    return np.median(slopes[slopes > 0]) if (slopes > 0).any() else -1


def inlier_mean(slopes):
    return np.mean(slopes[np.abs(slopes - np.median(slopes)) < 0.04])


def hodges_lehmann(slopes):
    return np.median([(a + b) / 2 for a, b in itertools.combinations_with_replacement(slopes, 2)])


def median_of_ranges(e_u, e_l, b):
    return np.array([np.median(b / slope(e_u, e_l)) if np.median(slope(e_u, e_l)) > 0 else math.nan])


def excess_by_differences(rho, e_u, e_l, b, s):
    """Second derivatives by differences, to Taylor's second order."""
    steps, weights = 1e-3 * np.arange(-2, 3), np.array([-1, 16, -30, 16, -1]) / 12e-6
    by_u = sum(w * b / slope(e_u + h, e_l) for h, w in zip(steps, weights, strict=True))
    by_l = sum(w * b / slope(e_u, e_l + h) for h, w in zip(steps, weights, strict=True))
    return s**2 / 2 * (by_u + by_l)


def excess_of_slopes(rho, e_u, e_l, b, s):
    """By the slope's own mean and variance: E(B / s) = B / s (1 + var / s^2) - B / s^2 E(ds)."""
    steep, variance = slope(e_u, e_l), s**2 * (np.cos(e_u) ** -4 + np.cos(e_l) ** -4)
    shift = s**2 * (np.tan(e_l) / np.cos(e_l) ** 2 - np.tan(e_u) / np.cos(e_u) ** 2)
    return list(b / steep**3 * variance - b / steep**2 * shift)


RIGHT = [
    ("14.1", place),
    ("14.1", lambda *given: np.array(place(*given), dtype=np.float32)),
    ("14.2", sigma),
    ("14.2", sigma_by_differences),
    ("14.3", range_or_nan(np.median)),
    ("14.3", range_or_nan(of_positive)),
    ("14.3", range_or_nan(inlier_mean)),
    ("14.3", range_or_nan(hodges_lehmann)),
    ("14.3", median_of_ranges),
    ("14.4", excess_by_differences),
    ("14.4", excess_of_slopes),
    ("14.4", lambda *given: np.array(excess_of_slopes(*given))),
]
