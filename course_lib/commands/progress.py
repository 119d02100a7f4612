"""Progress bars of the command line, on standard error, so that `--json` output stays one object."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable


def progress_bar(description: str, unit: str = "frame") -> Callable[[Iterable], Iterable]:
    """A wrapper that draws a bar while its iterable is consumed."""
    from tqdm import tqdm

    def wrap(iterable: Iterable, total: int | None = None) -> Iterable:
        # Without a terminal one line every ten seconds still tells a log that the run is alive.
        interval = 0.1 if sys.stderr.isatty() else 10.0
        return tqdm(iterable, desc=description, unit=unit, total=total, mininterval=interval, file=sys.stderr)

    return wrap
