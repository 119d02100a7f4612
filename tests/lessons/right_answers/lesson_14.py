"""Right answers to lesson 14 by other ways than its solutions."""

import numpy as np

PI = np.pi


def slope(e_u, e_l):
    return np.tan(e_l) - np.tan(e_u)


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


RIGHT = [
    ("14.1", place),
    ("14.2", sigma_by_differences),
    ("14.3", range_or_nan(np.median)),
    ("14.3", range_or_nan(lambda slopes: np.median(slopes[slopes > 0]) if (slopes > 0).any() else -1)),
    ("14.3", range_or_nan(lambda slopes: np.mean(slopes[np.abs(slopes - np.median(slopes)) < 0.04]))),
    ("14.3", range_or_nan(lambda s: np.median([a + b for k, a in enumerate(s) for b in s[k:]]) / 2)),  # Hodges, Lehmann
    ("14.3", lambda u, w, b: np.array([np.median(b / slope(u, w)) if np.median(slope(u, w)) > 0 else np.nan])),
    ("14.4", excess_by_differences),
]
