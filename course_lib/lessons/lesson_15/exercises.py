"""Exercises of lesson 15: the hue term, the distance term, the repeated minimum with its margins, the centroid."""

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


def _ends_of_the_circle(rng: np.random.Generator) -> tuple:
    """Equal hues, opposite ones, 0 against 360, and grey on both sides."""
    seen = np.array([0.0, 360.0, 0.0, 180.0, 90.0, 270.0, np.nan])
    return seen, np.array([0.0, 0.0, 360.0, 0.0, 270.0, 90.0, np.nan]), rng.uniform(0.5, 3)


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


def _landmark_at_the_centroid(rng: np.random.Generator) -> tuple:
    """Four landmarks around one in the very middle, three of them, and the middle one, less than a metre away."""
    x_m = np.array([[0.0, 0.0], [0.5, 0.0], [-0.5, 0.0], [0.0, 3.0], [0.0, -3.0]]) + rng.uniform(0, 5, 2)
    return rng.uniform(-3, 3, (4, 2)), x_m, 1.5


def _one_place(rng: np.random.Generator) -> tuple:
    """All that is observed stands in one place: every observed distance is 0."""
    return np.tile(rng.uniform(-3, 3, 2), (3, 1)), rng.uniform(0, 6, (5, 2)), 1.0


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


# 15.3: the repeated minimum, and how close each choice was


