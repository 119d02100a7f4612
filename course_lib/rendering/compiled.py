"""Compiling loops: what the fast forms of rendering and likelihood have in common."""

import contextlib
from collections.abc import Callable

from numba import njit


def compiled(fastmath: bool | set[str] = True) -> Callable[[Callable], Callable]:
    """Decorator: Numba compiles the function at its first call; threads run it side by side (without Python's lock).

    Compiled code is kept beside the source or in the user's cache. Where it cannot be, each process compiles anew.
    """

    def decorate(function: Callable) -> Callable:
        try:
            fast = njit(nogil=True, fastmath=fastmath, cache=True)(function)
        except RuntimeError:  # Numba's, where it has no folder to keep code in
            return njit(nogil=True, fastmath=fastmath)(function)
        fast._cache.load_overload = _or_none(fast._cache.load_overload)
        fast._cache.save_overload = _or_none(fast._cache.save_overload)
        return fast

    return decorate


def _or_none(step: Callable) -> Callable:
    """Return the step of Numba's cache such that it gives None, as where nothing is kept, when it fails."""

    def tried(*arguments: object) -> object:
        with contextlib.suppress(Exception):
            return step(*arguments)

    return tried
