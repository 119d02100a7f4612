"""Right answers to lesson 18 by other ways than its solutions."""

import math

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.stats import multivariate_normal

from course_lib.spherical_stereo import fit_rigid_2d


def colour(a, s, b, t):
    sigma = np.maximum(600 / np.minimum(s, t), 12.0)
    hue = (np.abs((a - b + 180) % 360 - 180) / sigma) ** 2 / 2
    return np.minimum(np.where(np.isnan(hue), 0, hue) + (s - t) ** 2 / 450, 3.0)


def colour_by_loop(a, s, b, t):
    costs = []
    for one, p, other, q in zip(a, s, b, t, strict=True):
        cost = (p - q) ** 2 / 450
        if not (math.isnan(one) or math.isnan(other)):
            apart = min(abs(one - other), 360 - abs(one - other))
            cost += apart**2 / (2 * max(600 / min(p, q), 12) ** 2)
        costs.append(min(cost, 3))
    return costs


def complex_pose(seen, landmarks):
    """With complex numbers: the turn is a quotient of length 1."""
    z, m = seen @ [1, 1j], landmarks @ [1, 1j]
    turn = (m[1] - m[0]) / (z[1] - z[0])
    turn /= abs(turn)
    t = m.mean() - turn * z.mean()
    return t.real, t.imag, np.angle(turn)


def padded(cost):
    """A column of its own for every row, in which it stays unmatched at no cost."""
    n, m = cost.shape
    i, j = linear_sum_assignment(np.hstack([cost, np.where(np.eye(n) > 0, 0.0, 1e6)]))
    return np.where(j < m, j, -1)[np.argsort(i)]


def by_sorting(confidence, right, max_wrong):
    """Down the sorted list, looked at only where the next confidence is another one."""
    order = sorted(range(len(confidence)), key=lambda k: -confidence[k])
    best, wrong = 0.0, 0
    for n, k in enumerate(order, start=1):
        if confidence[k] == 0:
            break
        wrong += not right[k]
        last = n == len(order) or confidence[order[n]] != confidence[k]
        if last and wrong <= max_wrong * n:
            best = n / len(order)
    return best


def every_threshold(confidence, right, max_wrong):
    given = [confidence >= threshold for threshold in confidence if threshold > 0]
    allowed = [np.mean(one) for one in given if 1 - np.mean(right[one]) <= max_wrong]
    return np.float32(max(allowed, default=0))


def by_the_cost(S, p, clutter, e, g):
    """(18.2) as it stands, its sign changed."""
    k, log_size = S.shape[1], np.linalg.slogdet(S)[1]
    cost = (
        (log_size + k * np.log(2 * np.pi))[:, None] / 2 + np.log(clutter) - np.log(e / g[:, None]) - np.log(p / (1 - p))
    )
    return [[math.sqrt(-2 * one) if one < 0 else 0.0 for one in row] for row in cost]


def by_densities(S, p, clutter, e, g):
    peak = np.array([multivariate_normal.pdf(np.zeros(S.shape[1]), cov=one) for one in S])
    odds = np.outer(peak, p) * e / np.outer(clutter * g, 1 - p)
    return np.sqrt(np.log(np.where(odds > 1, odds, 1) ** 2))


RIGHT = [
    ("18.1", colour),
    ("18.1", colour_by_loop),
    ("18.1", lambda *given: colour(*(np.float32(one) for one in given))),
    ("18.2", complex_pose),
    ("18.2", fit_rigid_2d),
    ("18.2", lambda s, m: np.array(complex_pose(s, m))),
    ("18.2", lambda s, m: list(complex_pose(s.astype(np.float32), m.astype(np.float32)))),
    ("18.3", padded),
    ("18.3", lambda cost: padded(cost).astype(np.float32)),
    ("18.4", by_sorting),
    ("18.4", every_threshold),
    ("18.5", by_the_cost),
    ("18.5", by_densities),
]
