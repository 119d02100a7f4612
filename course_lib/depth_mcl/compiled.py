"""Compiling loops: what the fast forms of rendering and likelihood have in common."""

from __future__ import annotations

from collections.abc import Callable

from numba import njit


def compiled(fastmath: bool | set[str] = True) -> Callable[[Callable], Callable]:
    """Decorator: Numba compiles the function at its first call; threads run it side by side (without Python's lock).

    fastmath: what the compiler may take liberties with, all of it or LLVM's flags. Compiled code is kept beside the
    source or in the user's cache; where neither can be written, every process compiles for itself.
    """

    def decorate(function: Callable) -> Callable:
        try:
            return njit(nogil=True, fastmath=fastmath, cache=True)(function)
        except RuntimeError:  # Numba's, where it has no place to keep code in
            return njit(nogil=True, fastmath=fastmath)(function)

    return decorate
