"""Right answers to lesson 10 by other ways than its solutions."""

from itertools import accumulate
from statistics import NormalDist

import numpy as np
from scipy.optimize import brentq

from courseware.lessons.lesson_10.adaptive_count import kld_count

ENOUGH = 10**6


def by_loops(free, cell, u):
    listed = [(r, c) for r in range(free.shape[0]) for c in range(free.shape[1]) if free[r, c]]
    chosen = [listed[int(a * len(listed))] for a in u[:, 0]]
    return [[cell * (c + x), cell * (r + y)] for (r, c), (_, x, y) in zip(chosen, u, strict=True)]


def means(scores, share):
    return np.array(list(accumulate(scores, lambda m, s: m if np.isnan(s) else share * s + (1 - share) * m)))


def by_while(bins, least):
    n, seen = 0, {}
    while n < len(bins) and n < kld_count(len(seen), least, ENOUGH):
        seen[int(bins[n])] = True
        n += 1
    return np.array([n])[0]


def near(a, b, metres, radians):
    turn = abs(a[2] - b[2]) % (2 * np.pi)
    return np.hypot(a[0] - b[0], a[1] - b[1]) < metres and min(turn, 2 * np.pi - turn) < radians


def by_striking_out(states, scores, *limits):
    left, kept = set(range(len(scores))), []
    while left:
        kept.append(best := max(left, key=lambda i: scores[i]))
        left -= {i for i in left if i == best or near(states[i], states[best], *limits)}
    return np.array(kept, dtype=np.int32)


def by_counting(bins, miss, probability):
    """Draw by draw; then the error by bisection of (10.3)."""
    least, empty, share = 0, 1.0, 2 / (9 * (bins - 1))
    while empty > miss * (1 + 1e-12):
        least, empty = least + 1, empty * (1 - 1 / bins)
    wanted = (bins - 1) / 2 * (1 - share + np.sqrt(share) * NormalDist().inv_cdf(probability)) ** 3
    return least, brentq(lambda error: wanted / error - least, 1e-9, 1e3, xtol=1e-12)


ANSWERS = {
    "10.1": [
        by_loops,
    ],
    "10.2": [
        lambda s, a, b: [float(max(0, (u - v) / u)) for v, u in zip(means(s, a), means(s, b), strict=True)],
    ],
    "10.3": [by_while],
    "10.4": [by_striking_out],
    "10.5": [by_counting],
}
RIGHT = [(number, answer) for number, answers in ANSWERS.items() for answer in answers]
