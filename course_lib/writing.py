"""One file, written or replaced as a whole: the old or the new is there, and never half of either.

What is new is made beside the old (`course_lib.unfinished`), is on the disk before it takes its name, and takes it in
one step. Whatever stops that (Ctrl-C, a full disk, kill -9), the old is still there, and an error names the file and
says why. A command that makes several files writes them with `course_lib.output_folder`.
"""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Iterator
from pathlib import Path

from course_lib.unfinished import begun_file, clear_unfinished, cleared_if_stopped, mode_of, sync_folder

FULL = (errno.ENOSPC, errno.EDQUOT)
"""The system's errors where there is no room left."""

_REASONS = {
    errno.ENOSPC: "the disk is full: make room, or give another folder",
    errno.EDQUOT: "your share of the disk is used up: make room, or give another folder",
    errno.EROFS: "the disk can only be read: give another folder",
    errno.EACCES: "it may not be written to: give a folder of your own",
    errno.EPERM: "it may not be written to: give a folder of your own",
    errno.ENOENT: "there is no such folder",
    errno.EISDIR: "it is a folder: give the name of a file",
    errno.ENOTDIR: "a part of its path is a file",
}


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
    with told(path), cleared_if_stopped(path):
        clear_unfinished(path)
        handle, unfinished = begun_file(path.parent, path.name)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
                os.chmod(unfinished, mode_of(path))
                os.replace(unfinished, path)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(unfinished)
            raise
        sync_folder(path.parent)


@contextlib.contextmanager
def told(path: Path) -> Iterator[None]:
    """An error of the system as a `WriteError` that says which file, why, and that nothing is lost: around a write."""
    try:
        yield
    except WriteError:
        raise
    except OSError as error:
        raise write_error(path, error) from error


def write_error(path: Path, error: OSError) -> WriteError:
    """The system's `error` at writing `path` in words, to be raised from it."""
    reason = _REASONS.get(error.errno, error.strerror or str(error))
    found = WriteError(f"{path} cannot be written: {reason}. What was there before is untouched.")
    found.errno = error.errno  # for who made the folder that this file was to be in, and names that one
    return found
