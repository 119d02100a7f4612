"""Foreign readers in a process of their own: what crashes, hangs or takes all memory there is an error here.

The child is this interpreter in isolated mode (-I): nothing of the caller's folder, of PYTHONPATH or of the user's own
packages is imported, and its standard streams are its own.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from course_lib.reading import MEGABYTE

HANGS_S = 600.0
"""Seconds after which a reader is held to hang: only what hangs takes so long."""

_LIMITS = """
import sys
try:
    import resource
    resource.setrlimit(resource.RLIMIT_DATA, (int(sys.argv[3]),) * 2)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
except (ImportError, ValueError, OSError):  # no such limit on this system
    pass
"""
_MEMORY = 77  # exit code: out of memory
_CALLED = """
try:
    exec(compile(CODE, "reader", "exec"), {"__name__": "__main__"})
except MemoryError:
    sys.exit(77)
except BaseException as error:
    if "alloc" in str(error).lower() or "memory" in str(error).lower():
        sys.exit(77)
    print(f"{type(error).__name__}: {error}"[:500], file=sys.stderr)
    sys.exit(78)
"""


class ChildError(RuntimeError):
    """What became of a reader: ends the sentence "reading it ..."."""


class ChildStopped(ChildError):
    """It stopped with an error of its own: no crash, and nothing that would harm this process."""


def run_apart(code: str, path: str, memory: int, seconds: float = HANGS_S) -> bytes:
    """Run Python `code` in a process of its own, with `sys.argv[1]` the file to read and `[2]` the file to write.

    memory: bytes that it may take beyond the libraries themselves. Returns what it wrote. Raises `ChildError`: it
    stopped with an error (whose text is told), was killed by a signal, took more memory or time.
    """
    with tempfile.TemporaryDirectory(prefix="course-reader-") as folder:
        result = Path(folder) / "result.npz"
        program = f"{_LIMITS}\nCODE = {code!r}\n{_CALLED}"
        command = [sys.executable, "-I", "-c", program, path, str(result), str(memory)]
        try:
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, capture_output=True, timeout=seconds, cwd=folder, check=False
            )
        except subprocess.TimeoutExpired:
            raise ChildError(f"takes longer than {seconds:g} s") from None
        if done.returncode == _MEMORY or done.returncode == -signal.SIGKILL:
            raise ChildError(f"takes more than {memory / MEGABYTE:,.0f} MB of memory") from None
        if done.returncode < 0:
            raise ChildError(f"crashes ({signal.Signals(-done.returncode).name})")
        if done.returncode != 0:
            lines = done.stderr.decode("utf-8", "replace").strip().splitlines()
            raise ChildStopped(f"stops with {lines[-1] if lines else f'exit code {done.returncode}'}")
        return result.read_bytes() if result.is_file() else b""
