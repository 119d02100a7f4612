"""Call a student's function once and return its value, or a sentence that says how the call failed.

The function may raise an error, call `exit()`, run forever or print forever. The time limit works on every operating
system. It cannot interrupt a single call into a compiled library, so we wait until that call ends.
"""

import contextlib
import ctypes
import io
import threading
import traceback
from collections.abc import Callable
from typing import NamedTuple

TIME_LIMIT = 20.0  # of one call [s]; right answers take milliseconds, even on a slow and busy machine
MAX_CHARACTERS = 20_000  # that one call may print


class Attempt(NamedTuple):
    """The result of one call: its `value`, or a sentence in `failure`. `printed` holds the printed text."""

    value: object = None
    failure: str | None = None
    printed: str = ""


class _TimeLimitExceeded(BaseException):
    """Stops a function that takes too long. The function's own `except Exception` cannot catch it."""


class _PrintLimitExceeded(BaseException):
    """Stops a function that prints more than `MAX_CHARACTERS`."""


class _LimitedOutput(io.StringIO):
    def write(self, text: str) -> int:
        if self.tell() + len(text) > MAX_CHARACTERS:
            raise _PrintLimitExceeded
        return super().write(text)


def attempt(function: Callable, arguments: tuple, seconds: float = TIME_LIMIT) -> Attempt:
    """Call `function(*arguments)` with a time limit [s]. Raises KeyboardInterrupt if the user interrupts the call."""
    printed = _LimitedOutput()
    try:
        with contextlib.redirect_stdout(printed), _time_limit(seconds):
            return Attempt(function(*arguments), None, printed.getvalue())
    except _TimeLimitExceeded:
        failure = f"does not end within {seconds:g} seconds: does every loop come closer to its end?"
    except _PrintLimitExceeded:
        failure = f"prints more than {MAX_CHARACTERS:,} characters in one call: is there a print inside a loop?"
    except SystemExit:
        failure = "calls exit() or quit(): that would end the program. End with `return`."
    except KeyboardInterrupt:
        raise
    except RecursionError:
        failure = "calls itself without end: when does it stop?"
    except BaseException as error:  # a student may derive an error from BaseException
        failure = f"stops with {_describe_error(error, function)}."
    return Attempt(None, failure, printed.getvalue())


@contextlib.contextmanager
def _time_limit(seconds: float):
    """Raise `_TimeLimitExceeded` in this thread after so many seconds, then every second until the code stops."""
    thread, lock, ended = ctypes.c_ulong(threading.get_ident()), threading.Lock(), threading.Event()
    raise_in = ctypes.pythonapi.PyThreadState_SetAsyncExc

    def watch() -> None:
        wait = seconds
        while not ended.wait(wait):
            with lock:  # after the end, the exception would hit the code that runs next
                if not ended.is_set():
                    raise_in(thread, ctypes.py_object(_TimeLimitExceeded))
            wait = 1.0

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        with lock:
            ended.set()
            raise_in(thread, None)  # cancel an exception that was raised but has not arrived
        watcher.join()


def _describe_error(error: BaseException, function: Callable) -> str:
    """Return an error's type, the line of the student's function that caused it, and the first line of its message."""
    code = getattr(function, "__code__", None)
    frames = traceback.walk_tb(error.__traceback__)
    lines = [line - code.co_firstlineno + 1 for frame, line in frames if frame.f_code is code]
    where = f" in its line {lines[0]}" if lines else ""
    text = (str(error).splitlines() or [""])[0]
    return f"{type(error).__name__}{where}" + (f": {text}" if text else "")
