"""Exercises of lesson 13: the epipolar residual, the row in the lower image, and one-to-one pairs by most matches."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 13.1: how far a pair of directions misses the epipolar constraint


def residual(azimuth_upper: np.ndarray, azimuth_lower: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    """arcsin(cos e |sin(a_l - a_u)|), or pi/2 - |e| beyond a right angle; radians `(n,)`, e the one nearer level."""
    gap = _gap(azimuth_upper, azimuth_lower)
    return np.where(gap > np.pi / 2, np.pi / 2 - np.abs(elevation), np.arcsin(np.cos(elevation) * np.sin(gap)))


def _gap(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Difference of azimuths on the circle, radians in [0, pi]."""
    return np.abs((second - first + np.pi) % (2 * np.pi) - np.pi)


def _directions(rng: np.random.Generator) -> tuple:
    """Nine pairs: near each other, across the seam, and on opposite sides, three of each."""
    first = np.concatenate([rng.uniform(-2.5, 2.5, 3), rng.uniform(3.0, np.pi, 3), rng.uniform(-0.9, 0.9, 3)])
    gap = np.concatenate([rng.uniform(-0.5, 0.5, 3), rng.uniform(0.2, 0.5, 3), rng.uniform(1.8, 2.2, 3)])
    second = (first + gap + np.pi) % (2 * np.pi) - np.pi
    return first, second, rng.uniform(-1.0, 0.6, 9)


