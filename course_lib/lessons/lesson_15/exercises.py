"""Exercises of lesson 15: the hue term, the distance term, the repeated minimum with its margins, the centroid."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.lessons.kit.exercises import Exercise

# 15.1: the hue term


def hue_term(hue_seen, hue_map, p_h):
    """Hue term (n,) of eq. (1), on the circle; 0 where either hue is NaN."""
    # The shorter way around, and 0 where there is no hue.
    apart = np.abs(hue_seen - hue_map)
    return np.nan_to_num(p_h * np.minimum(apart, 360 - apart) / 360)


def hues(rng: np.random.Generator) -> tuple:
    """Hues, some of them near the wrap from both sides, some grey on one side or on both."""
    n = int(rng.integers(5, 9))
    seen, on_map = rng.uniform(0, 360, n), rng.uniform(0, 360, n)
    seen[:2], on_map[:2] = rng.uniform([350, 0], [360, 10]), rng.uniform([0, 350], [10, 360])
    seen[2], on_map[3] = np.nan, np.nan
    if rng.random() < 0.3:
        on_map[2] = np.nan
    return seen, on_map, rng.uniform(0.5, 3)


def ends_of_the_circle(rng: np.random.Generator) -> tuple:
    """Equal hues, opposite ones, 0 against 360, and grey on both sides."""
    seen = np.array([0.0, 360.0, 0.0, 180.0, 90.0, 270.0, np.nan])
    return seen, np.array([0.0, 0.0, 360.0, 0.0, 270.0, 90.0, np.nan]), rng.uniform(0.5, 3)


# 15.2: the distance term


def distance_term(x_c, x_m, p_d):
    """Distance term (n, m) of eq. (1) with absolute value; the divisor is at least 0.1 m."""
    # Lengths first, then a column against a row.
    far_c = np.linalg.norm(x_c - x_c.mean(axis=0), axis=1)
    far_m = np.linalg.norm(x_m - x_m.mean(axis=0), axis=1)
    return p_d * np.abs(far_c[:, None] - far_m) / np.maximum(far_m, 0.1)


def observed_and_mapped(rng: np.random.Generator) -> tuple:
    """Observed points and a map of which, in half of the inputs, one landmark stands at the centroid."""
    n, m = int(rng.integers(2, 5)), int(rng.integers(5, 8))
    x_m = rng.uniform(0, 6, (m, 2))
    if rng.random() < 0.5:
        x_m[-1] = x_m[:-1].mean(axis=0) + rng.uniform(-0.02, 0.02, 2)
    return rng.uniform(-3, 3, (n, 2)), x_m, rng.uniform(0.5, 3)


def a_landmark_at_the_centroid(rng: np.random.Generator) -> tuple:
    """Four landmarks around one in the very middle, three of them, and the middle one, less than a metre away."""
    x_m = np.array([[0.0, 0.002], [0.5, 0.0], [-0.5, 0.0], [0.0, 3.0], [0.0, -3.0]]) + rng.uniform(0, 5, 2)
    return rng.uniform(-3, 3, (4, 2)), x_m, 1.5


def all_observed_in_one_place(rng: np.random.Generator) -> tuple:
    return np.tile(rng.uniform(-3, 3, 2), (3, 1)), rng.uniform(0, 6, (5, 2)), 1.0


# 15.3: the repeated minimum, and how close each choice was


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
    """Tables, wide, high and square, with some negative costs; rows compete, or no order would matter."""
    n, m = int(rng.integers(3, 7)), int(rng.integers(3, 7))
    return (rng.uniform(-0.2, 1, (n, 1)) + rng.uniform(0, 1, (1, m)) + 0.6 * rng.uniform(-1, 1, (n, m)),)


def unlike_classes(rng: np.random.Generator) -> tuple:
    """A table as the lesson has it: 1000 and more between classes, of which a column too few is left for the last."""
    (cost,) = costs(rng)
    cost = np.vstack([cost, cost[:1] + 0.05])
    unlike = rng.random((len(cost), 1)) < 0.5
    unlike[:2] = [[True], [False]]
    return (cost + 1000 * (unlike != (rng.random((1, cost.shape[1])) < 0.5)),)


def one_row_and_one_column(rng: np.random.Generator) -> tuple:
    return (np.array([[0.3]]),)


def one_row(rng: np.random.Generator) -> tuple:
    return (np.array([[0.2, 0.5, 0.4]]),)


def least_sum(cost):
    columns, margins = np.full(len(cost), -1), np.full(len(cost), np.nan)
    rows, chosen = linear_sum_assignment(cost)
    columns[rows] = chosen
    margins[rows] = [
        np.min(np.delete(cost[i], j), initial=np.inf) - cost[i, j] for i, j in enumerate(columns) if j >= 0
    ]
    return columns, margins


STRUCK_OUT = "".join(
    f"table[:, j] = np.inf => table[:, j] = {struck}\n        " for struck in (0, 1, 2, 3, 5, 10, 99, 100, 999, 1000)
)

# 15.4: how far the centroid moves


def centroid_shift(places, n_hidden):
    """Root mean square distance [m] of the centroid of the seen places from that of all places (n, 2)."""
    # The variance of a mean drawn without replacement, x and y together.
    n = len(places)
    spread = np.sum((places - places.mean(axis=0)) ** 2) / (n - 1)
    return np.sqrt(spread * n_hidden / (n * (n - n_hidden)))


def places_some_hidden(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 12))
    return rng.uniform(0, 6, (n, 2)), int(rng.integers(1, n - 1))


def as_many_as_the_map_has(rng: np.random.Generator) -> tuple:
    return rng.uniform(0, 6, (14, 2)), 2


def all_but_one_hidden(rng: np.random.Generator) -> tuple:
    return rng.uniform(0, 6, (5, 2)), 4


# fmt: off
EXERCISES = [
    Exercise("15.1", hue_term, hues, "warm-up", cases=[ends_of_the_circle], mistakes="""
        np.minimum(apart, 360 - apart) => apart
        350 and 10 degrees are 20 degrees apart, not 340: go around the circle the shorter way.
        np.nan_to_num( => (
        Grey has no hue: where either side is NaN the term is 0, not NaN.
        np.nan_to_num(p_h => np.where(np.isnan(hue_seen), 0, p_h
        np.nan_to_num(p_h => np.where(np.isnan(hue_map), 0, p_h
        np.nan_to_num(p_h => np.where(np.isnan(hue_seen) & np.isnan(hue_map), 0, p_h
        One grey side is enough, the observed object or the landmark: the term is 0 where *either* hue is NaN.
        np.minimum(apart, 360 - apart) => apart and also np.nan_to_num( => (
        Two things are missing: the shorter way around the circle, and 0 where a hue is NaN.
        / 360) => / 180)
        You divide by 180. That is the better scale, but eq. (1) divides by 360.
        p_h * =>
        p_h * => 1 / p_h *
        The weight p_h is a factor: a larger weight must make the term larger.
        ... => return hue_term(np.nan_to_num(hue_seen), np.nan_to_num(hue_map), p_h)
        You turn grey into hue 0, which is red. First the difference, then 0 where it is NaN.
        np.minimum(apart, 360 - apart) => ((hue_seen - hue_map + 180) % 360 - 180)
        np.minimum(apart, 360 - apart) => (hue_seen - hue_map)
        Your difference has a sign. A hue that is off to the other side must cost as much.
        np.minimum(apart, 360 - apart) => (apart % 180)
        The remainder by 180 makes opposite colours alike. Take the lesser of apart and 360 - apart.
        np.minimum(apart, 360 - apart) => ((hue_seen - hue_map) % 360)
        The remainder by 360 goes one way around only: 10 and 350 become 20, but 350 and 10 become 340.
        / 360) => / 360, nan=p_h)
        / 360) => / 360, nan=p_h / 2)
        You let grey cost the most there is. Nothing is known of its hue, so nothing is held against it: 0.
        np.minimum => np.maximum
        You go the longer way around the circle. np.minimum takes the shorter one.
    """),
    Exercise("15.2", distance_term, observed_and_mapped, cases=[
        a_landmark_at_the_centroid, all_observed_in_one_place,
    ], mistakes="""
        np.abs => np.positive
        As printed in the paper, but without the absolute value an object too near is rewarded.
        np.maximum(far_m, 0.1) => far_m
        Right but for a landmark near the map's centroid: divide by 0.1 m at least.
        np.abs => np.positive and also np.maximum(far_m, 0.1) => far_m
        Two things are missing: the absolute value, and the least divisor of 0.1 m.
        far_m, 0.1) => far_m, 1.0)
        far_m, 0.1) => far_m, 0.01)
        Your divisor has another lower limit than 0.1 m.
        np.maximum => np.minimum
        You divide by 0.1 m at most. At least 0.1 m means the greater of the two.
        np.maximum(far_m, 0.1) => (far_m + 0.1)
        You add 0.1 m to the divisor. Take the greater of |dx_m| and 0.1 m instead.
        np.maximum(far_m, 0.1) => np.maximum(far_c[:, None], 0.1)
        You divide by the observed distance. Eq. (1) divides by the map's.
        / np.maximum(far_m, 0.1) =>
        That is the difference in metres. Eq. (1) takes it relative to |dx_m|.
        p_d * np.abs => p_d * np.maximum(0.1, np.abs and also / np.maximum(far_m, 0.1) => / far_m)
        The divisor is at least 0.1 m, not the whole term.
        x_c - x_c.mean(axis=0) => x_c and also x_m - x_m.mean(axis=0) => x_m
        You measure from the origins. Subtract each side's own centroid first.
        x_c.mean(axis=0) => x_m.mean(axis=0)
        You took one centroid for both. x_c is in the body frame: it has a centroid of its own.
        mean(axis=0) => mean()
        mean(axis=0) => mean(axis=1, keepdims=True)
        The centroid is a point, the mean over the points (axis 0): not over x and y.
        np.abs(far_c[:, None] - far_m) => np.linalg.norm((x_c - x_c.mean(0))[:, None] - x_m + x_m.mean(0), axis=2)
        You subtract vectors of two different frames. First take their lengths, then the difference.
        axis=1) => axis=1) ** 2
        These are squared distances: the root is missing.
        p_d * =>
        The weight p_d is missing.
    """),
    Exercise("15.3", match_with_margins, costs, cases=[unlike_classes, one_row_and_one_column, one_row], mistakes="""
        return columns, margins => return columns, np.where(np.isinf(margins), np.nan, margins)
        Where no other column was open the margin is inf. NaN is for rows without a column.
        table[i, :] = table[:, j] = np.inf => table[i, :] = np.inf and also min(cost.shape) => len(cost)
        Each row takes its own cheapest column, so one column may be taken twice. It must be one-to-one.
        np.unravel_index(np.argmin(table), table.shape) => _, np.argmin(table[_])
        You serve the rows in their order. The cheapest of *all* open combinations comes first.
        np.delete(table[i], j) => np.delete(cost[i], j)
        A column that was struck out before is no choice any more: your margins count columns already taken.
        np.delete(table[i], j) => np.delete(table[:, j], i)
        You compare with other rows for the same column. Asked is the same row's next best column.
        initial=np.inf) - table[i, j] => initial=np.inf)
        That is the next best cost itself. By how much is it dearer than the one taken?
        np.delete(table[i], j) => np.delete(table, i * table.shape[1] + j)
        You take the second cheapest of the whole table. Asked is the next best column of the *same row*.
        np.full(len(cost), np.nan) => np.full(len(cost), np.inf)
        np.full(len(cost), np.nan) => np.zeros(len(cost))
        A row that got no column has no margin: NaN. Neither inf nor 0, which would mean that two columns cost the same.
        np.full(len(cost), -1) => np.zeros(len(cost), int)
        Rows that get no column must hold -1; yours hold 0, which is a column.
        table[i, :] = table[:, j] => table[:, j]
        table[i, :] = table[:, j] => table[i, :]
        You strike out the row or the column alone: who is matched may be chosen again. Strike out both.
        min(cost.shape) => len(cost) and also - table[i, j] => - table[i, j] if np.isfinite(table[i, j]) else np.nan
        min(cost.shape) => cost.shape[1] and also - table[i, j] => - table[i, j] if np.isfinite(table[i, j]) else np.nan
        When all is struck out, argmin says 0: a row is matched once more. Stop when one side is used up.
        min(cost.shape) => min(cost.shape) - 1
        You stop one round too early: the last open row and column belong together, too.
        table[:, j] = np.inf => table[:, j] = np.nan
        You strike out with NaN, and argmin takes a NaN for the least. np.inf is never the least.
        """ + STRUCK_OUT + """You strike out with a number that may be the least again. What is never the least?
    """, functions={
        least_sum: "That is the assignment with the least sum. The paper's search takes the cheapest: no way back.",
    }),
    Exercise("15.4", centroid_shift, places_some_hidden, "challenge", cases=[
        as_many_as_the_map_has, all_but_one_hidden,
    ], mistakes="""
        (n * (n - n_hidden)) => (n - n_hidden) ** 2 * (n - 1) / n
        You add the hidden ones as if independent of each other. None is hidden twice: that ties them.
        spread * n_hidden / (n * (n - n_hidden)) => spread * (n - 1) / n * (n_hidden / (n - n_hidden)) ** 2
        Yours lets all hidden ones lie on one side. They pull in different ways: their mean is nearer.
        np.sqrt( => np.sqrt(np.pi / 4) * np.sqrt(
        That is a mean distance (of a round normal cloud). Asked is the root of the mean square.
        places - places.mean(axis=0) => places
        You take the squares from the origin. It is the places about their centroid that count.
        n_hidden / (n * (n - n_hidden)) => (n - 1) / (n * (n - n_hidden))
        You draw as if with replacement. With nobody hidden yours still moves: no object is seen twice.
        n_hidden / (n * (n - n_hidden)) => 1 / (n - n_hidden)
        The factor for drawing without replacement is missing: with nobody hidden the centroid stays.
        / (n - 1) => / n
        Nearly. Two of the objects seen are never the same one, so their places are not independent.
        np.sqrt(spread => np.sqrt(spread / 2
        That is the spread along one axis. A distance takes x and y together.
        (n * (n - n_hidden)) => n**2
        (n * (n - n_hidden)) => n**2 * (n - 1) / n
        You take the hidden ones away but divide by all n. The centroid of the seen is a mean over n - k.
        n_hidden / (n * (n - n_hidden)) => (n - n_hidden) / (n * n_hidden)
        You exchanged the seen and the hidden: with most objects seen the centroid hardly moves.
        n_hidden / (n * (n - n_hidden)) => (n - 1) / n
        That is how far the objects are from their centroid, not how far a mean of many of them is.
    """),
]
