"""`check` on an exercise made for the test: what it says of every kind of answer, and what it never says."""

import re

import numpy as np
import pytest

from course_lib.lessons.kit.exercises import (
    Exercise,
    UnknownExerciseError,
    check,
    find_exercise,
    is_stub,
    judge,
    lesson_numbers,
)


def double(x):
    """Twice x."""
    return 2 * x


def ends(x):
    """Least and greatest."""
    return x.min(), x.max()


def total_of(x):
    """The sum."""
    return float(x.sum())


MISTAKES = """
    2 * x => x + 0
    You return what you were given.
    2 * x => x**2
    You square.
"""
DOUBLE = Exercise("99.1", double, lambda rng: (rng.normal(size=(2, 3)),), mistakes=MISTAKES)
PAIR = Exercise("99.2", ends, lambda rng: (rng.normal(size=4),))


def stub(x):
    """A task."""
    ...


def stub_without_docstring(x): ...


def says(function, exercise=DOUBLE) -> str:
    return judge(exercise, function).message


def test_a_stub_is_not_attempted():
    assert judge(DOUBLE, stub).status == "not attempted"
    assert judge(DOUBLE, stub_without_docstring).status == "not attempted"
    assert judge(DOUBLE, lambda x: ...).status == "not attempted"


def test_a_function_that_does_something_is_no_stub():
    def forgot_return(x):
        y = 2 * x  # noqa: F841

    assert is_stub(stub)
    assert not is_stub(forgot_return)
    assert not is_stub(lambda x: x)
    assert not is_stub(np.sin)
    assert "returns None" in says(forgot_return)


def test_another_way_to_the_same_values_is_right():
    assert judge(DOUBLE, lambda x: x + x).status == "right"
    assert judge(DOUBLE, lambda x: (x + x).tolist()).status == "right"
    assert judge(DOUBLE, lambda x: (x * 2).astype(np.float32) * 1.0).status == "right"


def test_values_slightly_off_are_wrong():
    assert judge(DOUBLE, lambda x: 2.0001 * x).status == "wrong"


def test_right_on_some_inputs_only_is_wrong():
    verdict = judge(DOUBLE, lambda x: 2 * x if x.sum() > 0 else x + 1)
    assert verdict.status == "wrong"
    assert re.search(r"Right on (\d+) of 24 inputs, wrong on (\d+): which case is left out\?", verdict.message)
    right, wrong = map(int, re.findall(r"\d+", verdict.message)[::2])
    assert right + wrong == 24
    assert 0 < right < 24


def test_wrong_on_every_input_asks_for_a_small_case():
    assert "Work one small case by hand" in says(lambda x: np.exp(x))


def test_an_infinity_is_blamed_on_a_division_only_where_none_is_right():
    hole = Exercise("99.4", lambda x: np.where(x < 0, np.inf, x), lambda rng: (rng.normal(size=9),))
    assert "division by zero" in says(lambda x: x * np.inf)
    assert "inf where a finite number is expected" in says(lambda x: np.where(x < 0.5, np.inf, x), hole)
    assert "nan where inf is expected" in says(lambda x: np.where(x < 0, np.nan, x), hole)
    assert "a finite number where inf is expected" in says(lambda x: np.abs(x), hole)


def test_each_mistake_gets_its_hint():
    assert says(lambda x: x) == "not yet. You return what you were given."
    assert says(lambda x: x * x) == "not yet. You square."


def test_an_error_names_itself_and_the_students_line():
    def fails(x):
        y = x + 1
        return y[7]

    assert "IndexError in its line 3" in says(fails)
    assert "TypeError" in says(lambda: 1)


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda x: x[0], "must have shape (2, 3); yours has (3,)"),
        (lambda x: 1.0, "yours has ()"),
        (lambda x: "two", "returns a str"),
        (lambda x: [[1, 2], [3]], "returns a list"),
        (lambda x: 2j * x, "returns a ndarray"),
        (lambda x: x * np.nan, "NaN"),
        (lambda x: x * np.inf, "infinity"),
        (lambda x: None if x.sum() > 0 else 2 * x, "returns None"),
        (5, "without calling it; this is a int"),
    ],
)
def test_answers_of_a_wrong_kind_get_their_own_message(function, words):
    with np.errstate(invalid="ignore"):
        assert words in says(function)


def test_a_number_may_come_in_an_array_of_one():
    total = Exercise("99.5", total_of, lambda rng: (rng.normal(size=3),))
    assert judge(total, lambda x: x.sum(keepdims=True)).status == "right"
    assert judge(total, lambda x: [[x.sum()]]).status == "right"
    assert "must have shape ()" in says(lambda x: [x.sum(), x.sum()], total)
    assert judge(DOUBLE, lambda x: np.atleast_3d(2 * x)).status == "wrong"


