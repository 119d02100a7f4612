"""A student's function called once, so that whatever it does comes back as a value or as a sentence.

It may stop with an error, call `exit()`, never end, or print without end: the notebook lives on, and the verdict says
which it was. The time limit works on every system, in the kernel's own thread, on whatever runs in Python; a single
call into a compiled library is left to end by itself.
"""

from __future__ import annotations

import contextlib
import ctypes
import io
import threading
import traceback
from collections.abc import Callable
from dataclasses import dataclass

SECONDS = 20.0
"""Longest time that one call may take: answers take milliseconds, also on a slow and busy machine."""

CHARACTERS = 20_000
"""Most that one call may print."""


@dataclass(frozen=True)
class Attempt:
    """What came of one call: `value`, or a sentence in `failure`; and what it `printed`."""

    value: object = None
    failure: str | None = None
    printed: str = ""


class _OutOfTime(BaseException):
    """Raised inside a function that takes too long; no `except Exception` of its own stops it."""


class _PrintsWithoutEnd(BaseException):
    """Raised by the print that is one too many."""


class _Bounded(io.StringIO):
    """Keeps what is printed, and stops whoever prints without end."""

    def write(self, text: str) -> int:
        if self.tell() + len(text) > CHARACTERS:
            raise _PrintsWithoutEnd
        return super().write(text)


def attempt(function: Callable, arguments: tuple, seconds: float = SECONDS) -> Attempt:
    """Call `function(*arguments)`; an interrupt by the user (Ctrl-C, the stop button) passes through."""
    printed = _Bounded()
    try:
        with contextlib.redirect_stdout(printed), _limited(seconds):
            return Attempt(function(*arguments), None, printed.getvalue())
    except _OutOfTime:
        failure = f"does not end within {seconds:g} seconds: does every loop come closer to its end?"
    except _PrintsWithoutEnd:
        failure = f"prints more than {CHARACTERS:,} characters in one call: is there a print inside a loop?"
    except SystemExit:
        failure = "calls exit() or quit(): that would end the program. End with `return`."
    except KeyboardInterrupt:
        raise
    except RecursionError:
        failure = "calls itself without end: when does it stop?"
    except BaseException as error:  # also what a student derives from BaseException
        failure = f"stops with {_described(error, function)}."
    return Attempt(None, failure, printed.getvalue())


@contextlib.contextmanager
def _limited(seconds: float):
    """Raise `_OutOfTime` in this thread after so many seconds, and again every second while the code goes on."""
    thread, lock, ended = threading.get_ident(), threading.Lock(), threading.Event()

    def watch() -> None:
        wait = seconds
        while not ended.wait(wait):
            with lock:  # never after the end: the exception would hit whoever runs next
                if not ended.is_set():
                    _raise_in(thread, _OutOfTime)
            wait = 1.0

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        with lock:
            ended.set()
            _raise_in(thread, None)  # takes back what was raised and has not arrived
        watcher.join()


def _raise_in(thread: int, error: type[BaseException] | None) -> None:
    asynchronous = ctypes.py_object(error) if error is not None else None
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), asynchronous)


def _described(error: BaseException, function: Callable) -> str:
    """Type and first line of an error, and the line of the student's function where it came up."""
    code = getattr(function, "__code__", None)
    frames = traceback.walk_tb(error.__traceback__)
    lines = [line - code.co_firstlineno + 1 for frame, line in frames if frame.f_code is code]
    where = f" in its line {lines[0]}" if lines else ""
    text = (str(error).splitlines() or [""])[0]
    return f"{type(error).__name__}{where}" + (f": {text}" if text else "")
