"""A progress bar that leaves nothing behind.

tqdm writes to the error stream, and a stored notebook would keep its timings, which differ from run to run. Here its
line goes into one output that is updated in place, and the last update is the same as the first display: empty but for
a text of one constant line. So nbval, which looks at the first display only, and a stored notebook, which keeps the
last update only, see the same.
"""

from __future__ import annotations

import html
from collections.abc import Iterable, Iterator

from IPython import get_ipython
from IPython.display import display
from tqdm import tqdm


class _OutputLine:
    """What tqdm takes for a file: its latest line becomes the content of one notebook output."""

    def __init__(self, description: str) -> None:
        self._at_rest = {"text/plain": f"progress: {description}", "text/html": ""}
        self._handle = display(self._at_rest, raw=True, display_id=True)

    def write(self, text: str) -> None:
        line = text.strip("\r\n ")
        if line:
            self._handle.update(self._at_rest | {"text/html": f"<pre>{html.escape(line)}</pre>"}, raw=True)

    def flush(self) -> None:
        """tqdm calls it; there is nothing to flush."""

    def clear(self) -> None:
        """Back to what was displayed first."""
        self._handle.update(self._at_rest, raw=True)


def progress(iterable: Iterable, description: str, total: int | None = None) -> Iterator:
    """Iterate with a progress bar: for whatever takes more than two seconds. Outside a notebook it is plain tqdm."""
    if get_ipython() is None:
        yield from tqdm(iterable, desc=description, total=total, leave=False)
        return
    line = _OutputLine(description)
    try:
        yield from tqdm(iterable, desc=description, total=total, leave=False, file=line, ncols=80, mininterval=0.2)
    finally:
        line.clear()
