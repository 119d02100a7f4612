"""Graded tests: full, half and no points on a secret seed's inputs; feedback that gives nothing away; nothing heard."""

import io
import logging
import os
import subprocess
import sys
import warnings

import numpy as np
import pytest

from course_lib.classroom import graded_tests
from course_lib.classroom.graded_tests import grade, points, secret, silence
from course_lib.classroom.points import points_of
from course_lib.lessons.kit.exercises import find_exercise

SEED = 98_765_432_101


def right(hidden, alpha):
    return (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)


def right_for_three(hidden, alpha):
    return right(hidden, alpha) if len(hidden) == 3 else -hidden


def right_up_to_five(hidden, alpha):
    return right(hidden, alpha) if len(hidden) <= 5 else -hidden


def stub(hidden, alpha):
    """Differences."""
    ...


def test_all_points_half_and_none():
    assert grade("06.1", right, SEED) == (2.0, "right.")
    assert grade("06.1", right_up_to_five, SEED).points == 1.0
    assert "Right on some inputs" in grade("06.1", right_up_to_five, SEED).sentence
    assert grade("06.1", right_for_three, SEED).points == 0.0
    assert grade("06.1", stub, SEED) == (0.0, "not attempted.")
    assert grade("06.1", lambda hidden, alpha: ..., SEED) == (0.0, "not attempted.")
    assert grade("06.1", 3.0, SEED).sentence == "not yet. A function is asked; this is a float."


def test_a_typical_mistake_is_answered_with_its_hint():
    exercise = find_exercise("06.1")
    found = grade("06.1", exercise.known[0].functions[0], SEED)
    assert found == (0.0, f"not yet. {exercise.known[0].hint}")


def test_the_inputs_are_the_secret_seeds_and_no_others():
    seen = {seed: [] for seed in (0, SEED, SEED + 1)}
    for seed, kept in seen.items():
        grade("06.1", lambda hidden, alpha, kept=kept: kept.append(hidden) or right(hidden, alpha), seed)
    first = [kept[3].tolist() for kept in seen.values()]
    check = [given[0].tolist() for given in find_exercise("06.1").draw(np.random.default_rng(0))]
    assert len({str(one) for one in first}) == 3
    assert first[0] not in check, "a class's seed 0 is not the seed of the course's own check"
    assert secret(SEED, "06.1") != secret(SEED, "06.2")
    again = []
    grade("06.1", lambda hidden, alpha: again.append(hidden) or right(hidden, alpha), SEED)
    assert [one.tolist() for one in again] == [one.tolist() for one in seen[SEED]]


def raises_its_inputs(hidden, alpha):
    raise ValueError(f"the inputs were {hidden} {alpha}")


def raises_an_error_named_by_its_inputs(hidden, alpha):
    raise type(f"E{str(hidden[0]).replace('.', '_')}", (Exception,), {})


def prints_its_inputs(hidden, alpha):
    print(hidden)
    return hidden


def stops_now_and_then(hidden, alpha):
    return right(hidden, alpha) if len(hidden) < 6 else hidden[99]


def quits(hidden, alpha):
    raise SystemExit


def changes_its_input(hidden, alpha):
    hidden *= 2
    return hidden


def forgets_to_return(hidden, alpha):
    right(hidden, alpha)


@pytest.mark.parametrize(
    ("function", "sentence"),
    [
        (raises_its_inputs, "not yet. Your function stops with ValueError."),
        (raises_an_error_named_by_its_inputs, "not yet. Your function stops with an error."),
        (prints_its_inputs, "not yet. Not right on any input."),
        (stops_now_and_then, "not yet. Your function stops with IndexError on some inputs."),
        (quits, "not yet. Your function calls exit() or quit()."),
        (changes_its_input, "not yet. Your function changes the array it was given."),
        (forgets_to_return, "not yet. Your function returns None."),
    ],
)
def test_the_feedback_says_the_kind_and_no_word_of_the_students(function, sentence, capsys):
    points("06.1", function, SEED)
    assert capsys.readouterr().out == f"06.1: {sentence}\n"


def test_what_stops_on_some_inputs_keeps_half(capsys):
    assert points("06.1", stops_now_and_then, SEED) == 1.0


def test_an_endless_loop_is_stopped_once_and_the_rest_is_wrong(monkeypatch):
    monkeypatch.setattr(graded_tests, "CALL_SECONDS", 2.0)
    calls = []

    def never_ends(hidden, alpha):
        calls.append(hidden)
        while len(calls) > 20:
            pass
        return right(hidden, alpha)

    assert grade("06.1", never_ends, SEED) == (1.0, "not yet. Your function does not end on some inputs.")
    assert len(calls) == 21


def test_nothing_of_an_answer_is_heard(capfd, caplog):
    handler = logging.StreamHandler()  # keeps the stream itself

    def noisy(hidden, alpha):
        print("to standard output")
        print("to the error stream", file=sys.stderr)
        os.write(1, b"below Python\n")
        os.write(2, b"below Python\n")
        warnings.warn("a warning", stacklevel=1)
        handler.stream.write("kept from before\n")
        subprocess.run(["sh", "-c", "echo another process >&2"], check=True)
        sys.displayhook(6.0)
        return right(hidden, alpha)

    assert points("06.1", noisy, SEED) == 2.0
    assert capfd.readouterr() == ("06.1: right.\n", "")


def test_afterwards_everything_is_heard_again(capfd):
    shown = sys.displayhook
    with silence():
        pass
    assert sys.displayhook is shown
    print("a word")
    print("an error", file=sys.stderr)
    os.write(2, b"below\n")
    assert capfd.readouterr() == ("a word\n", "an error\nbelow\n")


def test_a_stream_that_was_kept_by_somebody_is_as_it_was(monkeypatch):
    class Stream(io.StringIO):
        """Like the kernel's own: takes attributes."""

    stream = Stream()
    monkeypatch.setattr(sys, "stderr", stream)
    with silence():
        stream.write("unheard")
        print("unheard", file=sys.stderr)
    stream.write("heard")
    assert stream.getvalue() == "heard"
    assert "write" not in vars(stream)


@pytest.mark.parametrize("number", ["00.1", "12.4", "18.3", "P2.2", "P4.7"])
def test_the_reference_has_all_points_on_other_seeds(number):
    exercise = find_exercise(number)
    for seed in (1, SEED):
        assert grade(number, exercise.solution, seed) == (points_of(exercise), "right.")
