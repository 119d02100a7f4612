"""A progress bar that leaves no trace in a stored notebook.

tqdm writes its timings to the error stream, and they differ from run to run, so a stored notebook must not keep them.
Here one output shows tqdm's line and is updated in place. Its first and its last state are equal: no HTML, and a
constant line of text. nbval compares the first state, and a stored notebook keeps the last state, so both agree.
"""

import html
import io
from collections.abc import Iterable, Iterator

from IPython import get_ipython
from IPython.display import display
from tqdm import tqdm


class _OutputLine(io.StringIO):
    """A file for tqdm. Its latest line becomes the content of one notebook output."""

    def __init__(self, description: str) -> None:
        super().__init__()
        self._at_rest = {"text/plain": f"progress: {description}", "text/html": ""}
        self._handle = display(self._at_rest, raw=True, display_id=True)

    def write(self, text: str) -> int:
        if line := text.strip("\r\n "):
            self._handle.update(self._at_rest | {"text/html": f"<pre>{html.escape(line)}</pre>"}, raw=True)
        return len(text)

    def clear(self) -> None:
        self._handle.update(self._at_rest, raw=True)


def progress(iterable: Iterable, description: str, total: int | None = None) -> Iterator:
    """Iterate with a progress bar. Use it for a task of more than two seconds. Outside a notebook it is plain tqdm."""
    options = {"desc": description, "total": total, "leave": False}
    if get_ipython() is None:
        yield from tqdm(iterable, **options)
        return
    line = _OutputLine(description)
    try:
        yield from tqdm(iterable, **options, file=line, ncols=80, mininterval=0.2)
    finally:
        line.clear()
