"""Compile loops: the fast forms of rendering, likelihood and refinement."""

import contextlib
import logging
import sys
from collections.abc import Callable

from numba import njit
from numba.core import event
from numba.core.caching import FunctionCache

COMPILED: set[Callable] = set()  # the functions below, so that other people's compiled functions are not announced


def compiled(fastmath: bool | set[str] = True) -> Callable[[Callable], Callable]:
    """Return a decorator: Numba compiles the function at its first call, and threads may run it at the same time.

    Compiled code is kept next to the source or in the user's cache. Where it cannot be, each process compiles again.
    """

    def decorate(function: Callable) -> Callable:
        COMPILED.add(function)
        fast = njit(nogil=True, fastmath=fastmath)(function)
        with contextlib.suppress(RuntimeError):  # Numba has no folder to keep code in
            fast._cache = ForgivingCache(function)
        return fast

    return decorate


class ForgivingCache(FunctionCache):
    """Numba's cache of one function on disk. A damaged file counts as none, and where nothing can be written, we go on.

    Numba's own class raises then. Its `Dispatcher.enable_caching` sets `_cache` in the same way, and calls no other
    method of it during a run (read in Numba 0.68.1).
    """

    def load_overload(self, *signature: object) -> object:
        """Return the compiled code that is kept for a signature, or None."""
        with contextlib.suppress(Exception):
            return super().load_overload(*signature)

    def save_overload(self, *signature_and_code: object) -> None:
        """Keep compiled code, if possible."""
        with contextlib.suppress(Exception):
            super().save_overload(*signature_and_code)


class _Announcement(event.Listener):
    """Says once that this process compiles loops of this library, which takes seconds (`beyond.warm_up` does it early).

    Numba's event "numba:compile" begins only where no compiled code was kept.
    """

    def __init__(self) -> None:
        self._is_made = False

    def on_start(self, event: event.Event) -> None:
        """Say it to the user of a terminal as a warning, else to the log."""
        if not self._is_made and event.data["dispatcher"].py_func in COMPILED:
            level = logging.WARNING if sys.stderr.isatty() else logging.INFO
            logging.getLogger("course_lib").log(level, "compiling loops for this computer: this takes some seconds")
            self._is_made = True

    def on_end(self, event: event.Event) -> None:
        """Say nothing: the call that follows shows that compiling has ended."""


event.register("numba:compile", _Announcement())
