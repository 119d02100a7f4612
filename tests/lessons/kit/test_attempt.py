"""A student's function that exits, never ends, prints without end or breaks off is a verdict; the lesson goes on."""

import sys
import threading
import time

import pytest

from courseware.lessons.kit.attempt import MAX_CHARACTERS, attempt


def endless():
    while True:
        try:
            endless.x = 1
        except Exception:
            pass


def swallows_one_stop():
    try:
        endless()
    except BaseException:
        endless()


def fails():
    y = 1
    return y[7]


def again(x=0):
    return again(x + 1)


def floods():
    while True:
        print("here")


def interrupted():
    raise KeyboardInterrupt


def test_a_value_comes_back_with_what_was_printed(capsys):
    assert attempt(lambda x: print("seen", x) or 2 * x, (3,)) == (6, None, "seen 3\n")
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (fails, "stops with TypeError in its line 3: 'int' object is not subscriptable."),
        (lambda: sys.exit("done"), "exit()"),
        (again, "calls itself without end"),
        (floods, "prints more than"),
        (endless, "does not end within 0.2 seconds"),
        (swallows_one_stop, "does not end"),
    ],
)
def test_whatever_a_function_does_is_a_sentence_and_the_thread_lives_on(function, words):
    result = attempt(function, (), seconds=0.2)
    assert words in result.failure
    assert len(result.printed) <= MAX_CHARACTERS
    assert attempt(lambda: sum(range(1000)), ()).value == 499500


def test_no_stop_arrives_after_the_call_and_the_stop_button_is_not_swallowed():
    before = set(threading.enumerate())  # other tests may have left some
    for _ in range(20):
        attempt(lambda: time.sleep(0.01), (), seconds=0.01)
        time.sleep(0.002)
    assert set(threading.enumerate()) <= before
    with pytest.raises(KeyboardInterrupt):
        attempt(interrupted, ())
