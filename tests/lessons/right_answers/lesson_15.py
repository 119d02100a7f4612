"""Right answers to lesson 15 by other ways than its solutions."""

import itertools
import math

import numpy as np


def by_angles(a, b, p):
    return np.nan_to_num(p * np.arccos(np.clip(np.cos(np.deg2rad(a - b)), -1, 1)) / (2 * np.pi))


def far(points):
    return np.hypot(*(points - sum(points) / len(points)).T)


def with_margins(cost, choices):
    found, margins = [-1] * len(cost), [math.nan] * len(cost)
    for i, j, left in choices(cost):
        found[i], margins[i] = j, min(cost[i, left], default=math.inf) - cost[i, j]
    return found, margins


def by_lists(cost):
    rows, columns = (list(range(n)) for n in cost.shape)
    while rows and columns:
        _, i, j = min((cost[i, j], i, j) for i in rows for j in columns)
        rows.remove(i)
        columns.remove(j)
        yield i, j, columns


def by_sorting(cost):
    rows, columns = (set(range(n)) for n in cost.shape)
    for i, j in zip(*np.unravel_index(np.argsort(cost, axis=None), cost.shape), strict=True):
        if i in rows and j in columns:
            rows, columns = rows - {i}, columns - {j}
            yield i, j, list(columns)


def by_masks(cost):
    table = np.ma.masked_array(cost, np.zeros(cost.shape, bool))
    while not table.mask.all():
        i, j = np.unravel_index(table.argmin(), table.shape)
        table.mask[:, j] = True
        yield i, j, np.flatnonzero(~table.mask[i])
        table.mask[i] = True


def by_listing(places, k):
    seen = itertools.combinations(places - places.mean(axis=0), len(places) - k)
    return math.sqrt(np.mean([np.sum(np.mean(one, axis=0) ** 2) for one in seen]))


RIGHT = [
    ("15.1", by_angles),
    ("15.1", lambda a, b, p: np.nan_to_num(p * np.abs((a - b + 180) % 360 - 180) / 360)),
    ("15.1", lambda *given: [float(by_angles(a, b, given[2])) for a, b in zip(*given[:2], strict=True)]),
    ("15.2", lambda c, m, p: [[p * abs(a - b) / max(b, 0.1) for b in far(m)] for a in far(c)]),
    ("15.2", lambda c, m, p: np.float32(p * np.abs(far(c)[:, None] - far(m)) / np.maximum(far(m), 0.1))),
    *[("15.3", lambda cost, way=way: with_margins(cost, way)) for way in (by_lists, by_sorting)],
    ("15.3", lambda cost: tuple(np.array(one) for one in with_margins(cost, by_masks))),
    ("15.4", by_listing),
    ("15.4", lambda s, k: [np.sqrt(np.cov(s.T).trace() * (1 / (len(s) - k) - 1 / len(s)))]),
]
