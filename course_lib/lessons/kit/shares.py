"""A share of a few trials as lessons print it, with Wilson's interval, which lesson 08 explains."""

from __future__ import annotations

from course_lib.experiments.intervals import wilson_percent


def share_text(hits: int, n: int, digits: int = 0) -> str:
    """Such as "5 of 11 = 45 % (21 to 72 %)": hits of n, the share, its 95 % interval; digits: of the percentages.

    Raises `ValueError` where there is nothing to take a share of.
    """
    if not 0 <= hits <= n or n < 1:
        raise ValueError(f"a share needs 0 <= hits <= n and n at least 1; got {hits} of {n}")
    low, high = wilson_percent(int(hits), int(n))
    return f"{hits} of {n} = {100 * hits / n:.{digits}f} % ({low:.{digits}f} to {high:.{digits}f} %)"
