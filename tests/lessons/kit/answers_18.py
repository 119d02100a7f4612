"""Answers that students may give to lesson 18, for test_exercise_answers.py."""

import itertools
import math

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.spherical_stereo import fit_rigid_2d

PI = np.pi


def circle(a, b):
    return np.abs((a - b + 180) % 360 - 180)


def colour(a, s, b, t, hue=circle, least=np.minimum, floor=12.0, most=3.0, spread=15.0):
    sigma = np.maximum(600 / least(s, t), floor)
    return np.minimum(np.nan_to_num((hue(a, b) / sigma) ** 2 / 2) + ((s - t) / spread) ** 2 / 2, most)


def colour_by_loop(a, s, b, t):
    costs = []
    for one, p, other, q in zip(a, s, b, t, strict=True):
        cost = (p - q) ** 2 / 450
        if not (math.isnan(one) or math.isnan(other)):
            apart = min(abs(one - other), 360 - abs(one - other))
            cost += apart**2 / (2 * max(600 / min(p, q), 12) ** 2)
        costs.append(min(cost, 3))
    return costs


def complex_pose(seen, landmarks, add=-1, centred=True):
    """The pose with complex numbers: the turn is a quotient of length 1."""
    z, m = seen @ [1, 1j], landmarks @ [1, 1j]
    turn = (m[1] - m[0]) / (z[1] - z[0])
    turn /= abs(turn)
    t = m.mean() + add * turn * z.mean() if centred else m[0] - turn * z[0]
    return t.real, t.imag, np.angle(turn)


def scaled_pose(seen, landmarks):
    """With a scale, as in Umeyama's full method."""
    z, m = seen @ [1, 1j], landmarks @ [1, 1j]
    turn = (m[1] - m[0]) / (z[1] - z[0])
    t = m.mean() - turn * z.mean()
    return t.real, t.imag, np.angle(turn)


def half_a_turn_off(seen, landmarks):
    x, y, theta = complex_pose(seen[::-1], landmarks)
    return x, y, theta


def columns_of(pairs, n):
    result = np.full(n, -1)
    for i, j in pairs:
        result[i] = j
    return result


def padded(cost):
    """A column of its own for every row, in which it stays unmatched at no cost."""
    n, m = cost.shape
    i, j = linear_sum_assignment(np.hstack([cost, np.where(np.eye(n) > 0, 0.0, 1e6)]))
    return np.where(j < m, j, -1)[np.argsort(i)]


def by_trying(cost):
    """Every choice of columns, -1 as often as one likes."""
    n, m = cost.shape
    best, chosen = 0.0, [-1] * n
    for size in range(1, min(n, m) + 1):
        for rows in itertools.combinations(range(n), size):
            for columns in itertools.permutations(range(m), size):
                total = sum(cost[i, j] for i, j in zip(rows, columns, strict=True))
                if total < best:
                    best, chosen = total, [-1] * n
                    for i, j in zip(rows, columns, strict=True):
                        chosen[i] = j
    return chosen


def dropped_afterwards(cost):
    return columns_of([(i, j) for i, j in zip(*linear_sum_assignment(cost), strict=True) if cost[i, j] <= 0], len(cost))


def by_order(cost):
    pairs, rows, columns = [], set(), set()
    for k in np.argsort(cost, axis=None):
        i, j = divmod(int(k), cost.shape[1])
        if cost[i, j] < 0 and i not in rows and j not in columns:
            pairs.append((i, j))
            rows.add(i)
            columns.add(j)
    return columns_of(pairs, len(cost))


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


def of_answered(confidence, right, max_wrong):
    """Thresholds on a fixed grid."""
    best = 0.0
    for threshold in (0.5, 0.8):
        given = confidence >= threshold
        if given.any() and np.mean(~right[given]) <= max_wrong:
            best = max(best, given.mean())
    return best


def strictly_above(confidence, right, max_wrong):
    best = 0.0
    for threshold in np.unique(confidence):
        given = confidence > threshold
        if given.any() and np.mean(~right[given]) <= max_wrong:
            best = max(best, given.mean())
    return best


def bitwise_not_of_integers(confidence, right, max_wrong):
    best = 0.0
    for threshold in np.unique(confidence[confidence > 0]):
        given = confidence >= threshold
        if 1 - np.mean(right[given]) <= max_wrong:
            best = max(best, np.mean(given))
    return np.float32(best)


# Exercise, answer, words of the hint that must come.
WRONG = [
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, hue=lambda x, y: x - y), "shorter way"),
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, hue=lambda x, y: (x - y) % 360), "one way around only"),
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, least=np.maximum), "greater saturation"),
    (
        "18.1",
        lambda a, s, b, t: colour(a, s, b, t, least=lambda x, y: np.min([x.min(), y.min()])),
        "element by element",
    ),
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, floor=0.0), "never below 12"),
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, most=np.inf), "at most 3"),
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, spread=1.0), "15 percent"),
    ("18.1", lambda a, s, b, t: np.where(np.isnan(a + b), 0, colour(a, s, b, t)), "saturation still counts"),
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, spread=np.inf), "saturation's own term"),
    ("18.1", lambda a, s, b, t: colour(a, s, b, t, spread=15**0.5), "are squared, too"),
    ("18.2", lambda s, m: complex_pose(s, m, add=1), "yours adds it"),
    ("18.2", lambda s, m: complex_pose(s, m, centred=False), "second takes the whole error"),
    ("18.2", half_a_turn_off, "first observation on the second landmark"),
    ("18.2", scaled_pose, "may stretch"),
    ("18.2", lambda s, m: complex_pose(s, m)[:2], "Return 3 values"),
    ("18.2", lambda s, m: (*m.mean(axis=0), complex_pose(s, m)[2]), "middle of the landmarks"),
    ("18.2", lambda s, m: complex_pose(m, s), "seen from the robot"),
    ("18.3", dropped_afterwards, "drop the dear pairs afterwards"),
    ("18.3", by_order, "repeated minimum"),
    ("18.3", lambda cost: linear_sum_assignment(np.minimum(cost, 0))[1], "shape"),
    ("18.3", lambda cost: [j if j >= 0 else np.nan for j in padded(cost)], "NaN"),
    ("18.3", lambda cost: list(zip(*linear_sum_assignment(np.minimum(cost, 0)), strict=True)), "shape"),
    ("18.3", lambda cost: np.where(padded(cost) < 0, 0, padded(cost)), "-1"),
    ("18.4", strictly_above, "is the threshold itself"),
    ("18.4", of_answered, "which case is left out?"),
    ("18.4", lambda c, r, w: 1 - by_sorting(c, r, w), "*not* answered"),
    ("18.4", lambda c, r, w: by_sorting(c, r, w) * len(c), "number of poses"),
    ("18.4", lambda c, r, w: by_sorting(c, r, 0.25), "which case is left out?"),
    ("18.4", lambda c, r, w: np.mean((c > 0) & r), "You count the right ones"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("18.1", colour),
    ("18.1", colour_by_loop),
    ("18.1", lambda a, s, b, t: colour(*(np.float32(one) for one in (a, s, b, t)))),
    ("18.2", complex_pose),
    ("18.2", lambda s, m: fit_rigid_2d(s, m)),
    ("18.2", lambda s, m: np.array(complex_pose(s, m))),
    ("18.2", lambda s, m: list(complex_pose(s.astype(np.float32), m.astype(np.float32)))),
    ("18.3", padded),
    ("18.3", lambda cost: padded(cost).astype(np.float32)),
    ("18.4", by_sorting),
    ("18.4", bitwise_not_of_integers),
]
