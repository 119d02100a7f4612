"""Answers that students may give to lessons 11 to 17, for test_exercise_answers.py."""

from __future__ import annotations

import math

import numpy as np

from course_lib.spherical_stereo import fit_rigid_2d

PI = np.pi


def struck(table, largest, rounds=None, blank=0, start=-1):
    """Repeated maximum or minimum of a table; without `rounds`, until nothing above 0 is left."""
    table, result = np.array(table, float), np.full(len(table), start)
    while table.max() > 0 if rounds is None else (rounds := rounds - 1) >= 0:
        i, j = np.unravel_index(table.argmax() if largest else table.argmin(), table.shape)
        result[i] = j
        table[i], table[:, j] = blank, blank
    return result


def by_order(table, order, last=math.inf):
    """One-to-one along a sorted list of all combinations, as long as they are below `last`."""
    result = np.full(len(table), -1)
    for k in order:
        i, j = divmod(int(k), table.shape[1])
        if result[i] < 0 and j not in result and table[i, j] < last:
            result[i] = j
    return result


def in_place(cost):
    result = np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(cost.argmin(), cost.shape)
        result[i], cost[i], cost[:, j] = j, np.inf, np.inf
    return result


def angles(box, width):
    return (0.5 - (box[0] + box[2]) / 2 / width) * 2 * PI, (0.5 - (box[1] + box[3]) / width) * PI


def place(u, lower, width, baseline, elevation_sign=1):
    a, e_u, e_l = *angles(u, width), angles(lower, width)[1]
    rho = baseline / (np.tan(elevation_sign * e_l) - np.tan(elevation_sign * e_u))
    return [rho * np.cos(a), rho * np.sin(a), rho * np.tan(elevation_sign * e_u)]


def slope(e_u, e_l):
    return np.tan(e_l) - np.tan(e_u)


def circle(a, b):
    return np.minimum(np.abs(a - b), 360 - np.abs(a - b))


def far(points):
    return np.linalg.norm(points - points.mean(axis=0), axis=1)


def term(far_c, far_m, p_d):
    return p_d * np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)


def square(points):
    return ((points - points.mean(axis=0)) ** 2).sum(axis=1)


def complex_fit(source, target, add=-1):
    """The fit with complex numbers: a rotation is a factor of length 1."""
    s, m = source @ [1, 1j], target @ [1, 1j]
    turn = (m - m.mean()) @ np.conj(s - s.mean())
    turn /= abs(turn)
    t = m.mean() + add * turn * s.mean()
    return t.real, t.imag, np.angle(turn)


def svd_without_sign(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    x, y = target.mean(axis=0) - u @ vt @ source.mean(axis=0)
    return x, y, np.arctan2((u @ vt)[1, 0], (u @ vt)[0, 0])


def full_circle(source, target):
    x, y, theta = complex_fit(source, target)
    return x, y, theta % (2 * PI)


def sums(source, target):
    a, b = (points - points.mean(axis=0) for points in (source, target))
    return np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), np.sum(a**2)


def left_over(source, target, k, everything=False):
    rest = np.arange(len(source)) != k
    residual = fit_rigid_2d(source[rest], target[rest]).apply(source) - target
    return np.sum(residual[rest | everything] ** 2)


def each(source, target, **options):
    return [left_over(source, target, k, **options) for k in range(len(source))]


