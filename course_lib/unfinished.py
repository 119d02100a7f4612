"""What is being made lies beside its place, under a name of its own and locked, until it is whole and on the disk.

`course_lib.writing` makes a file so, `course_lib.output_folder` a folder. The lock ends with the process, whatever ends
it: so what lies there unlocked is what a killed run left. The next run removes it, or, where all of it was made and
some has moved to its place already, moves the rest. What somebody is still writing is locked, and stays.
"""

from __future__ import annotations

import contextlib
import glob
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows: nothing is cleared there that might be somebody's
    fcntl = None

UNFINISHED = ".course-unfinished-"
"""In the name of whatever is being made: `.NAME.course-unfinished-XXXXXXXX` beside NAME."""


def begun_file(parent: Path, name: str) -> tuple[int, Path]:
    """A new file beside `name`, locked: its handle, open for writing, which holds the lock, and its path."""
    return _begun(lambda: tempfile.mkstemp(dir=parent, prefix=f".{name}{UNFINISHED}"))


def begun_folder(parent: Path, name: str) -> tuple[int, Path]:
    """A new folder beside or in `name`, locked: the handle that holds the lock, and the folder."""
    return locked_folder(parent, f".{name}{UNFINISHED}")


def locked_folder(parent: Path, prefix: str) -> tuple[int, Path]:
    """A new folder whose name begins with `prefix`, locked: the handle that holds the lock, and the folder."""

    def make() -> tuple[int, str] | None:
        path = tempfile.mkdtemp(dir=parent, prefix=prefix)
        try:
            return os.open(path if fcntl else os.devnull, os.O_RDONLY), path
        except FileNotFoundError:  # taken for left over already
            return None

    return _begun(make)


def _begun(make: Callable[[], tuple[int, str] | None]) -> tuple[int, Path]:
    """What `make` makes, (handle, path), locked until the handle is closed, by whatever end of this process.

    Between making and locking, another process may have taken it for left over: then it is made once more.
    """
    while True:
        if (made := make()) is None:
            continue
        handle, path = made
        if fcntl is None:
            return handle, Path(path)
        try:
            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(handle, fcntl.LOCK_EX)
            with contextlib.suppress(FileNotFoundError):
                if os.path.samestat(os.stat(path), os.fstat(handle)):
                    return handle, Path(path)
        except BaseException:  # Ctrl-C: a lock that nobody knows of would keep it here
            os.close(handle)
            raise
        os.close(handle)


@contextlib.contextmanager
def held(path: Path) -> Iterator[bool]:
    """Holds what nobody is writing any more, so that one process alone clears it; False where somebody is."""
    if fcntl is None or path.is_symlink():
        yield False
        return
    try:
        handle = os.open(path, os.O_RDONLY)
    except OSError:
        yield False
        return
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        free = True
    except OSError:
        free = False
    try:
        yield free
    finally:
        os.close(handle)


def clear_unfinished(path: Path) -> None:
    """Removes what killed runs left of `path`, or completes it: as every write does first, for who has none to do."""
    path = Path(os.path.realpath(path))
    for folder in (path.parent, path):
        for left in folder.glob(f".{glob.escape(path.name)}{UNFINISHED}*") if folder.is_dir() else ():
            with held(left) as orphaned:
                if orphaned:
                    _settle(left, path)


@contextlib.contextmanager
def cleared_if_stopped(path: Path) -> Iterator[None]:
    """Ctrl-C comes between any two steps, such as making a file and knowing its name: then what is left goes here."""
    try:
        yield
    except BaseException:
        with contextlib.suppress(OSError):
            clear_unfinished(path)
        raise


@contextlib.contextmanager
def removed_at_the_end(lock: int, beside: Path, out: Path) -> Iterator[None]:
    """A folder of ours is gone afterwards, and its lock free; an error that keeps what is whole from moving is told.

    lock, beside: as `begun_folder` gave them. out: the folder that `beside` was begun for.
    """
    try:
        yield
    finally:
        try:
            _settle(beside, out)
        finally:
            os.close(lock)


def _settle(left: Path, out: Path) -> None:
    """Removes what was begun, or, where all of it was made and some has moved into `out` already, moves the rest."""
    if (left / "gone.json").is_file():
        _move_all(left, out)
    elif left.is_dir():
        shutil.rmtree(left, ignore_errors=True)
    else:
        left.unlink(missing_ok=True)


def finish(beside: Path, out: Path, gone: set[str]) -> None:
    """Say that `beside` is complete, so that another run can go on with it, and move what is in it into `out`.

    What is to move lies in `beside`/new. gone: names in `out` that are to go away. Raises `OSError`.
    """
    unfinished = beside / "gone.part"
    unfinished.write_text(json.dumps(sorted(gone)), encoding="utf-8")
    flush_below(beside)
    unfinished.rename(beside / "gone.json")
    _move_all(beside, out)


def complete(out: Path) -> None:
    """Finish what a killed run had begun to move into `out`. Raises `OSError`."""
    for beside in out.glob(f".*{UNFINISHED}*") if out.is_dir() else ():
        with held(beside) as orphaned:
            if orphaned and (beside / "gone.json").is_file():
                _move_all(beside, out)


def _move_all(beside: Path, out: Path) -> None:
    """What lies finished in `beside`/new into `out`, a file at a time, and what is gone away: may be done again."""
    new = beside / "new"
    for path in sorted(new.rglob("*")):
        target = out / path.relative_to(new)
        if path.is_dir():
            target.mkdir(exist_ok=True)
            target.chmod(mode_of(path))
        else:
            os.replace(path, target)
    for name in json.loads((beside / "gone.json").read_text(encoding="utf-8")):
        (out / name).unlink(missing_ok=True)
    sync_folder(out)
    shutil.rmtree(beside, ignore_errors=True)


def mode_of(path: Path, usual: int = 0o666) -> int:
    """The mode of a file or folder that is there, else what a new one gets here."""
    if path.exists():
        return path.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return usual & ~mask


def flush_below(folder: Path) -> None:
    """See that everything in a folder is on the disk; `write_at_once` and `replaced_outputs` do so themselves."""
    for path in folder.rglob("*"):
        if path.is_file() and not path.is_symlink():
            with path.open("rb") as file:
                os.fsync(file.fileno())
    sync_folder(folder)


def sync_folder(folder: Path) -> None:
    """See that the names in a folder are on the disk, where the system opens folders."""
    with contextlib.suppress(OSError):  # not every system opens folders
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