def match_with_margins(cost: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For every row of cost (n, m) its column (n,), -1 for none, and its margin (n,): cheapest first, one-to-one.

    The margin is by how much the row's next best open column was dearer, in the round in which it was matched: inf
    where no other was open, NaN for a row that got none.
    """
    return _matched(cost)


def _matched(
    cost: np.ndarray,
    rounds: int | None = None,
    struck: float = np.inf,
    choose: Callable = np.argmin,
    rows: bool = True,
    columns: bool = True,
    margin: Callable | None = None,
    nothing: tuple[float, float] = (-1, np.nan),
) -> tuple[np.ndarray, np.ndarray]:
    """The repeated minimum, right by default; every argument is a mistake that is made.

    rounds: how many; struck: what strikes out; choose: the flat index of a table; rows, columns: which of the two are
    struck out; margin: of `(table as it is open, row, column, the whole cost)`; nothing: for rows without a column.
    """
    table, margin = np.array(cost, dtype=float), margin or _to_next_best
    found, margins = np.full(len(cost), nothing[0]), np.full(len(cost), nothing[1])
    for _ in range(min(cost.shape) if rounds is None else rounds):
        i, j = np.unravel_index(choose(table), table.shape)
        with np.errstate(invalid="ignore"):
            found[i], margins[i] = j, margin(table, i, j, cost)
        if rows:
            table[i] = struck
        if columns:
            table[:, j] = struck
    return found, margins


def _to_next_best(table: np.ndarray, i: int, j: int, cost: np.ndarray) -> float:
    others = np.delete(table[i], j)
    return float(others.min() - table[i, j]) if others.size else np.inf


def _to_next_best_of_all(table: np.ndarray, i: int, j: int, cost: np.ndarray) -> float:
    return _to_next_best(cost, i, j, cost)


def _to_next_best_row(table: np.ndarray, i: int, j: int, cost: np.ndarray) -> float:
    return _to_next_best(table.T, j, i, cost.T)


def _next_best_itself(table: np.ndarray, i: int, j: int, cost: np.ndarray) -> float:
    return _to_next_best(table, i, j, cost) + table[i, j]


def _to_second_of_the_table(table: np.ndarray, i: int, j: int, cost: np.ndarray) -> float:
    return float(np.partition(table, 1, axis=None)[1] - table[i, j]) if table.size > 1 else np.inf


def _costs(rng: np.random.Generator) -> tuple:
    """Tables, wide, high and square, with some negative costs; rows compete, or no order would matter."""
    n, m = int(rng.integers(3, 7)), int(rng.integers(3, 7))
    return (rng.uniform(-0.2, 1, (n, 1)) + rng.uniform(0, 1, (1, m)) + 0.6 * rng.uniform(-1, 1, (n, m)),)


def _unlike_classes(rng: np.random.Generator) -> tuple:
    """A table as the lesson has it: 100 and more between classes, of which a column too few is left for the last."""
    (cost,) = _costs(rng)
    cost = np.vstack([cost, cost[:1] + 0.05])
    unlike = rng.random((len(cost), 1)) < 0.5
    unlike[:2] = [[True], [False]]
    return (cost + 1000 * (unlike != (rng.random((1, cost.shape[1])) < 0.5)),)


def _row_by_row(cost):
    table, found, margins = cost.copy(), np.full(len(cost), -1), np.full(len(cost), np.nan)
    for i in range(min(cost.shape)):
        found[i] = np.argmin(table[i])
        margins[i] = _to_next_best(table, i, found[i], cost)
        table[:, found[i]] = np.inf
    return found, margins


def _best_sum(cost):
    found, margins = np.full(len(cost), -1), np.full(len(cost), np.nan)
    rows, chosen = linear_sum_assignment(cost)
    found[rows] = chosen
    margins[rows] = [_to_next_best(cost, i, j, cost) for i, j in zip(rows, chosen, strict=True)]
    return found, margins


def _each_row_its_own(cost):
    found = np.argmin(cost, axis=1)
    return found, np.array([_to_next_best(cost, i, j, cost) for i, j in enumerate(found)])


# 15.4: how far the centroid moves


def centroid_shift(places: np.ndarray, n_hidden: int) -> float:
    """Root mean square distance [m] from the centroid of all places (n, 2) to that of those seen, n_hidden not seen.

    sqrt(k / (n (n - k)) sum |x_i - x_G|^2 / (n - 1)), each choice of k hidden ones as likely as any other.
    """
    n = len(places)
    return float(np.sqrt(n_hidden / (n * (n - n_hidden)) * _spread(places) / (n - 1)))


def _spread(places: np.ndarray) -> float:
    return float(np.sum((places - places.mean(axis=0)) ** 2))


def _places(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 12))
    return rng.uniform(0, 6, (n, 2)), int(rng.integers(1, n - 1))


def _shift(formula: Callable) -> Callable:
    """A mistake: the root of `formula(n, k, sum of squares about the centroid)`."""

    def mistaken(places, n_hidden):
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(np.sqrt(np.float64(formula(len(places), n_hidden, _spread(places)))))

    return mistaken


EXERCISES = [
    Exercise(
        number="15.1",
        solution=hue_term,
        inputs=_hues,
        level="warm-up",
        cases=(_ends_of_the_circle,),
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
        solution=distance_term,
        inputs=_points,
        cases=(_landmark_at_the_centroid, _one_place),
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
                _distance(lambda far_c, far_m: np.abs(far_c - far_m) / np.maximum(far_m, 1.0)),
                "Your divisor is at least 1 m. The task says 0.1 m.",
            ),
            Mistake(
                _distance(lambda far_c, far_m: np.abs(far_c - far_m) / np.maximum(far_m, 0.01)),
                "Your divisor is at least 0.01 m. The task says 0.1 m.",
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
        solution=match_with_margins,
        inputs=_costs,
        cases=(_unlike_classes, lambda rng: (np.array([[0.3]]),), lambda rng: (np.array([[0.2, 0.5, 0.4]]),)),
        mistakes=(
            Mistake(
                lambda cost: _matched(cost, margin=lambda *open_: -_to_next_best(*open_)),
                "Your margins are negative: the next best minus the one taken, by how much it was *dearer*.",
            ),
            Mistake(
                lambda cost: (
                    match_with_margins(cost)[0],
                    np.where(np.isinf(m := match_with_margins(cost)[1]), np.nan, m),
                ),
                "Where no other column was open the margin is inf. NaN is for rows without a column.",
            ),
            Mistake(
                _each_row_its_own,
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
            Mistake(
                lambda cost: _matched(cost, margin=_to_next_best_of_all),
                "A column that was struck out before is no choice any more: your margins count columns already taken.",
            ),
            Mistake(
                lambda cost: _matched(cost, margin=_to_next_best_row),
                "You compare with other rows for the same column. Asked is the same row's next best column.",
            ),
            Mistake(
                lambda cost: _matched(cost, margin=_next_best_itself),
                "That is the next best cost itself. By how much is it dearer than the one taken?",
            ),
            Mistake(
                lambda cost: _matched(cost, margin=_to_second_of_the_table),
                "You take the second cheapest of the whole table. Asked is the next best column of the *same row*.",
            ),
            Mistake(
                lambda cost: _matched(cost, nothing=(-1, np.inf)),
                "A row that got no column has no margin: NaN, not inf.",
            ),
            Mistake(
                lambda cost: _matched(cost, nothing=(-1, 0.0)),
                "A row that got no column has no margin: NaN. A margin of 0 would mean that two columns cost the same.",
            ),
            Mistake(
                lambda cost: _matched(cost, nothing=(0, np.nan)),
                "Rows that get no column must hold -1; yours hold 0, which is a column.",
            ),
            Mistake(
                lambda cost: _matched(cost, columns=True, rows=False),
                "You strike out the column only: a row that is matched may be chosen again.",
            ),
            Mistake(
                lambda cost: _matched(cost, columns=False), "You strike out the row only: a column may be taken twice."
            ),
            Mistake(
                lambda cost: _matched(cost, rounds=len(cost)),
                "When all is struck out, argmin says 0: a row is matched once more. Stop when one side is used up.",
            ),
            Mistake(
                lambda cost: _matched(cost, rounds=cost.shape[1]),
                "One round for each column is too many where rows run out first. Stop when one side is used up.",
            ),
            Mistake(
                lambda cost: _matched(cost, rounds=min(cost.shape) - 1),
                "You stop one round too early: the last open row and column belong together, too.",
            ),
            Mistake(
                lambda cost: _matched(cost, struck=0.0),
                "You strike out with 0, which the next search may find the cheapest. What is never the least?",
            ),
            *(
                Mistake(
                    lambda cost, struck=struck: _matched(cost, struck=struck),
                    f"You strike out with {struck:g}, but a cost can be larger. What is never the least?",
                )
                for struck in (1.0, 2.0, 3.0, 5.0, 10.0, 99.0, 100.0, 999.0, 1000.0)
            ),
            Mistake(
                lambda cost: _matched(cost, struck=np.nan),
                "You strike out with NaN, and argmin takes a NaN for the least. np.inf is never the least.",
            ),
            Mistake(
                lambda cost: _matched(cost, choose=lambda table: np.argmax(np.where(np.isinf(table), -np.inf, table))),
                "You take the dearest combination first.",
            ),
            Mistake(
                lambda cost: _matched(cost.T),
                "Yours tells for every column its row. Asked is, for every row, its column.",
            ),
        ),
    ),
    Exercise(
        number="15.4",
        solution=centroid_shift,
        inputs=_places,
        level="challenge",
        cases=(
            lambda rng: (rng.uniform(0, 6, (14, 2)), 2),
            lambda rng: (rng.uniform(0, 6, (5, 2)), 0),
            lambda rng: (rng.uniform(0, 6, (5, 2)), 4),
            lambda rng: (np.ones((6, 2)), 3),
        ),
        mistakes=(
            Mistake(
                _shift(lambda n, k, squares: k * squares / n / (n - k) ** 2),
                "You add the hidden ones as if independent of each other. None is hidden twice: that ties them.",
            ),
            Mistake(
                _shift(lambda n, k, squares: (k / (n - k)) ** 2 * squares / n),
                "Yours lets all hidden ones lie on one side. They pull in different ways: their mean is nearer.",
            ),
            Mistake(
                lambda places, n_hidden: centroid_shift(places, n_hidden) * np.sqrt(np.pi) / 2,
                "That is a mean distance (of a round normal cloud). Asked is the root of the mean square.",
            ),
            Mistake(
                lambda places, n_hidden: float(
                    np.sqrt(n_hidden * np.sum(places**2) / (len(places) * (len(places) - 1) * (len(places) - n_hidden)))
                ),
                "You take the squares from the origin. It is the places about their centroid that count.",
            ),
            Mistake(
                _shift(lambda n, k, squares: squares / n / (n - k)),
                "You draw as if with replacement. With nobody hidden yours still moves: no object is seen twice.",
            ),
            Mistake(
                _shift(lambda n, k, squares: squares / (n - 1) / (n - k)),
                "The factor for drawing without replacement is missing: with nobody hidden the centroid stays.",
            ),
            Mistake(
                _shift(lambda n, k, squares: k / (n * (n - k)) * squares / n),
                "Nearly. Two of the objects seen are never the same one, so their places are not independent.",
            ),
            Mistake(
                _shift(lambda n, k, squares: k / (n * (n - k)) * squares / (n - 1) / 2),
                "That is the spread along one axis. A distance takes x and y together.",
            ),
            Mistake(
                lambda places, n_hidden: centroid_shift(places, n_hidden) ** 2,
                "That is the mean of the squares: the root is missing.",
            ),
            Mistake(
                _shift(lambda n, k, squares: (n - k) / (n * max(k, 0.0)) * squares / (n - 1) if k else 0.0),
                "You exchanged the seen and the hidden: with most objects seen the centroid hardly moves.",
            ),
            Mistake(
                _shift(lambda n, k, squares: k / n**2 * squares / n),
                "You take the hidden ones away but divide by all n. The centroid of the seen is a mean over n - k.",
            ),
            Mistake(
                _shift(lambda n, k, squares: squares / n),
                "That is how far the objects are from their centroid, not how far a mean of many of them is.",
            ),
        ),
    ),
]
