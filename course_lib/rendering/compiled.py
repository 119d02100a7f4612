"""Compiling loops: the fast forms of rendering, likelihood and refinement."""

import contextlib
from collections.abc import Callable

from numba import njit


def compiled(fastmath: bool | set[str] = True) -> Callable[[Callable], Callable]:
    """Return a decorator: Numba compiles the function at its first call, and threads run it side by side.

    Compiled code is kept beside the source or in the user's cache. Where it cannot be, each process compiles anew.
    """

    def decorate(function: Callable) -> Callable:
        try:
            fast = njit(nogil=True, fastmath=fastmath, cache=True)(function)
        except RuntimeError:  # Numba has no folder to keep code in
            return njit(nogil=True, fastmath=fastmath)(function)
        fast._cache.load_overload = _or_none(fast._cache.load_overload)
        fast._cache.save_overload = _or_none(fast._cache.save_overload)
        return fast

    return decorate


def _or_none(step: Callable) -> Callable:
    """Return a step of Numba's cache that gives None when it fails: a full disk, a damaged file."""

    def tried(*arguments: object) -> object:
        with contextlib.suppress(Exception):
            return step(*arguments)

    return tried
