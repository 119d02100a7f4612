"""Compare the values that a function returns: shapes, types, tolerances."""

import numpy as np

SINGLE_PRECISION = 1e-5  # tolerance [-] for answers in float32, which has seven digits


def parts(right: object) -> tuple:
    return right if isinstance(right, tuple) else (right,)


def is_row_of(n: int, answer: object) -> bool:
    """Return whether an answer is a tuple, a list or an array of length n."""
    is_row = isinstance(answer, tuple | list) or (isinstance(answer, np.ndarray) and answer.ndim > 0)
    return is_row and len(answer) == n


def agree_all(answers: list, wanted: list, tolerance: float) -> bool:
    """Return whether each answer agrees with the wanted one."""
    return all(agree(answer, right, tolerance) for answer, right in zip(answers, wanted, strict=True))


def agree(answer: object, right: object, tolerance: float) -> bool:
    """Return whether an answer has the right shape, and the right values within the tolerance."""
    if isinstance(right, tuple):
        return is_row_of(len(right), answer) and agree_all(list(answer), list(right), tolerance)
    values = shaped(as_numbers(answer), right)
    if values is None or values.shape != np.shape(right):
        return False
    if getattr(answer, "dtype", None) in (np.float16, np.float32):
        tolerance = max(tolerance, SINGLE_PRECISION)
    return bool(np.allclose(values, right, rtol=tolerance, atol=tolerance, equal_nan=True))


def shaped(values: np.ndarray | None, right: object) -> np.ndarray | None:
    """Return `values`. If a single number is wanted, an array with this number is right, so drop its axes."""
    return values.reshape(()) if values is not None and values.size == 1 and np.shape(right) == () else values


def as_numbers(value: object) -> np.ndarray | None:
    """Return the value as a float array, or None if it is not real numbers (text, None, ragged lists, complex)."""
    try:
        array = np.asarray(value)
    except ValueError:
        return None
    return array.astype(np.float64) if array.dtype.kind in "biuf" else None
