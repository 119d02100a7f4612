"""Processes that this one starts: this interpreter, clean of what lies in the caller's folder and environment.

`run` and `start` give every child the `clean_environment`, and `python` and `course_module` Python's option -P: nothing
of the folder that one stands in, of PYTHONPATH, or of the user's own packages and start-up files is imported.
`run_apart` is for foreign readers: what crashes, hangs or takes all memory there is an error here.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from course_lib.files import MEGABYTE, temporary_folder

ROOT = Path(__file__).resolve().parents[1]

KEPT = (
    "PYTHONDONTWRITEBYTECODE",
    "PYTHONFAULTHANDLER",
    "PYTHONHASHSEED",
    "PYTHONIOENCODING",
    "PYTHONPYCACHEPREFIX",
    "PYTHONUNBUFFERED",
    "PYTHONUTF8",
)
"""Python's variables that say how it runs. The others (PYTHONPATH, PYTHONHOME, PYTHONSTARTUP ...) say what it runs."""

JUPYTER = ("JUPYTER_PATH", "JUPYTER_CONFIG_PATH", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "IPYTHONDIR")
"""Folders from which kernels and servers take settings, and with them code."""

# After all that is installed: a `random.py` beside course.py is not taken for Python's.
_MODULE = """
import runpy, sys
sys.path.append(sys.argv[1])
name = sys.argv[2]
del sys.argv[1:3]
runpy.run_module(name, run_name="__main__", alter_sys=True)
"""

KERNEL_PATH = f'__import__("sys").path.extend([{str(ROOT)!r}, ""])'
"""What a kernel runs first: it finds this course_lib, and modules of the notebook's folder after what is installed."""

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
# A library in C++ says in words that memory ran out; the name of a function, such as `allocateLayers`, says nothing.
_CALLED = r"""
import re
OUT_OF_MEMORY = r"(?i)bad.alloc|insufficient memory|out of memory|not enough memory|(un|not|fail)\w* (to )?(re|m)?alloc"
try:
    exec(compile(CODE, "reader", "exec"), {"__name__": "__main__"})
except MemoryError:
    sys.exit(77)
except BaseException as error:
    if re.search(OUT_OF_MEMORY, str(error)):
        sys.exit(77)
    print(f"{type(error).__name__}: {error}"[:500], file=sys.stderr)
    sys.exit(78)
"""


class ChildError(RuntimeError):
    """What became of a reader: ends the sentence "reading it ..."."""


class ChildStopped(ChildError):
    """It stopped with an error of its own: no crash, and nothing that would harm this process."""


def clean_environment(more: Mapping[str, str] | None = None) -> dict[str, str]:
    """This process's environment for a child, and `more`: without what would make it run the caller's code."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if name not in JUPYTER and (name in KEPT or not name.startswith("PYTHON"))
    }
    return kept | {"PYTHONSAFEPATH": "1", "PYTHONNOUSERSITE": "1"} | dict(more or {})


def python(*words: str | Path) -> list[str]:
    """The command that runs this interpreter on `words`, with no folder that one stands in on its path."""
    return [sys.executable, "-P", *map(str, words)]


def course_module(name: str, *words: str | Path) -> list[str]:
    """The command that runs a module of this course_lib, wherever it lies, such as `course_lib.lessons.kit.score`."""
    return python("-c", _MODULE, ROOT, name, *words)


def run(
    command: Sequence[str], more: Mapping[str, str] | None = None, **options: object
) -> subprocess.CompletedProcess:
    """Python's `subprocess.run` with a clean environment and `more` of it."""
    return subprocess.run(command, env=clean_environment(more), check=False, **options)


def start(command: Sequence[str], more: Mapping[str, str] | None = None, **options: object) -> subprocess.Popen:
    """Python's `subprocess.Popen` with a clean environment and `more` of it."""
    return subprocess.Popen(command, env=clean_environment(more), **options)


def run_apart(code: str, path: str, memory: int, seconds: float = HANGS_S) -> bytes:
    """Run Python `code` in a process of its own, with `sys.argv[1]` the file to read and `[2]` the file to write.

    Isolated (-I) on top: no variable of Python's at all, and standard streams of its own.

    memory: bytes that it may take beyond the libraries themselves. Returns what it wrote. Raises `ChildError`: it
    stopped with an error (whose text is told), was killed by a signal, took more memory or time.
    """
    with temporary_folder() as folder:
        result = folder / "result.npz"
        program = f"{_LIMITS}\nCODE = {code!r}\n{_CALLED}"
        command = [sys.executable, "-I", "-c", program, path, str(result), str(memory)]
        try:
            done = run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=seconds, cwd=folder)
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
