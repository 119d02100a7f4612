"""Explain a wrong answer in a sentence: a known mistake, a wrong order, type or shape, a NaN or an infinity."""

from __future__ import annotations

import copy
import itertools
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # because `exercises` imports this module
    from course_lib.lessons.kit.exercises import Exercise


MISSING_RETURN = "Your function returns None: does every way through it end in `return`?"

SINGLE_PRECISION = 1e-5
"""Tolerance [-] for answers in float32, which has seven digits."""


def hint(exercise: Exercise, arguments: list[tuple], answers: list, wanted: list) -> str:
    """Return the hint for wrong answers to a list of inputs. It shows neither the inputs nor the right values."""
    if any(answer is None for answer in answers):
        return MISSING_RETURN
    if (sentence := known_mistake(exercise, arguments, answers)) is not None:
        return sentence
    if _only_reordered(answers, wanted, exercise.tolerance):
        return "The values are right, but in another order than the task names them."
    inf_is_an_answer = any(np.isinf(np.asarray(w, dtype=np.float64)).any() for right in wanted for w in _parts(right))
    for answer, right in zip(answers, wanted, strict=True):
        if (sentence := _difference(answer, right, inf_is_an_answer)) is not None:
            return sentence
    right = sum(agree(a, w, exercise.tolerance) for a, w in zip(answers, wanted, strict=True))
    if right:
        return (
            f"Right on {right} of {len(answers)} inputs, wrong on {len(answers) - right}: which case is left out? "
            "Try small inputs of your own: equal values, zeros, both signs, the ends of the range."
        )
    return "Shape and type fit, but the values differ on every input. Work one small case by hand and compare."


def known_mistake(exercise: Exercise, arguments: list[tuple], answers: list) -> str | None:
    """Return the hint of the known mistake that gives exactly these answers, or None."""
    for mistake in exercise.mistakes:
        for function in mistake.functions:
            slips = [function(*copy.deepcopy(given)) for given in arguments]
            if agree_all(answers, slips, exercise.tolerance):
                return mistake.hint
    return None


def _only_reordered(answers: list, wanted: list, tolerance: float) -> bool:
    """Return whether all answers hold the right values in the same wrong order."""
    if not isinstance(wanted[0], tuple) or not all(_is_row_of(len(wanted[0]), answer) for answer in answers):
        return False
    return any(
        all(agree(a, tuple(w[k] for k in order), tolerance) for a, w in zip(answers, wanted, strict=True))
        for order in itertools.permutations(range(len(wanted[0])))
    )


def _difference(answer: object, right: object, inf_is_an_answer: bool) -> str | None:
    """Return a sentence about a wrong type or shape, or an unexpected NaN or infinity. Return None if all are right."""
    if isinstance(right, tuple) and not _is_row_of(len(right), answer):
        size = f" of {len(answer)}" if isinstance(answer, tuple | list) or getattr(answer, "ndim", 0) else ""
        return f"Return {len(right)} values, separated by commas; yours returns a {kind_of(answer)}{size}."
    for a, r in zip(answer if isinstance(right, tuple) else (answer,), _parts(right), strict=True):
        values = _shaped(_as_numbers(a), r)
        if values is None:
            return f"Return numbers; yours returns a {kind_of(a)}."
        if values.shape != np.shape(r):
            return f"The result must have shape {np.shape(r)}; yours has {values.shape}."
        if (np.isinf(r) & np.isnan(values)).any() and not (np.isfinite(r) & np.isnan(values)).any():
            return "Yours is nan where inf is expected."
        if np.isnan(values).any() and not np.isnan(r).any():
            return "There is a NaN in your result: look for 0/0, inf - inf or the logarithm of a negative number."
        if inf_is_an_answer and (np.isinf(values) & ~np.isinf(r)).any():
            return "Yours is inf where a finite number is expected."
        if inf_is_an_answer and (np.isinf(r) & np.isnan(values)).any():
            return "Yours is NaN where inf is expected."
        if inf_is_an_answer and (np.isinf(r) & ~np.isinf(values)).any():
            return "Yours is a finite number where inf is expected."
        if np.isinf(values).any() and not inf_is_an_answer:
            return "There is an infinity in your result: look for a division by zero."
    return None


def _parts(right: object) -> tuple:
    return right if isinstance(right, tuple) else (right,)


def _is_row_of(n: int, answer: object) -> bool:
    """Return whether an answer is a tuple, a list or an array of length n."""
    if isinstance(answer, np.ndarray) and answer.ndim == 0:
        return False
    return isinstance(answer, tuple | list | np.ndarray) and len(answer) == n


def agree_all(answers: list, wanted: list, tolerance: float) -> bool:
    """Return whether each answer agrees with the wanted one."""
    return all(agree(answer, right, tolerance) for answer, right in zip(answers, wanted, strict=True))


def agree(answer: object, right: object, tolerance: float) -> bool:
    """Return whether an answer has the right shape, and the right values within the tolerance.

    If a number is wanted, an array with this single number is right as well.
    """
    if isinstance(right, tuple):
        return _is_row_of(len(right), answer) and all(
            agree(a, r, tolerance) for a, r in zip(answer, right, strict=True)
        )
    values = _shaped(_as_numbers(answer), right)
    if values is None or values.shape != np.shape(right):
        return False
    if getattr(answer, "dtype", None) in (np.float16, np.float32):
        tolerance = max(tolerance, SINGLE_PRECISION)
    return bool(np.allclose(values.astype(np.float64), right, rtol=tolerance, atol=tolerance, equal_nan=True))


def _shaped(values: np.ndarray | None, right: object) -> np.ndarray | None:
    """Return `values`. If a single number is wanted, drop the axes of length one."""
    return values.reshape(()) if values is not None and values.size == 1 and np.shape(right) == () else values


def _as_numbers(value: object) -> np.ndarray | None:
    """Return the value as a float array, or None if it is not real numbers (text, None, ragged lists, complex)."""
    try:
        array = np.asarray(value)
    except ValueError:
        return None
    return array.astype(np.float64) if array.dtype.kind in "biuf" else None


def kind_of(value: object) -> str:
    """Return the name of a value's type, such as "float"."""
    return type(value).__name__
