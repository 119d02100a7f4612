"""Every exercise: its solution is right, in any form and by another way, and each of its mistakes gets its own hint."""

import copy
import importlib
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

from courseware.lessons.kit.exercises import fault, find_exercise, judge, lesson_exercises, lesson_numbers
from courseware.lessons.kit.values import parts

EXERCISES = [exercise for number in lesson_numbers() for exercise in lesson_exercises(number)]
every_exercise = pytest.mark.parametrize("exercise", EXERCISES, ids=lambda exercise: exercise.number)
# 0 is the seed of `check`. What is right or wrong must not hang on one set of inputs.
SEEDS = (0, 1)

RIGHT_ANSWERS = [
    answer
    for path in sorted(Path(__file__).parent.glob("right_answers/*_[0-9]*.py"))
    for answer in importlib.import_module(f"{__package__}.right_answers.{path.stem}").RIGHT
]


def answers_of(function, inputs: list[tuple]) -> list:
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return [function(*copy.deepcopy(given)) for given in inputs]


@every_exercise
def test_the_solution_is_right_and_each_mistake_gets_its_own_hint(exercise):
    hints = [mistake.hint for mistake in exercise.known]
    assert 3 <= len(set(hints)) == len(hints), "its .hints has at least three mistakes, each with a hint of its own"
    assert not any("return " in hint or len(hint) > 140 for hint in hints), "a hint is short, and not the code"
    for seed in SEEDS:
        inputs = exercise.draw(np.random.default_rng(seed))
        assert fault(exercise, inputs, answers_of(exercise.solution, inputs)) is None
        for mistake in exercise.known:
            for function in mistake.functions:
                assert fault(exercise, inputs, answers_of(function, inputs)) == mistake.hint


@pytest.mark.parametrize("exercise", [e for e in EXERCISES if e.example], ids=lambda exercise: exercise.number)
def test_the_solution_gives_the_answer_of_the_example_that_the_task_shows(exercise):
    arguments, answer = exercise.example
    found = exercise.solution(*[np.array(value) if isinstance(value, list) else value for value in arguments])
    for value, shown in zip(parts(found), parts(answer), strict=True):
        decimals = max((len(digits) for digits in re.findall(r"\.(\d+)", str(shown))), default=6)
        np.testing.assert_allclose(value, shown, rtol=0, atol=0.5001 * 10.0**-decimals)


FORMS = {
    "lists": lambda values: values.tolist() if values.size else values,
    "tuples": lambda values: tuple(values.tolist()) if values.ndim and values.size else values,
    "single precision": lambda values: values.astype(np.float32),
    "arrays of one number": lambda values: np.atleast_1d(values),
}


@every_exercise
def test_it_has_a_right_answer_by_another_way(exercise):
    assert exercise.number in [number for number, _ in RIGHT_ANSWERS], "add one in tests/lessons/right_answers"


@every_exercise
def test_the_right_values_pass_in_another_form(exercise):
    """So right_answers/ needs no variants of this kind. Exercises with `verify` have theirs there."""
    if exercise.verify is not None:
        pytest.skip("this exercise has many right answers")
    inputs = exercise.draw(np.random.default_rng(0))
    wanted = answers_of(exercise.solution, inputs)
    for name, form in FORMS.items():
        changed = [[form(np.asarray(part)) for part in parts(right)] for right in wanted]
        answers = [new if isinstance(right, tuple) else new[0] for new, right in zip(changed, wanted, strict=True)]
        assert fault(exercise, inputs, answers) is None, name


@pytest.mark.parametrize(("number", "answer"), RIGHT_ANSWERS, ids=lambda given: given if isinstance(given, str) else "")
def test_another_way_to_the_right_values_passes(number, answer):
    """One other way an exercise; more only where `verify` takes values of many kinds."""
    verdict = judge(find_exercise(number), answer, seed=1)
    assert verdict.status == "right", verdict.message
