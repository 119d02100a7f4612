"""Points of an answer: all, half or none."""

import numpy as np
import pytest

from course_lib.classroom.points import POINTS, earned
from course_lib.lessons.kit.exercises import Exercise, find_exercise, right_on


@pytest.mark.parametrize(("right", "share"), [
    ([True] * 4, 1), ([True, True, False, False], 0.5), ([True, False, False, False], 0), ([False] * 4, 0),
    ([True] * 25 + [False], 0.5),
])  # fmt: skip
def test_all_right_earns_all_half_right_earns_half(right, share):
    for points in POINTS.values():
        assert earned(points, right) == share * points


def test_right_inputs_are_counted_by_the_function_that_fits_best():
    either = Exercise("99.2", np.median, lambda rng: (rng.normal(size=9),), others=(np.mean,))
    arguments = either.draw(np.random.default_rng(1))
    answers = [np.mean(*given) for given in arguments]
    assert right_on(either, arguments, answers) == [True] * len(arguments)
    assert right_on(either, arguments, [0.0, *answers[1:]]) == [False, *[True] * (len(arguments) - 1)]
    mixed = [np.median(*given) if i % 2 else np.mean(*given) for i, given in enumerate(arguments)]
    assert sum(right_on(either, arguments, mixed)) <= (len(arguments) + 1) / 2


def test_right_inputs_of_an_exercise_with_many_right_answers_are_those_that_it_accepts():
    exercise = find_exercise("14.3")
    arguments = exercise.draw(np.random.default_rng(1))
    answers = [exercise.solution(*given) for given in arguments]
    assert right_on(exercise, arguments, answers) == [True] * len(arguments)
    assert right_on(exercise, arguments, [None, -1.0, *answers[2:]])[:3] == [False, False, True]
