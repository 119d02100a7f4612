"""SIGTERM and SIGHUP end a command as Ctrl-C does: what it began is cleared, and its children end.

Without this the system would end the process where it stands, and leave what it made for a while to the next run.
"""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator

SIGNALS = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
SHELLS_ADD = 128
"""To a signal's number, for the exit code of what it ended."""


class ToldToEndError(KeyboardInterrupt):
    """A signal asked this process to end. `exit_code` is what a shell reports of it."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.exit_code = SHELLS_ADD + number


@contextlib.contextmanager
def told_to_end() -> Iterator[None]:
    """Raises `ToldToEndError` from the body when SIGTERM or SIGHUP comes; one that is ignored (nohup) stays so."""

    def end(number: int, _: object) -> None:
        raise ToldToEndError(number)

    earlier = {}
    if threading.current_thread() is threading.main_thread():
        for number in SIGNALS:
            if signal.getsignal(number) is signal.SIG_DFL:
                earlier[number] = signal.signal(number, end)
    try:
        yield
    finally:
        for number, handler in earlier.items():
            signal.signal(number, handler)
