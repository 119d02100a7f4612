"""Exercises of lesson 15: the hue term on the circle, the distance term as a table, the repeated minimum."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 15.1: the hue term


def hue_term(hue_seen: np.ndarray, hue_map: np.ndarray, p_h: float) -> np.ndarray:
    """p_h dh / 360 (n,), dh on the circle; 0 where either hue is NaN (grey)."""
    return np.nan_to_num(p_h * _on_circle(hue_seen, hue_map) / 360)


def _on_circle(hue_seen: np.ndarray, hue_map: np.ndarray) -> np.ndarray:
    apart = np.abs(hue_seen - hue_map)
    return np.minimum(apart, 360 - apart)


def _hues(rng: np.random.Generator) -> tuple:
    """Hues, some of them near the wrap from both sides, some grey on one side or on both."""
    n = int(rng.integers(5, 9))
    seen, on_map = rng.uniform(0, 360, n), rng.uniform(0, 360, n)
    seen[:2], on_map[:2] = rng.uniform([350, 0], [360, 10]), rng.uniform([0, 350], [10, 360])
    seen[2] = np.nan
    on_map[3] = np.nan
    if rng.random() < 0.3:
        on_map[2] = np.nan
    return seen, on_map, rng.uniform(0.5, 3)


# 15.2: the distance term


def distance_term(x_c: np.ndarray, x_m: np.ndarray, p_d: float) -> np.ndarray:
    """p_d | |dx_c| - |dx_m| | / max(|dx_m|, 0.1), (n, m), each distance to the centroid of its own side."""
    far_c, far_m = _far(x_c), _far(x_m)
    return p_d * np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)


def _far(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points - points.mean(axis=0), axis=1)


def _points(rng: np.random.Generator) -> tuple:
    """Observed points and a map of which, in half of the inputs, one landmark stands at the centroid."""
    n, m = int(rng.integers(2, 5)), int(rng.integers(5, 8))
    x_m = rng.uniform(0, 6, (m, 2))
    if rng.random() < 0.5:
        x_m[-1] = x_m[:-1].mean(axis=0) + rng.uniform(-0.02, 0.02, 2)
    return rng.uniform(-3, 3, (n, 2)), x_m, rng.uniform(0.5, 3)


def _distance(change: Callable) -> Callable:
    """A mistake: the term computed as `change(far_c (n, 1), far_m (m,))` says."""

    def mistaken(x_c, x_m, p_d):
        with np.errstate(divide="ignore", invalid="ignore"):
            return p_d * change(_far(x_c)[:, None], _far(x_m))

    return mistaken


def _from_the_origins(x_c, x_m, p_d):
    far_c, far_m = np.linalg.norm(x_c, axis=1), np.linalg.norm(x_m, axis=1)
    return p_d * np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)


def _one_centroid(x_c, x_m, p_d):
    centroid = x_m.mean(axis=0)
    far_c, far_m = np.linalg.norm(x_c - centroid, axis=1), np.linalg.norm(x_m - centroid, axis=1)
    return p_d * np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)


def _of_vectors(x_c, x_m, p_d):
    dx_c, dx_m = x_c - x_c.mean(axis=0), x_m - x_m.mean(axis=0)
    return p_d * np.linalg.norm(dx_c[:, None] - dx_m, axis=-1) / np.maximum(np.linalg.norm(dx_m, axis=1), 0.1)


def _from_lengths(far: Callable) -> Callable:
    """A mistake: the term from `far(points (n, 2))` in place of the distances to the centroid."""
    return lambda x_c, x_m, p_d: p_d * np.abs(far(x_c)[:, None] - far(x_m)) / np.maximum(far(x_m), 0.1)


# 15.3: the repeated minimum


def match_greedily(cost: np.ndarray) -> np.ndarray:
    """For every row of cost (n, m) the column it is matched to (n,), -1 for none: cheapest first, one-to-one."""
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(np.argmin(open_cost), cost.shape)
        columns[i] = j
        open_cost[i], open_cost[:, j] = np.inf, np.inf
    return columns


def _costs(rng: np.random.Generator) -> tuple:
    """Tables, wide, high and square, with some negative costs; rows compete, or no order would matter."""
    n, m = int(rng.integers(3, 7)), int(rng.integers(3, 7))
    return (rng.uniform(-0.2, 1, (n, 1)) + rng.uniform(0, 1, (1, m)) + 0.6 * rng.uniform(-1, 1, (n, m)),)


def _row_by_row(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for i in range(min(cost.shape)):
        columns[i] = np.argmin(open_cost[i])
        open_cost[:, columns[i]] = np.inf
    return columns


def _best_sum(cost):
    columns = np.full(len(cost), -1)
    rows, chosen = linear_sum_assignment(cost)
    columns[rows] = chosen
    return columns


def _rows_stay_open(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(np.argmin(open_cost), cost.shape)
        columns[i] = j
        open_cost[:, j] = np.inf
    return columns


def _columns_stay_open(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(np.argmin(open_cost), cost.shape)
        columns[i] = j
        open_cost[i] = np.inf
    return columns


def _too_many_rounds(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for _ in range(len(cost)):
        i, j = np.unravel_index(np.argmin(open_cost), cost.shape)
        columns[i] = j
        open_cost[i], open_cost[:, j] = np.inf, np.inf
    return columns


def _struck_with_zero(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(np.argmin(open_cost), cost.shape)
        columns[i] = j
        open_cost[i], open_cost[:, j] = 0, 0
    return columns


def _rounds(cost, rounds: int, struck: float = np.inf):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for _ in range(rounds):
        i, j = np.unravel_index(np.argmin(open_cost), cost.shape)
        columns[i] = j
        open_cost[i], open_cost[:, j] = struck, struck
    return columns


def _while_positive(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    while 0 < open_cost.min() < np.inf:
        i, j = np.unravel_index(np.argmin(open_cost), cost.shape)
        columns[i] = j
        open_cost[i], open_cost[:, j] = np.inf, np.inf
    return columns


def _numbers_move_up(cost):
    open_cost, columns = cost, np.full(len(cost), -1)
    for _ in range(min(cost.shape)):
        i, j = np.unravel_index(np.argmin(open_cost), open_cost.shape)
        columns[i] = j
        open_cost = np.delete(np.delete(open_cost, i, axis=0), j, axis=1)
    return columns


def _column_by_column(cost):
    open_cost, columns = cost.copy(), np.full(len(cost), -1)
    for j in range(min(cost.shape)):
        i = np.argmin(open_cost[:, j])
        columns[i] = j
        open_cost[i] = np.inf
    return columns


def _each_other_s_best(cost):
    best = np.argmin(cost, axis=1)
    return np.where(np.argmin(cost, axis=0)[best] == np.arange(len(cost)), best, -1)


EXERCISES = [
    Exercise(
        number="15.1",
        reference=hue_term,
        inputs=_hues,
        mistakes=(
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * np.abs(seen - on_map) / 360),
                "350 and 10 degrees are 20 degrees apart, not 340: go around the circle the shorter way.",
            ),
            Mistake(
                lambda seen, on_map, p_h: p_h * _on_circle(seen, on_map) / 360,
                "Grey has no hue: where either side is NaN the term is 0, not NaN.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.where(np.isnan(seen), 0, p_h * _on_circle(seen, on_map) / 360),
                "A landmark can be grey, too: the term is 0 where *either* hue is NaN.",
            ),
            Mistake(
                lambda seen, on_map, p_h: p_h * np.abs(seen - on_map) / 360,
                "Two things are missing: the shorter way around the circle, and 0 where a hue is NaN.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * _on_circle(seen, on_map) / 180),
                "You divide by 180. That is the better scale, but eq. (1) divides by 360.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(_on_circle(seen, on_map) / 360),
                "The weight p_h is missing.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * _on_circle(seen, on_map)),
                "The division by 360 is missing.",
            ),
            Mistake(
                lambda seen, on_map, p_h: hue_term(np.nan_to_num(seen), np.nan_to_num(on_map), p_h),
                "You turn grey into hue 0, which is red. First the difference, then 0 where it is NaN.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * (((seen - on_map) + 180) % 360 - 180) / 360),
                "Your difference has a sign. A hue that is off to the other side must cost as much.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * (seen - on_map) / 360),
                "Your difference has a sign, and may go the long way. Take its absolute value, then the shorter way.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * (np.abs(seen - on_map) % 180) / 360),
                "The remainder by 180 makes opposite colours alike. Take the lesser of apart and 360 - apart.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * _on_circle(seen, on_map) / 360, nan=p_h),
                "You let grey cost the most there is. Nothing is known of its hue, so nothing is held against it: 0.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.where(np.isnan(on_map), 0, p_h * _on_circle(seen, on_map) / 360),
                "An observed object can be grey, too: the term is 0 where *either* hue is NaN.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.where(
                    np.isnan(seen) & np.isnan(on_map), 0, p_h * _on_circle(seen, on_map) / 360
                ),
                "One grey side is enough: the term is 0 where *either* hue is NaN, not only where both are.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(
                    p_h * np.maximum(np.abs(seen - on_map), 360 - np.abs(seen - on_map)) / 360
                ),
                "You go the longer way around the circle. np.minimum takes the shorter one.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(p_h * ((seen - on_map) % 360) / 360),
                "The remainder by 360 goes one way around only: 10 and 350 become 20, but 350 and 10 become 340.",
            ),
            Mistake(
                lambda seen, on_map, p_h: np.nan_to_num(_on_circle(seen, on_map) / 360 / p_h),
                "You divide by p_h. A larger weight must make the term larger.",
            ),
        ),
    ),
    Exercise(
        number="15.2",
        reference=distance_term,
        inputs=_points,
        mistakes=(
            Mistake(
                _distance(lambda far_c, far_m: (far_c - far_m) / np.maximum(far_m, 0.1)),
                "As printed in the paper, but without the absolute value an object too near is rewarded.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: np.abs(far_c - far_m) / far_m),
                "Right but for a landmark near the map's centroid: divide by 0.1 m at least.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: (far_c - far_m) / far_m),
                "Two things are missing: the absolute value, and the least divisor of 0.1 m.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: np.abs(far_c - far_m) / np.minimum(far_m, 0.1)),
                "You divide by 0.1 m at most. At least 0.1 m means the greater of the two.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: np.abs(far_c - far_m) / (far_m + 0.1)),
                "You add 0.1 m to the divisor. Take the greater of |dx_m| and 0.1 m instead.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: np.abs(far_c - far_m) / np.maximum(far_c, 0.1)),
                "You divide by the observed distance. Eq. (1) divides by the map's.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: np.abs(far_c - far_m)),
                "That is the difference in metres. Eq. (1) takes it relative to |dx_m|.",
            ),
            Mistake(
                lambda x_c, x_m, p_d: distance_term(x_c, x_m, 1.0),
                "The weight p_d is missing.",
            ),
            Mistake(
                lambda x_c, x_m, p_d: distance_term(x_c, x_m, p_d).T,
                "Rows are observations and columns are landmarks; yours is the other way round.",
            ),
            Mistake(_from_the_origins, "You measure from the origins. Subtract each side's own centroid first."),
            Mistake(
                _one_centroid,
                "You took one centroid for both. x_c is in the body frame: it has a centroid of its own.",
            ),
            Mistake(
                lambda x_c, x_m, p_d: (
                    p_d
                    * np.abs(
                        np.linalg.norm(x_c - x_c.mean(), axis=1)[:, None] - np.linalg.norm(x_m - x_m.mean(), axis=1)
                    )
                    / np.maximum(np.linalg.norm(x_m - x_m.mean(), axis=1), 0.1)
                ),
                "x_c.mean() is one number, of x and y together. The centroid is a point: mean over axis 0.",
            ),
            Mistake(
                _of_vectors,
                "You subtract vectors of two different frames. First take their lengths, then the difference.",
            ),
            Mistake(
                _from_lengths(lambda points: np.sum((points - points.mean(axis=0)) ** 2, axis=1)),
                "These are squared distances: the root is missing.",
            ),
            Mistake(
                _from_lengths(lambda points: np.abs(points - points.mean(axis=0)).sum(axis=1)),
                "You add the ways along x and along y. A distance is the root of the sum of squares.",
            ),
            Mistake(
                _from_lengths(lambda points: np.linalg.norm(points - points.mean(axis=1, keepdims=True), axis=1)),
                "Your mean goes over x and y of each point. The centroid is the mean over the points: axis 0.",
            ),
            Mistake(
                _from_lengths(lambda points: np.linalg.norm(points - np.median(points, axis=0), axis=1)),
                "The centroid is the mean of the places, not their median.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: np.maximum(np.abs(far_c - far_m) / far_m, 0.1)),
                "The divisor is at least 0.1 m, not the whole term.",
            ),
        ),
    ),
    Exercise(
        number="15.3",
        reference=match_greedily,
        inputs=_costs,
        mistakes=(
            Mistake(
                lambda cost: np.argmin(cost, axis=1),
                "Each row takes its own cheapest column, so one column may be taken twice. It must be one-to-one.",
            ),
            Mistake(
                _row_by_row,
                "You serve the rows in their order. The cheapest of *all* open combinations comes first.",
            ),
            Mistake(
                _best_sum,
                "That is the assignment with the least sum. The paper's search takes the cheapest and never goes back.",
            ),
            Mistake(_rows_stay_open, "You strike out the column only: a row that is matched may be chosen again."),
            Mistake(_columns_stay_open, "You strike out the row only: a column may be taken twice."),
            Mistake(
                _too_many_rounds,
                "When all is struck out, argmin says 0: a row is matched once more. Stop when one side is used up.",
            ),
            Mistake(
                _struck_with_zero,
                "You strike out with 0, which the next search may find the cheapest. What is never the least?",
            ),
            Mistake(
                lambda cost: match_greedily(-cost),
                "You take the dearest combination first.",
            ),
            Mistake(
                lambda cost: np.maximum(match_greedily(cost), 0),
                "Rows that get no column must hold -1; yours hold 0, which is a column.",
            ),
            Mistake(
                lambda cost: match_greedily(cost.T),
                "Yours tells for every column its row. Asked is, for every row, its column.",
            ),
            Mistake(
                lambda cost: _rounds(cost, cost.shape[1]),
                "One round for each column is too many where rows run out first. Stop when one side is used up.",
            ),
            Mistake(
                lambda cost: _rounds(cost, min(cost.shape) - 1),
                "You stop one round too early: the last open row and column belong together, too.",
            ),
            Mistake(
                lambda cost: _rounds(cost, min(cost.shape), struck=1.0),
                "You strike out with 1, and costs can be larger. What is never the least?",
            ),
            Mistake(
                lambda cost: _rounds(cost, min(cost.shape), struck=np.nan),
                "You strike out with NaN, and argmin takes a NaN for the least. np.inf is never the least.",
            ),
            Mistake(
                _while_positive,
                "You stop at costs below 0. A cost may be negative: ask whether anything is left, not whether it is 0.",
            ),
            Mistake(
                _numbers_move_up,
                "You delete rows and columns, so those behind them get other numbers. Strike out with np.inf instead.",
            ),
            Mistake(
                _column_by_column,
                "You serve the columns in their order. The cheapest of *all* open combinations comes first.",
            ),
            Mistake(
                _each_other_s_best,
                "You match only rows and columns that are each other's cheapest. Go on with those that are left.",
            ),
            Mistake(
                lambda cost: np.where(match_greedily(cost) < 0, -1, match_greedily(cost) + 1),
                "You count columns from 1. Python counts from 0.",
            ),
        ),
    ),
]
