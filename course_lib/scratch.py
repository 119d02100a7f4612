"""Folders for a while, in the system's temporary folder: gone with the run, or, where it was killed, with the next run.

Each is locked while its process lives (`course_lib.unfinished`): what lies there unlocked was left behind.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from course_lib.unfinished import held, locked_folder

_USER = os.geteuid() if hasattr(os, "geteuid") else 0
PREFIX = f"course-scratch-{_USER}-"
"""Of this user's folders: nobody else's is looked at."""


@contextlib.contextmanager
def scratch_folder() -> Iterator[Path]:
    """An empty folder for a while. What killed runs of this user left goes first. Raises `OSError`."""
    clear_scratch()
    try:
        lock, folder = locked_folder(Path(tempfile.gettempdir()), PREFIX)
    except BaseException:  # Ctrl-C between making it and knowing its name
        clear_scratch()
        raise
    try:
        # What is being made beside `work` goes with it. Not in `folder` itself, whose lock is taken: who puts something
        # in place beside it locks the folder around it, and would wait for this process, which is itself.
        work = folder / "around" / "work"
        work.mkdir(parents=True)
        yield work
    finally:
        try:
            remove(folder)
        finally:
            os.close(lock)


def clear_scratch() -> None:
    """Removes the folders of this user's processes that have ended."""
    with contextlib.suppress(OSError):
        for left in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
            with held(left) as orphaned, contextlib.suppress(OSError):
                if orphaned and left.is_dir() and left.stat().st_uid == _USER:
                    remove(left)


def remove(folder: Path) -> None:
    """Remove a folder and all in it, whatever rights its files have; what cannot be removed stays."""

    def once_more(function: Callable, path: str, _: object) -> None:
        with contextlib.suppress(OSError):
            os.chmod(path, 0o700)
            function(path)

    if folder.exists():
        shutil.rmtree(folder, onerror=once_more)
