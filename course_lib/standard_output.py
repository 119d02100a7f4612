"""Standard output that cannot be written to: told once by name, and the command goes on to keep its results."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import TextIO


class ToldOutput:
    """A stream in the place of `sys.stdout`: a full disk is told on standard error, and what follows goes nowhere.

    A reader that has gone (`| head`) is still a `BrokenPipeError`: whoever reads no further wants no further work.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self.failed = False

    def write(self, text: str) -> int:
        """As the stream's."""
        with self._told():
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """As the stream's."""
        with self._told():
            self._stream.flush()

    def __getattr__(self, name: str) -> object:
        return getattr(self._stream, name)

    @contextlib.contextmanager
    def _told(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:
            raise
        except OSError as error:
            self.failed = True
            # What the stream still holds would fail again when Python ends.
            os.dup2(os.open(os.devnull, os.O_WRONLY), self._stream.fileno())
            with contextlib.suppress(OSError):
                print(
                    f"error: what is printed cannot be written to standard output: {error.strerror}. Going on without, "
                    "to the files.",
                    file=sys.stderr,
                )


@contextlib.contextmanager
def told_output() -> Iterator[ToldOutput]:
    """`sys.stdout` as a `ToldOutput` for the while; where it was closed (`>&-`), one that leads nowhere.

    Standard streams that were closed are opened on nothing: else the next file that is opened has their number, and
    what a child process prints lands in it.
    """
    earlier = sys.stdout
    if earlier is None:
        for number in (0, 1, 2):
            _opened_on_nothing(number)
        sys.stdout = os.fdopen(1, "w", encoding="utf-8", closefd=False)
    output = ToldOutput(sys.stdout)
    sys.stdout = output
    try:
        yield output
    finally:
        sys.stdout = earlier if earlier is not None else output


def _opened_on_nothing(number: int) -> None:
    try:
        os.fstat(number)
    except OSError:
        opened = os.open(os.devnull, os.O_RDWR)  # the least number that is free
        if opened != number:
            os.dup2(opened, number)
            os.close(opened)
        os.set_inheritable(number, True)
