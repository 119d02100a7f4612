"""Exercises of lesson 15: the hue term, the distance term, the repeated minimum with its margins, the centroid."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from courseware.lessons.kit.exercise import Exercise


def hue_term(hue_seen, hue_map, p_h):
    """Hue term (n,) of eq. (1), on the circle; 0 where either hue is NaN."""
    # The shorter way around, and 0 where there is no hue.
    apart = np.abs(hue_seen - hue_map)
    return np.nan_to_num(p_h * np.minimum(apart, 360 - apart) / 360)


def hues(rng: np.random.Generator) -> tuple:
    """Return hues, some of them near the wrap from both sides, some grey on one side or on both."""
    n = int(rng.integers(5, 9))
    seen, on_map = rng.uniform(0, 360, n), rng.uniform(0, 360, n)
    seen[:2], on_map[:2] = rng.uniform([350, 0], [360, 10]), rng.uniform([0, 350], [10, 360])
    seen[2], on_map[3] = np.nan, np.nan
    if rng.random() < 0.3:
        on_map[2] = np.nan
    return seen, on_map, rng.uniform(0.5, 3)


def distance_term(x_c, x_m, p_d):
    """Distance term (n, m) of eq. (1) with absolute value; the divisor is at least 0.1 m."""
    # Lengths first, then a column against a row.
    far_c = np.linalg.norm(x_c - x_c.mean(axis=0), axis=1)
    far_m = np.linalg.norm(x_m - x_m.mean(axis=0), axis=1)
    return p_d * np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)


def observed_and_mapped(rng: np.random.Generator) -> tuple:
    """Return observed points and a map. In half of the inputs, one landmark stands at the centroid."""
    n, m = int(rng.integers(2, 5)), int(rng.integers(5, 8))
    x_m = rng.uniform(0, 6, (m, 2))
    if rng.random() < 0.5:
        x_m[-1] = x_m[:-1].mean(axis=0) + rng.uniform(-0.02, 0.02, 2)
    return rng.uniform(-3, 3, (n, 2)), x_m, rng.uniform(0.5, 3)


def match_with_margins(cost):
    """For every row of cost (n, m) its column (n,), -1 for none, and its margin (n,): repeated minimum."""
    # Take the least, compare with the row's next best, strike out row and column, repeat.
    table, columns, margins = np.array(cost, dtype=float), np.full(len(cost), -1), np.full(len(cost), np.nan)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(np.argmin(table), table.shape)
        columns[i], margins[i] = j, np.min(np.delete(table[i], j), initial=np.inf) - table[i, j]
        table[i, :] = table[:, j] = np.inf
    return columns, margins


def costs(rng: np.random.Generator) -> tuple:
    """Return a wide, high or square table with some negative costs. Its rows compete, or no order would matter."""
    n, m = int(rng.integers(3, 7)), int(rng.integers(3, 7))
    return (rng.uniform(-0.2, 1, (n, 1)) + rng.uniform(0, 1, (1, m)) + 0.6 * rng.uniform(-1, 1, (n, m)),)


def unlike_classes(rng: np.random.Generator) -> tuple:
    """Return a table with 1000 more between classes, as in the lesson, where one class has a column too few."""
    (cost,) = costs(rng)
    cost = np.vstack([cost, cost[:1] + 0.05])
    unlike = rng.random((len(cost), 1)) < 0.5
    unlike[:2] = [[True], [False]]
    return (cost + 1000 * (unlike != (rng.random((1, cost.shape[1])) < 0.5)),)


def least_sum(cost):
    columns, margins = np.full(len(cost), -1), np.full(len(cost), np.nan)
    for i, j in zip(*linear_sum_assignment(cost), strict=True):
        columns[i], margins[i] = j, np.min(np.delete(cost[i], j), initial=np.inf) - cost[i, j]
    return columns, margins


def centroid_shift(places, n_hidden):
    """Root mean square distance [m] of the centroid of the seen places from that of all places (n, 2)."""
    # The variance of a mean drawn without replacement, x and y together.
    n = len(places)
    spread = np.sum((places - places.mean(axis=0)) ** 2) / (n - 1)
    return np.sqrt(spread * n_hidden / (n * (n - n_hidden)))


def places_some_hidden(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 12))
    return rng.uniform(0, 6, (n, 2)), int(rng.integers(1, n - 1))


# fmt: off
EXERCISES = [
    Exercise("15.1", hue_term, hues, "warm-up", cases={
        "ends of the circle, opposite hues, both grey": lambda rng: (
            np.array([0, 360, 0, 180, 90, 270, np.nan]), np.array([0, 0, 360, 0, 270, 90, np.nan]), 1.5),
    }, example=(([350], [10], 1), [0.056])),
    Exercise("15.2", distance_term, observed_and_mapped, cases={
        "a landmark at the centroid": lambda rng: (
            rng.uniform(-3, 3, (4, 2)), np.array([[2, 1.002], [2.5, 1], [1.5, 1], [2, 4], [2, -2]]), 1.5),
        "all observed in one place": lambda rng: (np.tile(rng.uniform(-3, 3, 2), (3, 1)), rng.uniform(0, 6, (5, 2)), 1),
    }),
    Exercise("15.3", match_with_margins, costs, cases={
        "unlike classes": unlike_classes, "one row and one column": lambda rng: (np.array([[0.3]]),),
        "one row": lambda rng: (np.array([[0.2, 0.5, 0.4]]),),
    }, functions={
        least_sum: "That is the assignment with the least sum. The paper's search takes the cheapest: no way back.",
    }, example=(([[1.0, 2.0], [0.0, 5.0], [3.0, 4.0]],), ([1, 0, -1], [np.inf, 5, np.nan]))),
    Exercise("15.4", centroid_shift, places_some_hidden, "challenge", cases={
        "as many as the map has": lambda rng: (rng.uniform(0, 6, (14, 2)), 2),
        "all but one hidden": lambda rng: (rng.uniform(0, 6, (5, 2)), 4),
    }),
]
