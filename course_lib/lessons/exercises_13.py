"""Exercises of lesson 13: the epipolar residual, the row in the lower image, and one-to-one pairs by most matches."""

from __future__ import annotations

import numpy as np

from course_lib.lessons.exercises import Exercise, Mistake

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
    return (counts,)


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
    """The rows in their order, the last first: each takes the best column that is left."""
    counts, result = np.array(counts), np.full(len(counts), -1)
    for i in range(len(counts)):
        if counts[i].max() > 0:
            result[i] = counts[i].argmax()
            counts[:, result[i]] = 0
    return result


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
        ),
    ),
]