def test_single_precision_passes_and_single_precision_digits_in_double_do_not():
    third = Exercise("99.6", lambda x: x / 3, lambda rng: (1e3 * rng.normal(size=3),), tolerance=1e-9)
    assert judge(third, lambda x: np.float32(x) / np.float32(3)).status == "right"
    assert judge(third, lambda x: (np.float32(x) / np.float32(3)).astype(float)).status == "wrong"
    assert judge(third, lambda x: np.float32(x) / np.float32(3) * np.float32(1.0001)).status == "wrong"


def test_cases_are_in_every_check_before_the_random_inputs():
    corner = Exercise("99.7", double, DOUBLE.inputs, cases=(lambda rng: (np.zeros(0),),))
    for seed in range(4):
        assert corner.draw(np.random.default_rng(seed))[0][0].size == 0
        assert judge(corner, lambda x: 2 * x, seed).status == "right"
        verdict = judge(corner, lambda x: 2 * x if x.size else x - np.ones(1).sum() + np.zeros((1, 0)), seed)
        assert verdict.status == "wrong"


def test_another_estimator_that_the_task_allows_passes_and_a_mixture_does_not():
    middle = Exercise("99.8", np.median, lambda rng: (rng.normal(size=9),), others=(lambda x: float(x.mean()),))
    assert judge(middle, np.median).status == "right"
    assert judge(middle, lambda x: sum(x) / len(x)).status == "right"
    assert judge(middle, lambda x: np.median(x) if x[0] > 0 else x.mean()).status == "wrong"


def one_more(limit):
    """A number above the limit."""
    return limit + 1


def test_an_exercise_with_many_right_answers_is_verified():
    def larger(arguments, answer):
        return None if np.asarray(answer) > arguments[0] else "Yours is not above the limit."

    above = Exercise(
        "99.9",
        one_more,
        lambda rng: (rng.normal(),),
        mistakes="limit + 1 => limit\nEqual is not above.",
        verify=larger,
    )
    assert judge(above, lambda limit: limit + 0.5).status == "right"
    assert judge(above, lambda limit: 100.0).status == "right"
    assert "not above the limit" in says(lambda limit: limit - 1, above)
    assert "Equal is not above." in says(lambda limit: limit, above)
    assert "returns None" in says(lambda limit: print(limit), above)


def test_what_the_function_prints_is_shown_once_and_not_for_every_input(capsys):
    check("03.1", lambda b, near, far: print("seen") or b + 1)
    printed = capsys.readouterr().out
    assert printed.count("seen") == 1
    assert printed.startswith("(your function prints) seen\n03.1: not yet.")


def test_changing_the_input_is_noticed():
    def in_place(x):
        x *= 2
        return x

    assert "changes the array" in says(in_place)


def test_several_values_are_compared_one_by_one():
    assert judge(PAIR, lambda x: (x.min(), x.max())).status == "right"
    assert judge(PAIR, lambda x: [x.min(), x.max()]).status == "right"
    assert judge(PAIR, lambda x: np.array([x.min(), x.max()])).status == "right"
    assert judge(PAIR, lambda x: (x.max(), x.min())).status == "wrong"
    assert "in another order" in says(lambda x: (x.max(), x.min()), PAIR)
    assert "Return 2 values, separated by commas; yours returns a float64." in says(lambda x: x.min(), PAIR)
    assert "returns a tuple of 3." in says(lambda x: (x.min(), x.max(), 0), PAIR)
    assert "returns a ndarray of 1." in says(lambda x: np.array([x.min()]), PAIR)
    assert "returns a ndarray." in says(lambda x: np.array(x.min()), PAIR)


def test_check_prints_one_line_and_shows_neither_inputs_nor_reference(capsys):
    exercise = find_exercise("03.1")
    rng = np.random.default_rng(0)
    given = exercise.inputs(rng)
    for function in (stub, exercise.solution, exercise.known[0].functions[0], lambda b, near, far: b + 1):
        check("03.1", function)
        printed = capsys.readouterr().out
        assert printed.count("\n") == 1
        assert printed.startswith("03.1: ")
        for number in [*given[0].ravel(), *exercise.solution(*given).ravel()]:
            if 0 < number < 1:
                assert f"{number:.4f}" not in printed


def test_an_unknown_number_names_those_that_there_are():
    assert "03" in lesson_numbers()
    for number in ("03.9", "77.1", "", 3.1):
        with pytest.raises(UnknownExerciseError, match=r"there are .*03\.1"):
            check(number, stub)


def test_inputs_of_one_seed_are_always_the_same():
    first, second = (DOUBLE.inputs(np.random.default_rng(5))[0] for _ in range(2))
    assert np.array_equal(first, second)
