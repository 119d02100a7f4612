"""General mistakes: slips that are tried on every exercise get their sentence, and nothing else gets it."""

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from courseware.lessons.kit import general_mistakes as general
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.exercises import judge


def turned(R, points, theta):
    """Points (n, 2) and a heading [rad]: turned by R, the heading by theta, too."""
    shifted = points - points.mean(axis=0)
    heading = wrap_angle(np.arctan2(R[1, 0], R[0, 0]) + theta)
    return shifted @ R.T, heading


def spread(values):
    """Mean absolute value over root n."""
    n = len(values)
    return np.sqrt(np.sum(np.abs(values) ** 3)) / n


def first_below(values, limit):
    """Index of the first value below the limit; -1 if there is none."""
    for k in range(len(values)):
        if values[k] < limit:
            return k
    return -1


def column_means(a, b):
    """Twice the greatest row of a, less the mean row of b."""
    return 2 * a.max(axis=0) - b.mean(axis=0)


def deviation(values):
    """The deviation, at least 0.5, in radians."""
    return np.deg2rad(np.clip(np.std(values), 0.5, None))


def first_sum(values, count):
    """Sum of the first `count` values, at least of one."""
    return values[: max(int(count), 1)].sum()


def a_rotation(rng):
    theta = rng.uniform(-3, 3)
    return np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])


def given_numbers(rng):
    return (rng.normal(size=int(rng.integers(4, 9))),)


TURNED = Exercise("99.1", turned, lambda rng: (a_rotation(rng), rng.normal(size=(5, 2)), rng.uniform(-3, 3)))
SPREAD = Exercise("99.2", spread, given_numbers)
FIRST = Exercise("99.3", first_below, lambda rng: (rng.integers(0, 4, 8).astype(float), 1.0))
BELOW_2 = Exercise("99.9", first_below, lambda rng: (rng.integers(0, 4, 8).astype(float), 2.0))
FIRST_SUM = Exercise("99.10", first_sum, lambda rng: (rng.normal(size=9), int(rng.integers(2, 9))))
NEGATIVE = Exercise("99.8", lambda values: -np.abs(values), given_numbers)
TAN = Exercise("99.4", np.tan, lambda rng: (rng.uniform(-1, 1, 3),))
SQUARE = Exercise("99.5", column_means, lambda rng: (rng.normal(size=(3, 3)), rng.normal(size=(3, 3))))
DEVIATION = Exercise("99.6", deviation, given_numbers)
OWN = Exercise("99.7", spread, given_numbers, mistakes="np.abs(values) => values\nCubes keep their signs.")


def with_heading(heading):
    return lambda R, points, theta: (turned(R, points, theta)[0], heading(R, points, theta))


def cubed(values):
    with np.errstate(invalid="ignore"):
        return np.sqrt(np.sum(values**3)) / len(values)


@pytest.mark.parametrize(
    ("exercise", "answer", "sentence"),
    [
        (TURNED, lambda R, points, theta: turned(R.T, points, theta), general.TRANSPOSED),
        (TURNED, lambda R, points, theta: turned(R, points, -theta), general.SIGN),
        (TURNED, lambda R, points, theta: turned(R, points, np.deg2rad(theta)), general.DEGREES),
        (TURNED, with_heading(lambda *g: np.rad2deg(turned(*g)[1])), general.DEGREES),
        (TURNED, with_heading(lambda R, p, theta: np.arctan2(R[1, 0], R[0, 0]) + theta), general.WRAP),
        (TURNED, with_heading(lambda R, p, theta: wrap_angle(np.arctan2(R[0, 0], R[1, 0]) + theta)), general.ARCTAN2),
        (
            TURNED,
            with_heading(lambda R, p, theta: wrap_angle(np.arctan(R[1, 0] / R[0, 0]) + theta)),
            general.HALF_CIRCLE,
        ),
        (TURNED, lambda R, p, theta: ((p - np.median(p, axis=0)) @ R.T, turned(R, p, theta)[1]), general.MIDDLE),
        (SPREAD, lambda values: spread(values) ** 2, general.SQUARED),
        (SPREAD, lambda values: spread(values) * len(values) / (len(values) - 1), general.DIVISOR),
        (SPREAD, cubed, general.ABSOLUTE),
        (SPREAD, lambda values: 1.003 * spread(values), general.NEARLY),
        (SPREAD, lambda values: round(spread(values), 3), general.NEARLY),
        (NEGATIVE, lambda values: -np.abs(values) - 0.0001, general.NEARLY),
        (SPREAD, lambda values: 1.03 * spread(values), general.CLOSE),
        (SPREAD, lambda values: 1.4826 * spread(values), general.FACTOR),
        (SPREAD, lambda values: 1.5 + spread(values), general.OFFSET),
        (SPREAD, lambda values: spread(values) * len(values) ** 2, general.QUOTIENT),
        (FIRST, lambda values, limit: first_below(values, limit) + 1, general.OFF_BY_ONE),
        (FIRST, lambda values, limit: first_below(values[:-1], limit), general.OFF_BY_ONE),
        (FIRST, lambda values, limit: next((k for k, v in enumerate(values) if v <= limit), -1), general.EQUAL),
        (TAN, lambda x: -np.tan(x), general.SIGN),
        (SQUARE, lambda a, b: 2 * a.max(axis=0) - b.mean(axis=1), general.TRANSPOSED),
        (SQUARE, lambda a, b: 2 * a.max(axis=1) - b.mean(axis=1), general.AXIS),
        (SQUARE, lambda a, b: 2 * b.max(axis=0) - a.mean(axis=0), general.EXCHANGED),
        (SQUARE, lambda a, b: 2 * a.min(axis=0) - b.mean(axis=0), general.EXTREME),
        (DEVIATION, lambda values: np.deg2rad(max(np.std(values, ddof=1), 0.5)), general.DIVISOR),
        (DEVIATION, lambda values: np.deg2rad(np.std(values)), general.LIMITS),
        (OWN, cubed, "Cubes keep their signs."),
    ],
)
def test_a_slip_gets_its_sentence(exercise, answer, sentence):
    for seed in range(2):
        assert judge(exercise, answer, seed).message == f"not yet. {sentence}"


@pytest.mark.parametrize(
    ("exercise", "answer"), [(SPREAD, np.max), (FIRST, lambda values, limit: len(values)), (SQUARE, np.add)]
)
def test_what_is_wrong_in_no_known_way_gets_no_such_sentence(exercise, answer):
    sentence = judge(exercise, answer).message
    assert not [text for text in vars(general).values() if isinstance(text, str) and text in sentence[9:]]


@pytest.mark.parametrize(
    ("exercise", "answer"),
    [
        (BELOW_2, lambda values, limit: first_below(values, 0.5)),  # as if the limit were 57 times as small
        (FIRST_SUM, lambda values, count: values.sum()),  # as if the count were 57 times as large
        (SPREAD, lambda values: np.rad2deg(spread(values))),
    ],
)
def test_degrees_are_a_slip_of_angles_only(exercise, answer):
    for seed in range(2):
        assert general.DEGREES not in judge(exercise, answer, seed).message
