"""Right answers to lesson 15 by other ways than its solutions."""

import itertools
import math

import numpy as np


def circle(a, b):
    return np.minimum(np.abs(a - b), 360 - np.abs(a - b))


def by_angles(seen, on_map, p_h):
    turn = np.deg2rad(seen - on_map)
    return np.nan_to_num(p_h * np.arccos(np.clip(np.cos(turn), -1, 1)) / (2 * np.pi))


def far(points):
    return np.hypot(*(points - sum(points) / len(points)).T)


def in_single_precision(x_c, x_m, p_d):
    return (p_d * np.abs(far(x_c)[:, None] - far(x_m)) / np.maximum(far(x_m), 0.1)).astype(np.float32)


def margins_by_lists(cost):
    """Lists of what is open, and plain loops."""
    n, m = cost.shape
    rows, columns, found, margins = list(range(n)), list(range(m)), [-1] * n, [math.nan] * n
    while rows and columns:
        _, i, j = min((cost[i, j], i, j) for i in rows for j in columns)
        found[i] = j
        margins[i] = min((cost[i, k] for k in columns if k != j), default=math.inf) - cost[i, j]
        rows.remove(i)
        columns.remove(j)
    return found, margins


def margins_by_sorting(cost):
    """Along the sorted list of all combinations."""
    found, margins, taken = np.full(len(cost), -1), np.full(len(cost), np.nan), set()
    for k in np.argsort(cost, axis=None):
        i, j = divmod(int(k), cost.shape[1])
        if found[i] < 0 and j not in taken:
            taken.add(j)
            left = [c for c in range(cost.shape[1]) if c not in taken]
            found[i], margins[i] = j, (cost[i, left].min() if left else np.inf) - cost[i, j]
    return found, margins


def masked_margins(cost):
    table = np.ma.masked_array(cost, np.zeros(cost.shape, bool))
    found, margins = np.full(len(cost), -1), np.full(len(cost), np.nan)
    while not table.mask.all():
        i, j = np.unravel_index(table.argmin(), table.shape)
        found[i], least = j, table[i, j]
        table.mask[i, j] = True
        margins[i] = np.inf if table.mask[i].all() else table[i].min() - least
        table.mask[i], table.mask[:, j] = True, True
    return found, margins


def shift_by_listing(places, n_hidden):
    """Every choice of those seen."""
    seen = itertools.combinations(range(len(places)), len(places) - n_hidden)
    return math.sqrt(np.mean([np.sum((places[list(k)].mean(axis=0) - places.mean(axis=0)) ** 2) for k in seen]))


def shift_by_pairs(places, n_hidden):
    """The spread from the distances between places."""
    n = len(places)
    spread = np.sum((places[:, None] - places) ** 2) / (2 * n * (n - 1))
    return np.array([np.sqrt(spread * (1 / (n - n_hidden) - 1 / n))])


RIGHT = [
    ("15.1", by_angles),
    ("15.1", lambda a, b, p: np.nan_to_num(p * np.abs((a - b + 180) % 360 - 180) / 360)),
    ("15.1", lambda a, b, p: [0 if x != x or y != y else p * circle(x, y) / 360 for x, y in zip(a, b, strict=True)]),
    ("15.2", lambda c, m, p: [[p * abs(a - b) / max(b, 0.1) for b in far(m)] for a in far(c)]),
    ("15.2", in_single_precision),
    ("15.3", margins_by_lists),
    ("15.3", margins_by_sorting),
    ("15.3", masked_margins),
    ("15.4", shift_by_listing),
    ("15.4", shift_by_pairs),
]
