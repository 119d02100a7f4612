"""A port for a lab: one that nobody listens on, and that no other lab that is starting has chosen.

JupyterLab looks for a free port and opens it some time later; two labs that start at once choose the same one, and the
second ends. So a lab holds a lock of the port's name, which the system lets go of however the lab ends.
"""

from __future__ import annotations

import errno
import os
import socket
import stat
import tempfile
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows: labs that start at once may meet, and the second says that it has no port
    fcntl = None

FIRST = 8888
N_PORTS = 50


def reserve_port(first: int = FIRST) -> tuple[int, int | None]:
    """A free port from `first` on, and the handle of its lock, which whatever this process becomes inherits.

    The port is this process's until the handle is closed. None stands for a lock where there can be none. Where all
    `N_PORTS` are taken, it is the first one, and JupyterLab says so.
    """
    for port in range(first, first + N_PORTS):
        handle = _lock(port)
        if handle is not False and _is_free(port):
            return port, handle
        if handle not in (False, None):
            os.close(handle)
    return first, None


def _lock(port: int) -> int | bool | None:
    """The handle of a port's lock; None where there can be none, False where another process holds it."""
    folder = _folder()
    if fcntl is None or folder is None:
        return None
    try:
        handle = os.open(folder / f"{port}.lock", os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
    except OSError:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(handle)
        return False if error.errno in (errno.EAGAIN, errno.EACCES) else None
    os.set_inheritable(handle, True)
    return handle


def _folder() -> Path | None:
    """This user's folder of locks, for every copy of the course; None where it is somebody else's or cannot be made."""
    if not hasattr(os, "geteuid"):
        return None
    folder = Path(tempfile.gettempdir()) / f"course-lab-{os.geteuid()}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    return folder if stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() else None


def _is_free(port: int) -> bool:
    with socket.socket() as probe:
        if os.name != "nt":
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # as the server does: one that has just ended
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True
