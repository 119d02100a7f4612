"""Fresh processes that compute for this one, and end with it: a killed command leaves nothing running.

A pool of Python's own waits for work for ever when the process that it worked for is killed: each worker holds both
ends of the queue that it reads from. Here each watches a pipe whose other end that process alone holds; the system
closes it however the process ends, on every system.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from multiprocessing.connection import Connection, wait

_ENDS_S = 10.0
"""Seconds after which a worker that should end is no longer waited for: it ends by itself, a busy machine or not."""


class _Pool(ProcessPoolExecutor):
    """Its workers are begun with Ctrl-C withheld, which reaches all of a terminal's processes: they end with this one.

    From their first moment on, in which Python would answer it with a traceback already.
    """

    def submit(self, *call: object, **named: object) -> Future:
        if not hasattr(signal, "pthread_sigmask"):
            return super().submit(*call, **named)
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            return super().submit(*call, **named)  # which begins a worker where none waits
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextlib.contextmanager
def worker_pool(
    n_workers: int, start_worker: Callable[..., None] | None = None, arguments: tuple = ()
) -> Iterator[ProcessPoolExecutor]:
    """An executor of `n_workers` fresh processes, each of which calls `start_worker(*arguments)` first.

    Fresh, because a fork would inherit windows and threads that it cannot use. Where the body raises, Ctrl-C included,
    the workers end at once, in the middle of what they do.
    """
    watched, held = multiprocessing.Pipe(duplex=False)
    with watched, held:
        pool = _Pool(n_workers, multiprocessing.get_context("spawn"), _begin, (watched, start_worker, arguments))
        others = multiprocessing.active_children()
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            held.close()
            for worker in set(multiprocessing.active_children()).difference(others):
                worker.join(_ENDS_S)  # what it had open is free then, and can be cleared
            raise
        pool.shutdown()


def end_with_parent() -> None:
    """Ends this process, which `multiprocessing` started afresh, as soon as the one that started it has ended."""
    _end_when_ready(multiprocessing.parent_process().sentinel)


def _end_when_ready(watched: Connection | int) -> None:
    """Ends this process, whatever it does, as soon as the other end of a pipe is closed; nothing is ever sent."""

    def wait_and_end() -> None:
        wait([watched])
        os._exit(1)

    threading.Thread(target=wait_and_end, daemon=True).start()


def _begin(watched: Connection, start_worker: Callable[..., None] | None, arguments: tuple) -> None:
    _end_when_ready(watched)
    if start_worker is not None:
        start_worker(*arguments)
