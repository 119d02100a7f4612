"""Compiling loops: what the fast forms of rendering and likelihood have in common."""

from __future__ import annotations

import contextlib
from collections.abc import Callable

from numba import njit


def compiled(fastmath: bool | set[str] = True) -> Callable[[Callable], Callable]:
    """Decorator: Numba compiles the function at its first call; threads run it side by side (without Python's lock).

    fastmath: what the compiler may take liberties with, all of it or LLVM's flags. Compiled code is kept beside the
    source or in the user's cache. Where it cannot be kept, or what was kept is damaged, each process compiles anew.
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
    """A step of Numba's cache that gives None, as where nothing is kept, when it fails: a damaged file, a full disk."""

    def tried(*arguments: object) -> object:
        with contextlib.suppress(Exception):
            return step(*arguments)

    return tried
