"""The one way to write: a file, or all that one run makes, is there whole or not at all, and never half.

`write_at_once` puts a file in place, `replaced_outputs` a run's outputs as a whole; `staged` is for files that go one
by one into a folder where somebody works. All make what is new beside the old, see that it is on the disk, and change
the name in one step. Whatever stops them (Ctrl-C, a full disk, kill -9), the old is still there; what a killed run left
beside it is cleared by the next one, and by it alone: a file that somebody is still writing is locked, and stays.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import glob
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows: nothing is cleared there that might be somebody's
    fcntl = None

UNFINISHED = ".course-unfinished-"
"""In the name of whatever is being made: `.NAME.course-unfinished-XXXXXXXX` beside NAME."""

MADE = ".course-made.json"
"""In a folder of outputs: what which command made there. Its next run takes away what it does not make again."""

_TRIAL_BYTES = 1 << 16
"""What must fit where results are to go: less than any command writes, more than a full disk takes."""

_EXCHANGE = 2  # RENAME_EXCHANGE of Linux's renameat2
_HERE = -100  # AT_FDCWD


class WriteError(OSError):
    """Something could not be written; says what, why, and that the old is still there."""

    def __str__(self) -> str:
        return str(self.args[0])


def write_at_once(path: str | Path, content: bytes | str) -> None:
    """Write a file, or replace it, in one step; text as UTF-8. Raises `WriteError`; the old file is then still there.

    A link is followed: what it points to is replaced. The folder must be there.
    """
    path = Path(os.path.realpath(path))
    data = content.encode("utf-8") if isinstance(content, str) else content
    with told(path), _cleared_if_stopped(path):
        clear_unfinished(path)
        handle, unfinished = _begun(lambda: tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}{UNFINISHED}"))
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
                os.chmod(unfinished, _mode(path))
                os.replace(unfinished, path)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(unfinished)
            raise
        _sync_folder(path.parent)


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
    with _cleared_if_stopped(out):
        with told(out):
            out.parent.mkdir(parents=True, exist_ok=True)
            inside = out.is_dir() and (os.path.ismount(out) or _stands_in(out))
            _complete(out)
            clear_unfinished(out)
            lock, beside = _begun_folder(out if inside else out.parent, out.name)
        with _removed_at_the_end(lock, beside, out):
            new = beside / "new"
            with told(out):
                new.mkdir()
                new.chmod(_mode(out, 0o777))
            try:
                yield new
            except OSError as error:
                if error.errno in _FULL:  # matplotlib and others do not say of which file
                    raise _write_error(out, error) from error
                raise
            with told(out), _alone_in(out.parent):
                _put_in_place(new, out, command, inside, products)


@contextlib.contextmanager
def staged(folder: str | Path) -> Iterator[Path]:
    """An empty folder inside `folder`, which must be there: for files to be moved from it to their places one by one.

    At the end it is gone, with what was not moved; what a killed run left of its own goes first. Raises `WriteError`.
    """
    folder = Path(os.path.realpath(folder))
    with _cleared_if_stopped(folder):
        with told(folder):
            clear_unfinished(folder)
            lock, within = _begun_folder(folder, folder.name)
        with _removed_at_the_end(lock, within, folder):
            yield within


def require_writable(folder: str | Path) -> None:
    """Raises `WriteError` unless something can be written into `folder`, or it can be made: before the work, not after.

    Tried, not asked: a root user is told yes where even root may not write, and a full disk says nothing at all.
    """
    folder = Path(os.path.realpath(folder))
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    nearest = missing[-1].parent if missing else folder
    name = missing[-1].name if missing else folder.name
    with told(folder), _cleared_if_stopped(nearest / name if missing else folder):
        clear_unfinished(nearest / name if missing else folder)
        lock, within = _begun_folder(nearest, name)
        with _removed_at_the_end(lock, within, folder):
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
            return _sync_folder(out.parent)
        _keep_the_others(out, new, gone, products)
        if _exchange(new, out):
            return _sync_folder(out.parent)
        for path in sorted(new.rglob("*")):  # no exchange here: only what is new changes places
            if path.is_file() and path.relative_to(new).as_posix() not in {*made, MADE}:
                path.unlink()
        lock, within = _begun_folder(out, out.name)
        with _removed_at_the_end(lock, within, out):
            shutil.move(new, within / "new")
            return _finish(within, out, gone)
    return _finish(new.parent, out, gone)


def _finish(beside: Path, out: Path, gone: set[str]) -> None:
    """Say that `beside` is complete, so that another run can go on with it, and move what is in it into `out`."""
    unfinished = beside / "gone.part"
    unfinished.write_text(json.dumps(sorted(gone)), encoding="utf-8")
    flush_below(beside)
    unfinished.rename(beside / "gone.json")
    _move_all(beside, out)


def _keep_the_others(out: Path, new: Path, gone: set[str], products: Sequence[str]) -> None:
    """What is in `out` and was not made anew, into `new` as well: as a second name of the same file where that goes."""
    for folder, inner_folders, names in os.walk(out):
        inner = Path(folder).relative_to(out)
        if any(UNFINISHED in part for part in inner.parts):
            continue
        if inner.parts and inner.parts[0] not in products and not (new / inner).exists():
            (new / inner).mkdir()
            (new / inner).chmod(_mode(out / inner))
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


def _move_all(beside: Path, out: Path) -> None:
    """What lies finished in `beside`/new into `out`, a file at a time, and what is gone away: may be done again."""
    new = beside / "new"
    for path in sorted(new.rglob("*")):
        target = out / path.relative_to(new)
        if path.is_dir():
            target.mkdir(exist_ok=True)
            target.chmod(_mode(path))
        else:
            os.replace(path, target)
    for name in json.loads((beside / "gone.json").read_text(encoding="utf-8")):
        (out / name).unlink(missing_ok=True)
    _sync_folder(out)
    shutil.rmtree(beside, ignore_errors=True)


def _complete(out: Path) -> None:
    """Finish what a killed run had begun to move into `out`."""
    for beside in out.glob(f".*{UNFINISHED}*") if out.is_dir() else ():
        with _held(beside) as orphaned:
            if orphaned and (beside / "gone.json").is_file():
                _move_all(beside, out)


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


def clear_unfinished(path: Path) -> None:
    """Removes what killed runs left of `path`, or completes it: as every write does first, for who has none to do."""
    path = Path(os.path.realpath(path))
    for folder in (path.parent, path):
        for left in folder.glob(f".{glob.escape(path.name)}{UNFINISHED}*") if folder.is_dir() else ():
            with _held(left) as orphaned:
                if orphaned:
                    _settle(left, path)


def _settle(left: Path, out: Path) -> None:
    """Removes what was begun, or, where all of it was made and some has moved into `out` already, moves the rest."""
    if (left / "gone.json").is_file():
        _move_all(left, out)
    elif left.is_dir():
        shutil.rmtree(left, ignore_errors=True)
    else:
        left.unlink(missing_ok=True)


@contextlib.contextmanager
def _removed_at_the_end(lock: int, beside: Path, out: Path) -> Iterator[None]:
    """A folder of ours is gone afterwards, and its lock free; an error that keeps what is whole from moving is told."""
    try:
        yield
    finally:
        try:
            _settle(beside, out)
        finally:
            os.close(lock)


@contextlib.contextmanager
def _cleared_if_stopped(path: Path) -> Iterator[None]:
    """Ctrl-C comes between any two steps, such as making a file and knowing its name: then what is left goes here."""
    try:
        yield
    except BaseException:
        with contextlib.suppress(OSError):
            clear_unfinished(path)
        raise


def _begun_folder(parent: Path, name: str) -> tuple[int, Path]:
    """A new folder beside or in `name`, locked: the handle that holds the lock, and the folder."""

    def make() -> tuple[int, str] | None:
        path = tempfile.mkdtemp(dir=parent, prefix=f".{name}{UNFINISHED}")
        try:
            return os.open(path if fcntl else os.devnull, os.O_RDONLY), path
        except FileNotFoundError:  # taken for left over already
            return None

    handle, path = _begun(make)
    return handle, Path(path)


def _begun(make: Callable[[], tuple[int, str] | None]) -> tuple[int, str]:
    """What `make` makes, (handle, path), locked until the handle is closed, by whatever end of this process.

    Between making and locking, another process may have taken it for left over: then it is made once more.
    """
    while True:
        if (made := make()) is None:
            continue
        handle, path = made
        if fcntl is None:
            return handle, path
        try:
            with contextlib.suppress(OSError):  # a file system without locks
                fcntl.flock(handle, fcntl.LOCK_EX)
            with contextlib.suppress(FileNotFoundError):
                if os.path.samestat(os.stat(path), os.fstat(handle)):
                    return handle, path
        except BaseException:  # Ctrl-C: a lock that nobody knows of would keep it here
            os.close(handle)
            raise
        os.close(handle)


@contextlib.contextmanager
def _held(path: Path) -> Iterator[bool]:
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


def _stands_in(folder: Path) -> bool:
    """Whether this process, and so its caller's shell, stands in a folder or below: it must not become another one."""
    try:
        return Path.cwd().is_relative_to(folder)
    except OSError:  # it stands nowhere any more
        return False


