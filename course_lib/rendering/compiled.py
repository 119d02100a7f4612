"""Compiling loops: the fast forms of rendering, likelihood and refinement."""

import contextlib
import logging
import sys
from collections.abc import Callable
from functools import cache

from numba import njit


def compiled(fastmath: bool | set[str] = True) -> Callable[[Callable], Callable]:
    """Return a decorator: Numba compiles the function at its first call, and threads run it side by side.

    Compiled code is kept beside the source or in the user's cache. Where it cannot be, each process compiles anew.
    """

    def decorate(function: Callable) -> Callable:
        try:
            fast = njit(nogil=True, fastmath=fastmath, cache=True)(function)
        except RuntimeError:  # Numba has no folder to keep code in
            fast = njit(nogil=True, fastmath=fastmath)(function)
        load = _or_none(fast._cache.load_overload)
        fast._cache.load_overload = lambda *signature: load(*signature) or _announce()
        fast._cache.save_overload = _or_none(fast._cache.save_overload)
        return fast

    return decorate


@cache  # so that a process says it once
def _announce() -> None:
    """Say that compiling begins, on a terminal or to a log (`beyond.warm_up` does it before the first image)."""
    level = logging.WARNING if sys.stderr.isatty() else logging.INFO
    logging.getLogger("course_lib").log(level, "compiling loops for this computer, once: this takes some seconds")


def _or_none(step: Callable) -> Callable:
    """Return a step of Numba's cache that gives None when it fails: a full disk, a damaged file."""

    def tried(*arguments: object) -> object:
        with contextlib.suppress(Exception):
            return step(*arguments)

    return tried
