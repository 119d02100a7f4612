"""Numbers that differ a little between machines: stored with the tolerance that their cell declares."""

from __future__ import annotations


def about(value: float, usual: float, within: float) -> str:
    """`usual` with its tolerance, such as "0.40 +- 0.05", where `value` lies within it; else `value` and what it is not.

    A processor that rounds other last digits, after many steps, comes to slightly other numbers. The stored text then
    stays the same, and beyond the tolerance it does not: the comparison of stored outputs fails.
    """
    decimals = max(_decimals(usual), _decimals(within))
    told = f"{usual:.{decimals}f} +- {within:.{decimals}f}"
    return told if abs(value - usual) <= within else f"{value:.{decimals + 1}f} (elsewhere {told})"


def _decimals(number: float) -> int:
    """Decimals that a number is written with: 2 for 0.05, 0 for 15."""
    return len(f"{number:.10f}".rstrip("0").partition(".")[2])
