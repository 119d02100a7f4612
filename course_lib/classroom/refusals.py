"""What a stranger's code tried and was refused, in words: a hook on Python's own audit events (PEP 578).

The hook is no wall: code that calls the C library goes around it, and then meets the walls of `confinement`. It gives
the reason a name, so that the page can say what was refused, and it stops what the kernel would stop a moment later.
"""

import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

MAX_NOTED = 20
LONGEST = 200  # characters of one refusal

WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND

PROGRAMS = {
    "os.exec": "start another program",
    "os.fork": "start another process",
    "os.forkpty": "start another process",
    "os.posix_spawn": "start another program",
    "os.spawn": "start another program",
    "os.startfile": "start another program",
    "os.system": "start another program",
    "subprocess.Popen": "start another program",
}
NETWORK = {
    "socket.__new__": "open a network connection",
    "socket.bind": "open a network connection",
    "socket.connect": "open a network connection to",
    "socket.getaddrinfo": "look up the network address of",
    "socket.gethostbyaddr": "look up the network address of",
    "socket.gethostbyname": "look up the network address of",
    "socket.getnameinfo": "look up the network address of",
    "socket.sendto": "send over the network",
}
SIGNALS = {"os.kill": "send a signal to another process", "os.killpg": "send a signal to other processes"}
CHANGES = {
    "os.chflags": "change the flags of",
    "os.chmod": "change the rights of",
    "os.chown": "change the owner of",
    "os.mkdir": "make the folder",
    "os.remove": "remove",
    "os.removexattr": "change attributes of",
    "os.rename": "rename",
    "os.rmdir": "remove the folder",
    "os.setxattr": "change attributes of",
    "os.symlink": "make a link to",
    "os.link": "make a link to",
    "os.truncate": "empty",
    "os.utime": "change the times of",
    "shutil.rmtree": "remove the folder",
    "shutil.move": "move",
}
LISTING = {"os.listdir": "list the folder", "os.scandir": "list the folder"}


def refuse(readable: Iterable[Path], listable: Iterable[Path], own_folder: Path, note: Callable[[str], None]) -> None:
    """From now on refuse what the walls refuse, with a `PermissionError` that says so, and `note` it once each."""
    readable = tuple(os.path.realpath(path) for path in readable)
    listable = tuple(os.path.realpath(path) for path in listable)
    own = os.path.realpath(own_folder)
    noted: set[str] = set()
    deciding = [False]

    def beneath(path: str, roots: Iterable[str]) -> bool:
        return any(path == root or path.startswith(root.rstrip("/") + "/") for root in roots)

    def wish(event: str, given: tuple) -> str | None:
        """What is to be refused, in words that follow "tried to"; None for what is allowed."""
        if event in PROGRAMS:
            program = given[0] if event in ("os.system", "subprocess.Popen", "os.exec") and given else ""
            return f"{PROGRAMS[event]} {_told(program)}".rstrip()
        if event in NETWORK:
            place = given[1] if event == "socket.connect" else given[0] if "look up" in NETWORK[event] else ""
            return f"{NETWORK[event]} {_told(place)}".rstrip()
        if event in SIGNALS:
            return SIGNALS[event] if given[0] != os.getpid() else None
        if event == "open":
            path, _, flags = given
            if isinstance(path, int):
                return None
            place = os.path.realpath(path)
            if beneath(place, (own,)) or place == "/dev/null":
                return None
            if isinstance(flags, int) and flags & WRITING:
                return f"write to {_told(path)}"
            return None if beneath(place, readable) else f"read {_told(path)}"
        if event in LISTING:
            place = os.path.realpath(given[0] or ".") if not isinstance(given[0], int) else own
            return None if beneath(place, (own, *readable, *listable)) else f"{LISTING[event]} {_told(given[0])}"
        if event in CHANGES:
            if isinstance(given[0], int) or beneath(os.path.realpath(given[0]), (own,)):
                return None
            return f"{CHANGES[event]} {_told(given[0])}"
        return None

    def hook(event: str, given: tuple) -> None:
        if deciding[0] or event.partition(".")[0] not in {"open", "os", "socket", "subprocess", "shutil"}:
            return
        deciding[0] = True
        try:
            refused = wish(event, given)
            if refused is None:
                return
            refused = refused[:LONGEST]
            if refused not in noted and len(noted) < MAX_NOTED:
                noted.add(refused)
                note(refused)
        finally:
            deciding[0] = False
        raise PermissionError(1, f"refused while grading: your code tried to {refused}")

    sys.addaudithook(hook)


def _told(value: object) -> str:
    """A path, an address or a command in one line."""
    if isinstance(value, bytes):
        value = value.decode("utf-8", "replace")
    if isinstance(value, (list, tuple)):
        value = ":".join(str(part) for part in value[:2])
    return " ".join(str(value).encode("utf-8", "replace").decode().split())
