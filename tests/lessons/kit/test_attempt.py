"""A student's function that exits, never ends, prints without end or breaks off is a verdict; the lesson goes on."""

import sys
import threading
import time

import pytest

from course_lib.lessons.kit.attempt import MAX_CHARACTERS, attempt


def endless():
    while True:
        pass


def test_a_value_comes_back_with_what_was_printed(capsys):
    result = attempt(lambda x: print("seen", x) or 2 * x, (3,))
    assert (result.value, result.failure, result.printed) == (6, None, "seen 3\n")
    assert capsys.readouterr().out == ""


def test_an_error_is_described_by_its_type_and_the_students_line():
    def fails(x):
        y = x + 1
        return y[7]

    assert attempt(fails, (1,)).failure == "stops with TypeError in its line 3: 'int' object is not subscriptable."


@pytest.mark.parametrize("leave", [sys.exit, exit, lambda: sys.exit("done")])
def test_leaving_the_program_is_a_verdict(leave):
    assert "exit()" in attempt(lambda: leave(), ()).failure


def test_a_loop_without_end_is_stopped_and_the_thread_lives_on():
    assert "does not end within 0.2 seconds" in attempt(endless, (), seconds=0.2).failure
    assert attempt(lambda: sum(range(1000)), ()).value == 499500


def test_a_loop_that_catches_everything_is_stopped_as_well():
    def stubborn():
        while True:
            try:
                endless()
            except Exception:
                pass

    assert "does not end" in attempt(stubborn, (), seconds=0.2).failure


def test_what_swallows_the_first_stop_meets_another():
    stops = []

    def swallows():
        try:
            endless()
        except BaseException as error:
            stops.append(type(error).__name__)
        endless()

    assert "does not end" in attempt(swallows, (), seconds=0.2).failure
    assert stops == ["_TimeLimitExceeded"]


def test_no_stop_arrives_after_the_call():
    before = set(threading.enumerate())  # other tests may have left some
    for _ in range(20):
        attempt(lambda: time.sleep(0.01), (), seconds=0.01)
        time.sleep(0.002)
    assert set(threading.enumerate()) <= before


def test_a_flood_of_prints_is_a_verdict():
    def floods():
        while True:
            print("here")

    result = attempt(floods, ())
    assert "prints more than" in result.failure
    assert len(result.printed) <= MAX_CHARACTERS


def test_endless_recursion_is_a_verdict():
    def again(x):
        return again(x + 1)

    assert "calls itself without end" in attempt(again, (0,)).failure


def test_the_stop_button_is_not_swallowed():
    def interrupted():
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        attempt(interrupted, ())
