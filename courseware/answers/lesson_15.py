"""Exercises of lesson 15: the hue term, the distance term, the repeated minimum with its margins, the centroid."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        np.minimum(apart, 360 - apart) => apart
        350 and 10 degrees are 20 degrees apart, not 340. Go around the circle the shorter way.
        np.nan_to_num( => (
        Grey has no hue. Where either side is NaN, the term is 0, not NaN.
        np.nan_to_num(p_h => np.where(np.isnan(hue_seen), 0, p_h
        np.nan_to_num(p_h => np.where(np.isnan(hue_seen) & np.isnan(hue_map), 0, p_h
        One grey side is enough, the observed object or the landmark: the term is 0 where *either* hue is NaN.
        np.minimum(apart, 360 - apart) => apart and also np.nan_to_num( => (
        Two things are missing: the shorter way around the circle, and 0 where a hue is NaN.
        p_h * =>
        The weight p_h is a factor: a larger weight must make the term larger.
        ... => return hue_term(np.nan_to_num(hue_seen), np.nan_to_num(hue_map), p_h)
        You turn grey into hue 0, which is red. Subtract first, then put 0 where the difference is NaN.
        np.minimum(apart, 360 - apart) => ((hue_seen - hue_map + 180) % 360 - 180)
        np.minimum(apart, 360 - apart) => (hue_seen - hue_map)
        np.minimum(apart, 360 - apart) => ((hue_map - hue_seen + 180) % 360 - 180)
        Your difference has a sign. A hue that is off to the other side must cost as much.
        np.minimum(apart, 360 - apart) => ((hue_seen - hue_map) % 360)
        The remainder by 360 goes one way around only: 10 and 350 become 20, but 350 and 10 become 340.
        / 360) => / 360, nan=p_h / 2)
        For grey you charge the largest cost. But nothing is known of its hue, so the term is 0.
    """),
    Exercise("15.2", distance_term, observed_and_mapped, cases={
        "a landmark at the centroid": lambda rng: (
            rng.uniform(-3, 3, (4, 2)), np.array([[2, 1.002], [2.5, 1], [1.5, 1], [2, 4], [2, -2]]), 1.5),
        "all observed in one place": lambda rng: (np.tile(rng.uniform(-3, 3, 2), (3, 1)), rng.uniform(0, 6, (5, 2)), 1),
    }, mistakes="""
        np.abs => np.positive
        That is eq. (1) as printed. But without the absolute value, it rewards an object that is too near.
        np.maximum(far_m, 0.1) => far_m
        This is right except for a landmark near the map's centroid. Divide by 0.1 m at least.
        np.abs => np.positive and also np.maximum(far_m, 0.1) => far_m
        Two things are missing: the absolute value, and the least divisor of 0.1 m.
        np.maximum(far_m, 0.1) => np.maximum(far_c[:, None], 0.1)
        You divide by the observed distance. Eq. (1) divides by the map's.
        / np.maximum(far_m, 0.1) =>
        That is the difference in metres. Eq. (1) takes it relative to |dx_m|.
        x_c - x_c.mean(axis=0) => x_c and also x_m - x_m.mean(axis=0) => x_m
        You measure from the origins. Subtract each side's own centroid first.
        x_c.mean(axis=0) => x_m.mean(axis=0)
        You took one centroid for both. x_c is in the body frame, so it has a centroid of its own.
        mean(axis=0) => mean()
        The centroid is a point. Take the mean over the points (axis 0), not over x and y.
        np.abs(far_c[:, None] - far_m) => np.linalg.norm((x_c - x_c.mean(0))[:, None] - x_m + x_m.mean(0), axis=2)
        You subtract vectors of two different frames. Take their lengths first, then the difference.
    """),
    Exercise("15.3", match_with_margins, costs, cases={
        "unlike classes": unlike_classes, "one row and one column": lambda rng: (np.array([[0.3]]),),
        "one row": lambda rng: (np.array([[0.2, 0.5, 0.4]]),),
    }, functions={
        least_sum: "That is the assignment with the least sum. The paper's search takes the cheapest: no way back.",
    }, mistakes="""
        return columns, margins => return columns, np.where(np.isinf(margins), np.nan, margins)
        Where no other column was open, the margin is inf. NaN is for rows without a column.
        table[i, :] = table[:, j] = np.inf => table[i, :] = np.inf and also min(cost.shape) => len(cost)
        Each row takes its own cheapest column, so two rows may take one column. It must be one-to-one.
        np.unravel_index(np.argmin(table), table.shape) => _, np.argmin(table[_])
        You serve the rows in their order. But the cheapest of *all* open combinations comes first.
        np.delete(table[i], j) => np.delete(cost[i], j)
        Your margins count columns that were taken before. Only open columns are a choice.
        initial=np.inf) - table[i, j] => initial=np.inf)
        That is the next best cost itself. How much dearer is it than the cost of the column that was taken?
        np.full(len(cost), np.nan) => np.zeros(len(cost))
        A row without a column has no margin, so it is NaN. A margin of 0 would mean that two columns cost the same.
        np.full(len(cost), -1) => np.zeros(len(cost), int)
        Rows that get no column must hold -1. Yours hold 0, which is a column.
        table[i, :] = table[:, j] => table[i, :]
        You strike out only the row or only the column, so a matched one is chosen again. Strike out both.
        min(cost.shape) => len(cost) and also - table[i, j] => - table[i, j] if np.isfinite(table[i, j]) else np.nan
        When all is struck out, argmin gives 0, and a row is matched once more. Stop when one side is used up.
        table[:, j] = np.inf => table[:, j] = 1000
        You strike out with a number that may be the least again. What is never the least?
    """),
    Exercise("15.4", centroid_shift, places_some_hidden, "challenge", cases={
        "as many as the map has": lambda rng: (rng.uniform(0, 6, (14, 2)), 2),
        "all but one hidden": lambda rng: (rng.uniform(0, 6, (5, 2)), 4),
    }, mistakes="""
        (n * (n - n_hidden)) => (n - n_hidden) ** 2 * (n - 1) / n
        You add the hidden ones as if they were independent. But no object is hidden twice, and that ties them.
        spread * n_hidden / (n * (n - n_hidden)) => spread * (n - 1) / n * (n_hidden / (n - n_hidden)) ** 2
        Yours lets all hidden ones lie on one side. They pull in different ways, so their mean is nearer.
        places - places.mean(axis=0) => places
        You take the squares from the origin. Only the places about their centroid count.
        n_hidden / (n * (n - n_hidden)) => (n - 1) / (n * (n - n_hidden))
        You draw as if with replacement, so yours moves even if nobody is hidden. But no object is seen twice.
        n_hidden / (n * (n - n_hidden)) => 1 / (n - n_hidden)
        The factor for drawing without replacement is missing: with nobody hidden, the centroid stays.
        / (n - 1) => / n
        Nearly. Two of the seen objects are never the same one, so their places are not independent.
        (n * (n - n_hidden)) => n**2
        You take the hidden ones away but divide by all n. The centroid of the seen is a mean over n - k.
        n_hidden / (n * (n - n_hidden)) => (n - n_hidden) / (n * n_hidden)
        You exchanged the seen and the hidden. With most objects seen, the centroid hardly moves.
    """),
]
