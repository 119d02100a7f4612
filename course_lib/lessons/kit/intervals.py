"""Error bars of medians over few values, as lessons print them: the bootstrap, which lesson 08 explains.

Shares have Wilson's interval: `course_lib.experiments.intervals.wilson_percent`.
"""

from __future__ import annotations

import numpy as np

DRAWS = 2000
SEED = 1  # of the draws with replacement: the same interval every time


def bootstrap_median(values: np.ndarray) -> tuple[float, float]:
    """95 % interval (low, high) of the median of independent `values` (n,): medians of sets drawn with replacement.

    Raises `ValueError` for fewer than two values. Source: Efron and Tibshirani, An Introduction to the Bootstrap.
    """
    values = np.asarray(values, dtype=np.float64).ravel()
    if len(values) < 2:
        raise ValueError(f"an interval needs at least two values; got {len(values)}")
    medians = np.median(np.random.default_rng(SEED).choice(values, (DRAWS, len(values))), axis=1)
    low, high = np.percentile(medians, (2.5, 97.5))
    return float(low), float(high)


def median_text(values: np.ndarray, digits: int = 3, unit: str = "m") -> str:
    """The median of `values` with its interval, such as "0.041 m (0.032 to 0.058)"; fewer than two have none."""
    if len(values) < 2:
        return f"{values[0]:.{digits}f} {unit} (one value)" if len(values) else "no number (of no values)"
    low, high = bootstrap_median(values)
    return f"{np.median(values):.{digits}f} {unit} ({low:.{digits}f} to {high:.{digits}f})"
