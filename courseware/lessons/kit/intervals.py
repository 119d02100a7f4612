"""Medians and shares as lessons print them, each with its 95 % interval. Lesson 08 explains both intervals."""

import numpy as np

from courseware.experiments.intervals import wilson_percent

DRAWS, SEED = 2000, 1  # a fixed seed, so that the same values always print the same interval


def bootstrap_median(values: np.ndarray) -> tuple[float, float]:
    """Return the 95 % interval (low, high) of the median of independent `values` (n,), in their unit.

    The bootstrap draws n values with replacement, `DRAWS` times, and takes the median of each draw. Raises `ValueError`
    for fewer than two values. Source: Efron and Tibshirani, An Introduction to the Bootstrap.
    """
    values = np.asarray(values, dtype=np.float64).ravel()
    if len(values) < 2:
        raise ValueError(f"an interval needs at least two values; got {len(values)}")
    medians = np.median(np.random.default_rng(SEED).choice(values, (DRAWS, len(values))), axis=1)
    return tuple(np.percentile(medians, (2.5, 97.5)).tolist())


def median_text(values: np.ndarray, digits: int = 3, unit: str = "m") -> str:
    """Return the median of `values` (n,) with its interval, such as "0.041 m (0.032 to 0.058)"."""
    if len(values) < 2:
        return f"{values[0]:.{digits}f} {unit} (one value)" if len(values) else "no number (of no values)"
    low, high = bootstrap_median(values)
    return f"{np.median(values):.{digits}f} {unit} ({low:.{digits}f} to {high:.{digits}f})"


def share_text(hits: int, n: int, digits: int = 0) -> str:
    """Return the share hits / n with Wilson's interval, such as "5 of 11 = 45 % (21 to 72 %)".

    digits: decimals of the percentages. Raises `ValueError` unless 0 <= hits <= n and n >= 1.
    """
    if not 0 <= hits <= n or n < 1:
        raise ValueError(f"a share needs 0 <= hits <= n and n at least 1; got {hits} of {n}")
    low, high = wilson_percent(int(hits), int(n))
    return f"{hits} of {n} = {100 * hits / n:.{digits}f} % ({low:.{digits}f} to {high:.{digits}f} %)"
