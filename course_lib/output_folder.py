"""A folder of outputs, replaced as a whole: all that one run of a command made is there, or all of an earlier run's.

`replaced_outputs` gives a run a folder to fill, beside the place where it is to go (`course_lib.unfinished`), and puts
it there in one step; a list in the folder tells what which command made, so that what is somebody else's stays.
`staged` is for files that go one by one into a folder where somebody works; `require_writable` tries a folder first.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

from course_lib.unfinished import (
    UNFINISHED,
    begun_folder,
    clear_unfinished,
    cleared_if_stopped,
    complete,
    finish,
    flush_below,
    mode_of,
    removed_at_the_end,
    sync_folder,
)
from course_lib.writing import FULL, told, write_error

try:
    import fcntl
except ImportError:  # Windows has no locks on folders
    fcntl = None

MADE = ".course-made.json"
"""In a folder of outputs: what which command made there. Its next run takes away what it does not make again."""

_TRIAL_BYTES = 1 << 16
"""What must fit where results are to go: less than any command writes, more than a full disk takes."""

_EXCHANGE = 2  # RENAME_EXCHANGE of Linux's renameat2
_HERE = -100  # AT_FDCWD


@contextlib.contextmanager
def replaced_outputs(out: str | Path, command: str | None, products: Sequence[str] = ()) -> Iterator[Path]:
    """An empty folder to fill; at the end all of it takes the place of what an earlier run of `command` left in `out`.

    command: None where no list of what was made is to be kept, since `products` says it all. products: names in `out`
    that are wholly this command's, whoever made what is there. What else is in `out` stays. If the body raises, `out`
    is as it was. Where the system can exchange two folders (Linux) that is one step; else, and where `out` is a mount
    or the folder one stands in, the files change places one by one, each whole, and a run that is killed in between is
    completed by the next. Raises `WriteError`.
    """
    out = Path(os.path.realpath(out))
    with cleared_if_stopped(out):
        with told(out):
            out.parent.mkdir(parents=True, exist_ok=True)
            inside = out.is_dir() and (os.path.ismount(out) or _stands_in(out))
            complete(out)
            clear_unfinished(out)
            lock, beside = begun_folder(out if inside else out.parent, out.name)
        with removed_at_the_end(lock, beside, out):
            new = beside / "new"
            with told(out):
                new.mkdir()
                new.chmod(mode_of(out, 0o777))
            try:
                yield new
            except OSError as error:
                if error.errno in FULL:  # matplotlib and others do not say of which file
                    raise write_error(out, error) from error
                raise
            with told(out), _alone_in(out.parent):
                _put_in_place(new, out, command, inside, products)


@contextlib.contextmanager
def staged(folder: str | Path) -> Iterator[Path]:
    """An empty folder inside `folder`, which must be there: for files to be moved from it to their places one by one.

    At the end it is gone, with what was not moved; what a killed run left of its own goes first. Raises `WriteError`.
    """
    folder = Path(os.path.realpath(folder))
    with cleared_if_stopped(folder):
        with told(folder):
            clear_unfinished(folder)
            lock, within = begun_folder(folder, folder.name)
        with removed_at_the_end(lock, within, folder):
            yield within


def require_writable(folder: str | Path) -> None:
    """Raises `WriteError` unless something can be written into `folder`, or it can be made: before the work, not after.

    Tried, not asked: a root user is told yes where even root may not write, and a full disk says nothing at all.
    """
    folder = Path(os.path.realpath(folder))
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    nearest = missing[-1].parent if missing else folder
    name = missing[-1].name if missing else folder.name
    with told(folder), cleared_if_stopped(nearest / name if missing else folder):
        clear_unfinished(nearest / name if missing else folder)
        lock, within = begun_folder(nearest, name)
        with removed_at_the_end(lock, within, folder):
            (within / "trial").write_bytes(bytes(_TRIAL_BYTES))


def _put_in_place(new: Path, out: Path, command: str, inside: bool, products: Sequence[str]) -> None:
    """The folder `new` in place of `out`, with what else is there."""
    made = sorted(path.relative_to(new).as_posix() for path in new.rglob("*") if not path.is_dir())
    earlier = _made(out)
    if command is not None:
        (new / MADE).write_text(json.dumps(earlier | {command: made}, indent=1) + "\n", encoding="utf-8")
    earlier_products = (path for name in products for path in (out / name, *(out / name).rglob("*")) if path.is_file())
    gone = {path.relative_to(out).as_posix() for path in earlier_products}.union(earlier.get(command, ())) - set(made)
    flush_below(new)
    if not inside:
        if not out.exists():
            os.rename(new, out)
            return sync_folder(out.parent)
        _keep_the_others(out, new, gone, products)
        if _exchange(new, out):
            return sync_folder(out.parent)
        for path in sorted(new.rglob("*")):  # no exchange here: only what is new changes places
            if path.is_file() and path.relative_to(new).as_posix() not in {*made, MADE}:
                path.unlink()
        lock, within = begun_folder(out, out.name)
        with removed_at_the_end(lock, within, out):
            shutil.move(new, within / "new")
            return finish(within, out, gone)
    return finish(new.parent, out, gone)


def _keep_the_others(out: Path, new: Path, gone: set[str], products: Sequence[str]) -> None:
    """What is in `out` and was not made anew, into `new` as well: as a second name of the same file where that goes."""
    for folder, inner_folders, names in os.walk(out):
        inner = Path(folder).relative_to(out)
        if any(UNFINISHED in part for part in inner.parts):
            continue
        if inner.parts and inner.parts[0] not in products and not (new / inner).exists():
            (new / inner).mkdir()
            (new / inner).chmod(mode_of(out / inner))
        links = [name for name in inner_folders if (Path(folder) / name).is_symlink()]
        for name in (*names, *links):
            old, target = Path(folder) / name, new / inner / name
            if (inner / name).as_posix() in gone or target.exists() or UNFINISHED in name:
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            try:
                os.link(old, target, follow_symlinks=False)
            except OSError:
                shutil.copy2(old, target, follow_symlinks=False)


def _made(out: Path) -> dict[str, list[str]]:
    """What which command made in `out`, never of another folder; nothing where that is not told."""
    try:
        found = json.loads((out / MADE).read_text(encoding="utf-8"))
        return {
            command: [name for name in names if (out / name).parent.resolve().is_relative_to(out)]
            for command, names in found.items()
        }
    except (OSError, ValueError, AttributeError, TypeError):
        return {}


def _exchange(one: Path, other: Path) -> bool:
    """Exchange the names of two folders in one step; False where this system cannot."""
    try:
        renameat2 = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError, TypeError):
        return False
    return renameat2(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0


def _stands_in(folder: Path) -> bool:
    """Whether this process, and so its caller's shell, stands in a folder or below: it must not become another one."""
    try:
        return Path.cwd().is_relative_to(folder)
    except OSError:  # it stands nowhere any more
        return False


@contextlib.contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """One process at a time puts something in place in a folder: each sees what the other one made.

    In an unfinished folder there is no other process, and its lock is taken: by this one, which would wait for itself.
    """
    handle = os.open(folder, os.O_RDONLY) if fcntl and UNFINISHED not in folder.name else None
    try:
        if handle is not None:
            with contextlib.suppress(OSError):
                fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        if handle is not None:
            os.close(handle)
