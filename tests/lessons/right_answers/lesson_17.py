"""Right answers to lesson 17 by other ways than its solutions."""

import itertools
import math

import numpy as np


def by_moments(n_a, mean_a, std_a, n_b, mean_b, std_b):
    first = (n_a * mean_a + n_b * mean_b) / (n_a + n_b)
    second = (n_a * (std_a**2 + mean_a**2) + n_b * (std_b**2 + mean_b**2)) / (n_a + n_b)
    return first, math.sqrt(max(second - first**2, 0.0))


def by_listing(q):
    """Every case of seen and unseen."""
    cases = [case for case in itertools.product((0, 1), repeat=len(q)) if sum(case) < 2]
    return sum(math.prod(p if seen else 1 - p for p, seen in zip(q, case, strict=True)) for case in cases)


def by_recursion(q):
    """One object after the other: the chances of none and of one so far."""
    none, one = 1.0, 0.0
    for p in q:
        none, one = none * (1 - p), one * (1 - p) + none * p
    return none + one


def row_by_complex_numbers(found, true):
    d = (found - true)[~np.isnan(found[:, 0])]
    d = np.abs(np.column_stack([d[:, :2], np.degrees(np.angle(np.exp(1j * d[:, 2])))]))
    return np.concatenate([d.mean(axis=0), d.std(axis=0)])


def row_by_nan(found, true):
    """NaN functions leave unable poses out by themselves."""
    d = np.abs(found - true)
    d[:, 2] = np.degrees(np.abs(d[:, 2] - 2 * np.pi * np.round(d[:, 2] / (2 * np.pi))))
    return [*np.nanmean(d, axis=0), *np.nanstd(d, axis=0)]


RIGHT = [
    ("17.1", lambda *all: [-1 if u < 2 else int(not w and max(x, y) <= 2) for x, y, u, w in zip(*all, strict=True)]),
    ("17.1", lambda x, y, k, n: (k > 1) * ((n == 0) & (np.fmax(x, y) <= 2)) - 1.0 * (k <= 1)),
    ("17.2", by_moments),
    ("17.2", lambda *given: np.array(by_moments(*given), dtype=np.float32)),
    *[("17.3", way) for way in (by_listing, by_recursion)],
    *[("17.4", way) for way in (row_by_complex_numbers, row_by_nan)],
]
