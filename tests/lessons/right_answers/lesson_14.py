"""Right answers to lesson 14 by other ways than its solutions."""

import numpy as np

PI = np.pi


def slope(e_u, e_l):
    return np.tan(e_l) - np.tan(e_u)


def steepness(e_u, e_l):
    return np.cos(e_u) ** -4 + np.cos(e_l) ** -4


def place(upper, lower, width, baseline):
    """Without d: the horizontal range, and the height from it."""
    a, e_u = (0.5 - (upper[0] + upper[2]) / 2 / width) * 2 * PI, (0.5 - (upper[1] + upper[3]) / width) * PI
    rho = baseline / slope(e_u, (0.5 - (lower[1] + lower[3]) / width) * PI)
    return [rho * np.cos(a), rho * np.sin(a), rho * np.tan(e_u)]


def sigma_by_differences(rho, e_u, e_l, b, s, s_b):
    """Derivatives of (14.3) by small steps."""
    ends = [[(b + d) / slope(e_u + u, e_l + low) for u, low, d in way * 1e-6 * np.eye(3)] for way in (1, -1)]
    return np.linalg.norm(np.subtract(*ends) / 2e-6 * np.array([[s], [s], [s_b]]), axis=0)


def range_or_nan(slope_of):
    """A range from `slope_of(slopes)`, NaN where that is not positive."""
    return lambda e_u, e_l, b: b / slope_of(slope(e_u, e_l)) if slope_of(slope(e_u, e_l)) > 0 else np.nan


def excess_by_differences(rho, e_u, e_l, b, s):
    """Second derivatives by differences, to Taylor's second order."""
    steps = list(zip(1e-3 * np.arange(-2, 3), np.array([-1, 16, -30, 16, -1]) / 12e-6, strict=True))
    return s**2 / 2 * sum(w * (b / slope(e_u + h, e_l) + b / slope(e_u, e_l + h)) for h, w in steps)


def excess_of_slopes(rho, e_u, e_l, b, s):
    """By the slope's own mean and variance: E(B / s) = B / s (1 + var / s^2) - B / s^2 E(ds)."""
    shift = np.tan(e_l) / np.cos(e_l) ** 2 - np.tan(e_u) / np.cos(e_u) ** 2
    return list(s**2 * b * (steepness(e_u, e_l) / slope(e_u, e_l) ** 3 - shift / slope(e_u, e_l) ** 2))


RIGHT = [
    ("14.1", place),
    ("14.1", lambda *given: np.array(place(*given), dtype=np.float32)),
    ("14.2", lambda rho, u, w, b, s, s_b: np.sqrt((rho**2 / b * s) ** 2 * steepness(u, w) + (rho / b * s_b) ** 2)),
    ("14.2", sigma_by_differences),
    ("14.3", range_or_nan(np.median)),
    ("14.3", range_or_nan(lambda slopes: np.median(slopes[slopes > 0]) if (slopes > 0).any() else -1)),
    ("14.3", range_or_nan(lambda slopes: np.mean(slopes[np.abs(slopes - np.median(slopes)) < 0.04]))),
    ("14.3", range_or_nan(lambda s: np.median([a + b for k, a in enumerate(s) for b in s[k:]]) / 2)),  # Hodges, Lehmann
    ("14.3", lambda u, w, b: np.array([np.median(b / slope(u, w)) if np.median(slope(u, w)) > 0 else np.nan])),
    ("14.4", excess_by_differences),
    ("14.4", excess_of_slopes),
    ("14.4", lambda *given: np.array(excess_of_slopes(*given))),
]
