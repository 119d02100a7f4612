"""Right answers to lesson 18 by other ways than its solutions."""

import math

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.stats import multivariate_normal


def colour(a, s, b, t):
    hue = (np.abs((a - b + 180) % 360 - 180) / np.maximum(600 / np.minimum(s, t), 12.0)) ** 2 / 2
    return np.minimum(np.where(np.isnan(hue), 0, hue) + (s - t) ** 2 / 450, 3.0)


def colour_by_loop(*given):
    costs = []
    for a, s, b, t in zip(*given, strict=True):
        cost = (s - t) ** 2 / 450
        if not (math.isnan(a) or math.isnan(b)):
            cost += min(abs(a - b), 360 - abs(a - b)) ** 2 / (2 * max(600 / min(s, t), 12) ** 2)
        costs.append(min(cost, 3))
    return costs


def complex_pose(seen, landmarks):
    """The turn is a quotient of length 1."""
    z, m = seen @ [1, 1j], landmarks @ [1, 1j]
    turn = (m[1] - m[0]) / (z[1] - z[0])
    t = m.mean() - turn / abs(turn) * z.mean()
    return t.real, t.imag, np.angle(turn)


def padded(cost):
    """A column of its own for every row, in which it stays unmatched at no cost."""
    i, j = linear_sum_assignment(np.hstack([cost, np.where(np.eye(len(cost)) > 0, 0.0, 1e6)]))
    return np.where(j < cost.shape[1], j, -1)[np.argsort(i)]


def by_sorting(confidence, right, max_wrong):
    """Down the sorted list, looked at only where the next confidence is another one."""
    order = sorted(range(len(confidence)), key=lambda k: -confidence[k])
    best, wrong = 0.0, 0
    for n, k in enumerate(order, start=1):
        wrong += not right[k]
        is_last = n == len(order) or confidence[order[n]] != confidence[k]
        if is_last and confidence[k] > 0 and wrong <= max_wrong * n:
            best = n / len(order)
    return best


def every_threshold(confidence, right, max_wrong):
    given = [confidence >= threshold for threshold in confidence if threshold > 0]
    return np.float32(max((one.mean() for one in given if 1 - right[one].mean() <= max_wrong), default=0))


def by_the_cost(S, p, clutter, e, g):
    """(18.2) as it stands, its sign changed."""
    size = np.linalg.slogdet(S)[1] / 2 + S.shape[1] * np.log(2 * np.pi) / 2 + np.log(clutter)
    cost = size[:, None] - np.log(e / g[:, None]) - np.log(p / (1 - p))
    return [[math.sqrt(-2 * one) if one < 0 else 0.0 for one in row] for row in cost]


def by_densities(S, p, clutter, e, g):
    peak = np.array([multivariate_normal.pdf(np.zeros(S.shape[1]), cov=one) for one in S])
    odds = np.outer(peak, p) * e / np.outer(clutter * g, 1 - p)
    return np.sqrt(np.log(np.where(odds > 1, odds, 1) ** 2))


RIGHT = [
    ("18.1", colour_by_loop),
    ("18.2", complex_pose),
    ("18.3", padded),
    ("18.4", by_sorting),
    ("18.5", by_densities),
]