def _residual_of_the_gap_alone(first: np.ndarray, second: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    return _gap(first, second)


def _residual_without_cosine(first: np.ndarray, second: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    return residual(first, second, np.zeros_like(elevation))


def _residual_without_wrap(first: np.ndarray, second: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    gap = np.abs(second - first)
    return np.where(gap > np.pi / 2, np.pi / 2 - np.abs(elevation), np.arcsin(np.cos(elevation) * np.sin(gap)))


def _residual_both_halves(first: np.ndarray, second: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    return np.arcsin(np.cos(elevation) * np.abs(np.sin(second - first)))


def _residual_with_a_sign(first: np.ndarray, second: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    gap = second - first
    return np.where(
        _gap(first, second) > np.pi / 2, np.pi / 2 - np.abs(elevation), np.arcsin(np.cos(elevation) * np.sin(gap))
    )


def _residual(at_gap: Callable, at_pole: Callable = lambda elevation: np.pi / 2 - np.abs(elevation)) -> Callable:
    """A mistake: `at_gap(gap, elevation)` up to a right angle, `at_pole(elevation)` beyond."""

    def mistaken(first, second, elevation):
        gap = _gap(first, second)
        return np.where(gap > np.pi / 2, at_pole(elevation), at_gap(gap, elevation))

    return mistaken


def _arcsin(gap: np.ndarray, elevation: np.ndarray) -> np.ndarray:
    return np.arcsin(np.cos(elevation) * np.sin(gap))


# 13.2: the row in the lower image


def lower_row(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    """Row `(n,)` in the lower image of points at rows v of the upper one: tan e_l = tan e_u + baseline / range."""
    slope = np.tan(_elevation(v, height)) + baseline / horizontal_range
    return _row(np.arctan(slope), height)


def _elevation(v: np.ndarray, height: int) -> np.ndarray:
    return (0.5 - v / height) * np.pi


def _row(elevation: np.ndarray, height: int) -> np.ndarray:
    return (0.5 - elevation / np.pi) * height


def _rows(rng: np.random.Generator) -> tuple:
    height = int(rng.choice([320, 640, 960]))
    return rng.uniform(0.3, 0.9, 5) * height, rng.uniform(0.6, 5.0), rng.uniform(0.1, 0.6), height


def _row_of_a_higher_camera(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return lower_row(v, horizontal_range, -baseline, height)


def _row_from_angles_added(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return _row(_elevation(v, height) + baseline / horizontal_range, height)


def _row_without_arctan(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return _row(np.tan(_elevation(v, height)) + baseline / horizontal_range, height)


def _elevation_for_row(v: np.ndarray, horizontal_range: float, baseline: float, height: int) -> np.ndarray:
    return _elevation(lower_row(v, horizontal_range, baseline, height), height)


def _row_with_the_angle_of_the_level(
    v: np.ndarray, horizontal_range: float, baseline: float, height: int
) -> np.ndarray:
    return _row(_elevation(v, height) + np.arctan(baseline / horizontal_range), height)


# 13.3: one-to-one by most matches


def partners(counts: np.ndarray) -> np.ndarray:
    """Column `(n,)` that each row of a table of counts `(n, m)` is paired with, most first, one-to-one; -1: none."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() > 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[i], counts[:, j] = 0, 0
    return result


def _tables(rng: np.random.Generator) -> tuple:
    """Counts without ties, with a row of zeros now and then, and rows that want one column."""
    n, m = int(rng.integers(3, 6)), int(rng.integers(3, 6))
    counts = rng.permutation(np.arange(1, n * m + 1)).reshape(n, m) * 2
    counts[0, 0], counts[1, 0] = 90, 80  # both rows want the first column
    counts[1, 1] = 0 if rng.random() < 0.5 else 70
    if rng.random() < 0.5:
        counts[2] = 0
    # In any order: else the first row and column would be a pair in every table, which a loop too long also finds.
    return (counts[rng.permutation(n)][:, rng.permutation(m)],)


def _each_row_its_best(counts: np.ndarray) -> np.ndarray:
    return np.where(counts.max(axis=1) > 0, counts.argmax(axis=1), -1)


def _zeros_paired(counts: np.ndarray) -> np.ndarray:
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() >= 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[i], counts[:, j] = -1, -1
    return result


def _columns_stay_free(counts: np.ndarray) -> np.ndarray:
    return np.argmax(counts, axis=1)


def _row_by_row(counts: np.ndarray) -> np.ndarray:
    """The rows in their order: each takes the best column that is left."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    for i in range(len(counts)):
        if counts[i].max() > 0:
            result[i] = counts[i].argmax()
            counts[:, result[i]] = 0
    return result


def _repeated_maximum(counts: np.ndarray, rounds: int) -> np.ndarray:
    """A mistake: so many rounds, whether or not a count above 0 is left."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    for _ in range(rounds):
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[i], counts[:, j] = 0, 0
    return result


def _rows_stay_open(counts: np.ndarray) -> np.ndarray:
    counts, result = np.array(counts), np.full(len(counts), -1)
    while counts.max() > 0:
        i, j = np.unravel_index(counts.argmax(), counts.shape)
        result[i] = j
        counts[:, j] = 0
    return result


def _largest_sum(counts: np.ndarray) -> np.ndarray:
    result = np.full(len(counts), -1)
    rows, columns = linear_sum_assignment(counts, maximize=True)
    result[rows] = np.where(counts[rows, columns] > 0, columns, -1)
    return result


def _mutual_best(counts: np.ndarray) -> np.ndarray:
    best = counts.argmax(axis=1)
    mutual = (counts.argmax(axis=0)[best] == np.arange(len(counts))) & (counts.max(axis=1) > 0)
    return np.where(mutual, best, -1)


EXERCISES = [
    Exercise(
        "13.1",
        residual,
        _directions,
        (
            Mistake(
                _residual_of_the_gap_alone, "That is the gap in azimuth. On the sphere, meridians close up by cos e."
            ),
            Mistake(_residual_without_cosine, "The cosine of the elevation is missing: see equation (13.2)."),
            Mistake(_residual_without_wrap, "Wrong across the seam: bring the gap to -pi ... pi first."),
            Mistake(
                _residual_both_halves, "Opposite directions lie in the plane too, but behind: beyond pi/2 use the pole."
            ),
            Mistake(_residual_with_a_sign, "A distance is never negative: take the absolute value of the gap."),
            Mistake(
                _residual(_arcsin, lambda elevation: np.pi / 2 - elevation),
                "Below the horizon the nearest pole is the lower one: the way there is pi/2 - |e|.",
            ),
            Mistake(
                _residual(_arcsin, lambda elevation: np.abs(elevation)),
                "Beyond a right angle the way to the pole is asked: pi/2 - |e|, not |e|.",
            ),
            Mistake(
                _residual(_arcsin, lambda elevation: np.pi / 2),
                "Beyond a right angle the half-circle still ends at the poles: the nearer one is pi/2 - |e| away.",
            ),
            Mistake(
                _residual(lambda gap, elevation: np.cos(elevation) * np.sin(gap)),
                "That is the sine of the residual: the arcsine is missing.",
            ),
            Mistake(
                _residual(lambda gap, elevation: np.cos(elevation) * gap),
                "cos e times the gap is right for small gaps only: equation (13.2) has a sine and an arcsine.",
            ),
            Mistake(
                _residual(lambda gap, elevation: np.arcsin(np.abs(np.sin(elevation)) * np.sin(gap))),
                "Meridians meet at the poles: the factor is cos e, which is 0 there.",
            ),
            Mistake(
                _residual(lambda gap, elevation: np.arcsin(np.sin(elevation) * np.sin(gap))),
                "Meridians meet at the poles: the factor is cos e, which is 0 there; and a distance has no sign.",
            ),
            Mistake(lambda a_u, a_l, e: np.degrees(residual(a_u, a_l, e)), "Yours is in degrees; give radians."),
        ),
    ),
    Exercise(
        "13.2",
        lower_row,
        _rows,
        (
            Mistake(_row_of_a_higher_camera, "Your point sinks. A camera further down sees it higher: e_l > e_u."),
            Mistake(_row_from_angles_added, "baseline / range adds to the tangent of e_u, not to the angle."),
            Mistake(
                _row_with_the_angle_of_the_level, "Angles do not add here: add the tangents, then take the arctan."
            ),
            Mistake(
                _row_without_arctan, "You have the tangent of e_l. Turn it into an angle before you ask for its row."
            ),
            Mistake(_elevation_for_row, "That is the elevation in radians; the task asks for the row in pixels."),
            Mistake(
                lambda v, horizontal_range, baseline, height: lower_row(v, baseline, horizontal_range, height),
                "You add range / baseline. Near points move more: it is baseline / range.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: lower_row(v, 1 / horizontal_range, baseline, height),
                "You multiply by the range. Near points move more: divide by it.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: height - lower_row(v, horizontal_range, baseline, height),
                "Your picture is upside down: row 0 is straight up, so a row falls as the elevation grows.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: _row(
                    np.arctan(np.tan(2 * _elevation(v, height)) + baseline / horizontal_range) / 2, height
                ),
                "All rows together span pi, from straight up to straight down; the 2 pi belong to the columns.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: v + 0 * lower_row(v, horizontal_range, baseline, height),
                "These are the rows of the upper image. The lower camera sees every point higher.",
            ),
            Mistake(
                lambda v, horizontal_range, baseline, height: np.round(
                    lower_row(v, horizontal_range, baseline, height)
                ),
                "Rows are edge coordinates here, with fractions: do not round them.",
            ),
        ),
    ),
    Exercise(
        "13.3",
        partners,
        _tables,
        (
            Mistake(_each_row_its_best, "Two of your rows share a column: a column that is taken is taken."),
            Mistake(_columns_stay_free, "You give every row its best column: one-to-one, and never with a count of 0."),
            Mistake(
                _zeros_paired, "You pair objects that share no feature: a count of 0 pairs nothing, so stop there."
            ),
            Mistake(_row_by_row, "Not row after row: the largest count of the whole table comes first."),
            Mistake(_rows_stay_open, "You take out the column only: a row that has its partner is chosen again."),
            Mistake(
                lambda counts: _repeated_maximum(counts, min(counts.shape)),
                "When all counts left are 0, argmax says row 0, column 0, and you pair these: stop at 0.",
            ),
            Mistake(
                lambda counts: _repeated_maximum(counts, len(counts)),
                "One round for each row is too many: once all is 0, argmax says row 0, column 0. Stop at 0.",
            ),
            Mistake(
                _largest_sum,
                "That is the assignment with the largest sum. Here the largest count of all comes first.",
            ),
            Mistake(
                _mutual_best,
                "You pair only those that are each other's best. When these are out, the others choose again.",
            ),
            Mistake(
                lambda counts: np.maximum(partners(counts), 0),
                "Rows without a partner must hold -1; yours hold 0, which is a column.",
            ),
            Mistake(lambda counts: partners(counts.T), "Yours tells each column its row. Asked: each row its column."),
        ),
    ),
]