# Exercise, answer, words of the hint that must come.
WRONG = [
    ("14.1", lambda u, low, w, b: place(u, low, w, 0.3), "always 0.3 m"),
    ("14.1", lambda u, low, w, b: place(u, low, w, b)[:2], "shape (3,); yours has (2,)"),
    (
        "14.1",
        lambda u, low, w, b: np.array(place(u, low, w, b)) / np.linalg.norm(place(u, low, w, b)),
        "unit vector alone",
    ),
    ("14.2", lambda r, u, e, b, s: r**2 / b * s * np.hypot(1 / np.cos(u), 1 / np.cos(e)), "square of 1 / cos^2"),
    ("14.2", lambda r, u, e, b, s: r**2 / b**2 * s * np.hypot(np.cos(u) ** -2, np.cos(e) ** -2), "counts once"),
    ("14.2", lambda r, u, e, b, s: r**2 / b * np.hypot(np.cos(u) ** -2, np.cos(e) ** -2), "sigma is missing"),
    ("14.3", lambda u, e, b: b / np.median(np.abs(slope(u, e))), "negative slope"),
    ("14.3", lambda u, e, b: b / np.median(np.tan(e - u)), "difference of the two tangents"),
    ("14.3", lambda u, e, b: 1 / np.median(slope(u, e)), "baseline is missing"),
    (
        "15.1",
        lambda a, b, p: np.where(np.isnan(a) & np.isnan(b), 0, p * circle(a, b) / 360),
        "One grey side is enough",
    ),
    ("15.1", lambda a, b, p: np.where(np.isnan(b), 0, p * circle(a, b) / 360), "observed object can be grey"),
    ("15.1", lambda a, b, p: np.where((a == np.nan) | (b == np.nan), 0, p * circle(a, b) / 360), "not NaN"),
    ("15.1", lambda a, b, p: np.nan_to_num(p * ((a - b) % 360) / 360), "one way around only"),
    ("15.2", lambda c, m, p: term(square(c), square(m), p), "root is missing"),
    ("15.2", lambda c, m, p: term(far(c), far(m), p).T, "other way round"),
    ("15.2", lambda c, m, p: p * np.maximum(np.abs(far(c)[:, None] - far(m)) / far(m), 0.1), "not the whole term"),
    ("15.3", in_place, "changes the array"),
    ("15.3", lambda cost: struck(cost, largest=False, rounds=min(cost.shape), blank=1), "strike out with 1"),
    ("15.3", lambda cost: struck(cost, largest=False, rounds=min(cost.shape) - 1, blank=np.inf), "too early"),
    ("16.1", svd_without_sign, "may be a mirror"),
    ("16.1", lambda s, m: complex_fit(s, m, add=1), "you add it"),
    ("16.1", full_circle, "from -pi to pi"),
    ("16.2", lambda s, m: np.hypot(*sums(s, m)[:2]) ** 2 / sums(s, m)[2], "root of the sum of squares"),
    ("16.2", lambda s, m: np.hypot(*sums(s, m)[:2]) / np.sqrt(sums(s, m)[2]), "without a root"),
    ("16.2", lambda s, m: 2 * np.hypot(*sums(s, m)[:2]) / sums(s, m)[2], "the twos cancel"),
    ("16.3", lambda s, m: np.argmax(far(s)), "farthest out"),
    ("16.3", lambda s, m: min(each(s, m)), "np.argmin"),
    ("16.3", lambda s, m: np.argmin(each(s, m)[:-1]), "never leave out the last"),
    ("17.1", lambda x, y, k, n: np.where(k - n < 2, -1, (n == 0) & (x <= 2) & (y <= 2)), "pairs *used*"),
    ("17.3", lambda n, q: 1 - (1 - q) ** n, "at least one"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("14.1", place),
    ("14.2", lambda r, u, e, b, s: r**2 * s / b * np.hypot(1 / np.cos(u) ** 2, 1 / np.cos(e) ** 2)),
    ("14.3", lambda u, e, b: 1 / np.median(slope(u, e) / b)),
    ("15.1", lambda a, b, p: np.nan_to_num(p * np.abs((a - b + 180) % 360 - 180) / 360)),
    ("15.2", lambda c, m, p: [[p * abs(one - other) / max(other, 0.1) for other in far(m)] for one in far(c)]),
    ("15.3", lambda cost: by_order(cost, np.argsort(cost, axis=None))),
    ("16.1", complex_fit),
    ("16.2", lambda s, m: math.sqrt(sums(s, m)[0] ** 2 + sums(s, m)[1] ** 2) / sums(s, m)[2]),
    ("16.3", lambda s, m: np.argmin(np.sqrt(each(s, m)))),
]
