"""`check` on an exercise made for the test: what it says of every kind of answer, and what it never says."""

import re

import numpy as np
import pytest

from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.exercises import (
    NOT_ATTEMPTED,
    SEE_CHECK,
    UnknownExerciseError,
    Verdict,
    check,
    fault,
    find_exercise,
    is_stub,
    judge,
    right_on,
    signed,
)


def double(x):
    """Twice x."""
    return 2 * x


def one_more(limit):
    """A number above the limit."""
    return limit + 1


MISTAKES = """
    2 * x => x + 0
    You return what you were given.
"""
DOUBLE = Exercise("99.1", double, lambda rng: (rng.normal(size=(2, 3)),), mistakes=MISTAKES)
PAIR = Exercise("99.2", lambda x: (x.min(), x.max()), lambda rng: (rng.normal(size=4),))
HOLE = Exercise("99.3", lambda x: np.where(x < 0, np.inf, x), lambda rng: (rng.normal(size=9),))
TOTAL = Exercise("99.4", lambda x: float(x.sum()), lambda rng: (rng.normal(size=3),))
THIRD = Exercise("99.5", lambda x: x / 3, lambda rng: (1e3 * rng.normal(size=3),), tolerance=1e-9)
MIDDLE = Exercise("99.6", np.median, lambda rng: (rng.normal(size=9),), others=(lambda x: float(x.mean()),))
ABOVE = Exercise(
    "99.7", one_more, lambda rng: (rng.normal(),), mistakes="limit + 1 => limit\nEqual is not above.",
    verify=lambda given, answer: None if np.asarray(answer) > given[0] else "Yours is not above the limit.",
)  # fmt: skip
CORNER = Exercise("99.8", TOTAL.solution, TOTAL.inputs, cases={"an empty list": lambda rng: (np.zeros(0),)})


def stub(x):
    """A task."""
    ...


def stub_without_docstring(x): ...


def forgot_return(x):
    y = 2 * x  # noqa: F841


def fails(x):
    y = x + 1
    return y[7]


def in_place(x):
    x *= 2
    return x


@pytest.mark.parametrize("function", [stub, stub_without_docstring, lambda x: ...])
def test_a_stub_is_not_attempted(function):
    assert judge(DOUBLE, function).status == "not attempted"
    assert not any(map(is_stub, (forgot_return, lambda x: x, np.sin)))


@pytest.mark.parametrize(
    ("exercise", "function"),
    [
        (DOUBLE, lambda x: x + x),
        (DOUBLE, lambda x: (x + x).tolist()),
        (THIRD, lambda x: np.float32(x) / np.float32(3)),
        (TOTAL, lambda x: x.sum(keepdims=True)),
        (TOTAL, lambda x: [[x.sum()]]),
        (PAIR, lambda x: np.array([x.min(), x.max()])),
        (MIDDLE, lambda x: sum(x) / len(x)),
        (ABOVE, lambda limit: limit + 0.5),
    ],
)
def test_another_way_to_the_same_values_is_right(exercise, function):
    assert judge(exercise, function).message == "right."


@pytest.mark.parametrize(
    ("exercise", "function", "words"),
    [
        (DOUBLE, lambda x: x, "not yet. You return what you were given."),
        (DOUBLE, lambda x: 2.0001 * x, "Nearly right"),
        (DOUBLE, fails, "IndexError in its line 3"),
        (DOUBLE, lambda x: None if x.sum() > 0 else 2 * x, "returns None"),
        (DOUBLE, in_place, "changes the array"),
        (DOUBLE, lambda x: x[0], "must have shape (2, 3); yours has (3,)"),
        (DOUBLE, lambda x: "two", "returns a str"),
        (DOUBLE, lambda x: [[1, 2], [3]], "returns a list"),
        (DOUBLE, lambda x: x * np.nan, "There is a NaN"),
        (DOUBLE, lambda x: x * np.inf, "division by zero"),
        (DOUBLE, 5, "without calling it; this is a int"),
        (HOLE, lambda x: np.where(x < 0.5, np.inf, x), "inf where a finite number is expected"),
        (HOLE, lambda x: np.where(x < 0, np.nan, x), "nan where inf is expected"),
        (HOLE, np.abs, "a finite number where inf is expected"),
        (TOTAL, lambda x: [x.sum(), x.sum()], "must have shape ()"),
        (THIRD, lambda x: (np.float32(x) / np.float32(3)).astype(float), "Nearly right"),
        (PAIR, lambda x: (x.max(), x.min()), "in another order"),
        (PAIR, lambda x: x.min(), "Return 2 values, separated by commas; yours returns a float64."),
        (PAIR, lambda x: np.array([x.min()]), "returns a ndarray of 1."),
        (PAIR, lambda x: np.array(x.min()), "returns a ndarray."),
        (MIDDLE, lambda x: np.median(x) if x[0] > 0 else x.mean(), "which case is left out?"),
        (ABOVE, lambda limit: limit - 1, "not yet. Yours is not above the limit."),
        (ABOVE, lambda limit: limit, "not yet. Equal is not above."),
        (ABOVE, print, "returns None"),
        (MIDDLE, lambda x: np.exp(x.min()), "Work one small case by hand"),
    ],
)
def test_a_wrong_answer_gets_its_sentence(exercise, function, words):
    with np.errstate(invalid="ignore"):
        assert words in judge(exercise, function).message