@contextlib.contextmanager
def _alone_in(folder: Path) -> Iterator[None]:
    """One process at a time puts something in place in a folder: each sees what the other one made."""
    handle = os.open(folder, os.O_RDONLY) if fcntl else None
    try:
        if handle is not None:
            with contextlib.suppress(OSError):
                fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        if handle is not None:
            os.close(handle)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange the names of two folders in one step; False where this system cannot."""
    try:
        renameat2 = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError, TypeError):
        return False
    return renameat2(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0


def _mode(path: Path, usual: int = 0o666) -> int:
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
    _sync_folder(folder)


def _sync_folder(folder: Path) -> None:
    with contextlib.suppress(OSError):  # not every system opens folders
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


_REASONS = {
    errno.ENOSPC: "the disk is full: make room, or give another folder",
    errno.EDQUOT: "your share of the disk is used up: make room, or give another folder",
    errno.EROFS: "the disk can only be read: give another folder",
    errno.EACCES: "it may not be written to: give a folder of your own",
    errno.EPERM: "it may not be written to: give a folder of your own",
    errno.ENOENT: "there is no such folder",
    errno.ENOTDIR: "a part of its path is a file",
}


_FULL = (errno.ENOSPC, errno.EDQUOT)


def _write_error(path: Path, error: OSError) -> WriteError:
    reason = _REASONS.get(error.errno, error.strerror or str(error))
    return WriteError(f"{path} cannot be written: {reason}. What was there before is untouched.")


@contextlib.contextmanager
def told(path: Path) -> Iterator[None]:
    """An error of the system as a `WriteError` that says which file, why, and that nothing is lost: around a write."""
    try:
        yield
    except WriteError:
        raise
    except OSError as error:
        raise _write_error(path, error) from error
