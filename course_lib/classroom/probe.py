"""Which protections this machine gives, found by trying: code in the sandbox asks the C library for what it may not.

So a wall that the kernel builds and that does not hold (an old Landlock, a container that allows everything) is found,
too. What is tried does no harm where it succeeds.
"""

import os
import pickle
import shutil
from pathlib import Path

from course_lib.classroom.answers import decode
from course_lib.classroom.confinement import Limits
from course_lib.classroom.sandbox import Sandbox, SandboxError
from course_lib.classroom.sandbox_process import Assignment

PROTECTIONS = (
    "files of others cannot be read",
    "files of others cannot be removed",
    "rights of files cannot be changed",
    "there is no network",
    "no signal reaches another process",
    "no other process can be looked into",
    "no other process or program can be started",
    "memory is bounded",
)
"""In the order in which `ATTEMPTS` tries what they forbid."""

ATTEMPTS = """
import ctypes
import os

def attempts(secret, parent):
    libc = ctypes.CDLL(None)

    def no_memory():
        try:
            return bytearray(64 << 30) is None
        except MemoryError:
            return True

    def no_process():
        child = libc.fork()
        if child == 0:
            os._exit(0)
        return child < 0

    return [
        libc.open(secret.encode(), os.O_RDONLY) < 0,
        libc.unlink(secret.encode()) < 0,
        libc.chmod(secret.encode(), 0o600) < 0,
        libc.socket(2, 1, 0) < 0,
        libc.kill(parent, 0) < 0,
        libc.open(f"/proc/{parent}/environ".encode(), os.O_RDONLY) < 0,
        no_process(),
        no_memory(),
    ]
"""


def missing_protections(folder: Path, limits: Limits) -> tuple[str, ...]:
    """Those of `PROTECTIONS` that this machine does not give. Raises `SandboxError` where nothing runs at all."""
    folder.mkdir(parents=True)
    secret = folder / "secret"
    secret.write_text("not for strangers", encoding="ascii")
    given = pickle.dumps([(str(secret), os.getpid())])
    with Sandbox(folder, trusted=True) as sandbox:
        run = sandbox.run(Assignment((("probe", ATTEMPTS, (0, 1, 2)),), "attempts", given, limits))
    shutil.rmtree(folder)
    held = decode(run.messages[0]["value"]) if run.messages and "value" in run.messages[0] else None
    if not isinstance(held, list) or len(held) != len(PROTECTIONS):
        why = run.ended or (run.messages[0].get("failure") if run.messages else None) or "no answer"
        raise SandboxError(f"the sandbox of this machine does not work: its trial {why}")
    return tuple(words for words, holds in zip(PROTECTIONS, held, strict=True) if holds is not True)