@pytest.mark.parametrize(
    ("exercise", "answer", "sentence"),
    [
        (PAIR, lambda x: (x.max(), x.min()), "The values are right, but in another order than the task names them."),
        (PAIR, lambda x: x.tolist(), "Return 2 values, separated by commas."),
        (DOUBLE, lambda x: x[0], "The result has another shape than the task asks for."),
        (DOUBLE, lambda x: "two", "Return numbers."),
        (CORNER, lambda x: x.sum() if x.size else 1.0, "wrong on a special case: an empty list."),
        (find_exercise("03.4"), lambda corners, near: corners[:1] + near, SEE_CHECK),
        (find_exercise("03.4"), lambda corners, near: corners * [1, 1, -1] - 9, "Some of your corners lie before"),
    ],
)
def test_without_details_a_sentence_holds_nothing_of_the_answers(exercise, answer, sentence):
    arguments = exercise.draw(np.random.default_rng(0))
    said = fault(exercise, arguments, [answer(*given) for given in arguments], details=False)
    assert sentence in said


def test_a_special_case_is_named_and_other_cases_are_counted():
    missed = judge(CORNER, lambda x: x.sum() if x.size else 1.0).message
    assert missed == "not yet. Right on all ordinary inputs, wrong on a special case: an empty list."
    message = judge(DOUBLE, lambda x: 2 * x if x.sum() > 0 else x + 1).message
    right, of, wrong = map(int, re.search(r"Right on (\d+) of (\d+) inputs, wrong on (\d+)", message).groups())
    assert 0 < right < of == right + wrong == 24


def test_check_prints_one_line_and_shows_neither_inputs_nor_reference(capsys):
    exercise = find_exercise("03.1")
    given = exercise.inputs(np.random.default_rng(0))
    for function in (stub, exercise.solution, exercise.known[0].functions[0], lambda b, near, far: b + 1):
        check("03.1", function)
        printed = capsys.readouterr().out
        assert printed.count("\n") == 1
        assert printed.startswith("03.1: ")
        for number in [*given[0].ravel(), *exercise.solution(*given).ravel()]:
            assert not 0 < number < 1 or f"{number:.4f}" not in printed


def test_what_the_function_prints_is_shown_once_and_not_for_every_input(capsys):
    check("03.1", lambda b, near, far: print("seen") or b + 1)
    assert re.match(r"\(your function prints\) seen\n03\.1: not yet\.((?!seen).)*$", capsys.readouterr().out)


@pytest.mark.parametrize("number", ["03.9", "77.1", "", 3.1])
def test_an_unknown_number_names_those_that_there_are(number):
    with pytest.raises(UnknownExerciseError, match=r"there are .*03\.1"):
        check(number, stub)


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


def test_in_a_notebook_an_answer_has_a_sign_and_a_colour_and_elsewhere_plain_words(monkeypatch):
    right, wrong = Verdict("right", "right."), Verdict("wrong", "not yet. Look again.")
    assert (signed(right), signed(wrong)) == ("right.", "not yet. Look again.")
    monkeypatch.setattr("sys.stdout", type("OutStream", (), {"__module__": "ipykernel.iostream"})())
    said = (signed(right), signed(wrong), signed(NOT_ATTEMPTED))
    monkeypatch.undo()
    assert said == (
        "\x1b[1;32m\u2713 right\x1b[0m.",
        "\x1b[1;31m\u2717 not yet\x1b[0m. Look again.",
        NOT_ATTEMPTED.message,
    )
