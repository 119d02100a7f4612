"""One file, read in a child process with limits of time and memory; what became of it is the verdict.

The child is forked from a process that has imported everything: that costs milliseconds, and what crashes, hangs or
takes all memory there can only be the one file that it was given. Nothing is drawn with OpenGL in either.
"""

from __future__ import annotations

import contextlib
import faulthandler
import json
import os
import resource
import select
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

from course_lib.fuzzing.readings import Reading, same
from course_lib.reading import MEGABYTE, is_given

CLASSES = ("refused", "same", "changed", "unexplained", "unnamed", "crash", "hang", "memory")
"""Refused by name; read with the same result; with another one that is explained, or is not; an error without a name;
the process died; it took too long; it took too much memory."""

DEFECTS = ("unexplained", "unnamed", "crash", "hang", "memory")

SECONDS = 120.0
"""After which a file is held to hang; the slowest valid one takes two, on a machine that is idle."""

MEMORY = 850 * MEGABYTE
"""Bytes in memory at once that reading one file may take: with the libraries' 150 MB less than 1 GB. What the process
holds that the child is forked from, such as a test run's, is not the reader's and does not count."""

SPACE = 4_000 * MEGABYTE
"""Bytes that the child may ask for beyond that: above it is told that there are none, and the machine goes on."""


_UNIT = 1 if sys.platform == "darwin" else 1024
"""Bytes of `ru_maxrss`."""


@dataclass(frozen=True)
class Verdict:
    """What became of one file."""

    outcome: str
    """One of `CLASSES`."""
    told: str
    """The error's text, or why a changed result is right."""
    memory_mb: float
    seconds: float


def try_file(
    path: Path,
    read: Callable[[Path], Reading],
    errors: tuple[type[Exception], ...],
    explain: Callable[[bytes | None, Reading, Reading], str | None],
    original: Reading,
    seconds: float = SECONDS,
    memory: int = MEMORY,
) -> Verdict:
    """Read `path` in a child and judge it. errors: those by which the reader may refuse, with the file's name in them.

    original: what `read` makes of the valid file. explain: why a changed result is right, or None.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    reading_end, writing_end = os.pipe()
    start = time.monotonic()
    child = os.fork()
    if child == 0:
        _judge_and_leave(writing_end, path, read, errors, explain, original)
    os.close(writing_end)
    said = _said_within(reading_end, start + seconds)
    hangs = said is None
    if hangs:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(child, signal.SIGKILL)
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
    _, status, used = os.wait4(child, 0)
    taken = time.monotonic() - start
    inherited, _, said = (said or b"").partition(b"\n")
    outcome, told, read_peak = _outcome(said, status, hangs, seconds)
    peak = used.ru_maxrss * _UNIT - int(inherited or 0) if read_peak is None else read_peak
    if peak > memory and outcome != "hang":
        outcome, told = "memory", f"{peak / MEGABYTE:,.0f} MB; {told}"
    return Verdict(outcome, told[:400], round(peak / MEGABYTE, 1), round(taken, 3))


def _said_within(handle: int, until: float) -> bytes | None:
    """All that the child writes, None where it does not end in time."""
    said = b""
    with os.fdopen(handle, "rb", buffering=0) as pipe:
        while (left := until - time.monotonic()) > 0:
            if select.select([pipe], [], [], left)[0]:
                piece = pipe.read(65536)
                if not piece:
                    return said
                said += piece
    return None


def _outcome(said: bytes, status: int, hangs: bool, seconds: float) -> tuple[str, str, int | None]:
    """Class, what is told, and the memory that the reader took, bytes, where the child lived to tell."""
    if hangs:
        return "hang", f"not done after {seconds:g} s", None
    if os.WIFSIGNALED(status):
        return "crash", f"died by {signal.Signals(os.WTERMSIG(status)).name}", None
    try:
        verdict = json.loads(said)
        return verdict["outcome"], verdict["told"], verdict["peak"]
    except (ValueError, KeyError):
        return "crash", f"ended without a word, with exit code {os.waitstatus_to_exitcode(status)}", None


def _judge_and_leave(handle: int, *arguments: object) -> None:
    """The child: says what it found, and ends without running anything of its parent's."""
    try:
        resident, data = _held()
        os.write(handle, b"%d\n" % resident)
        faulthandler.disable()
        os.setsid()
        silent = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(silent, stream)
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(resource.RLIMIT_DATA, (data + SPACE, data + SPACE))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        peak: list[tuple[int, int]] = []
        outcome, told = judge(*arguments, peak)
        taken = max(peak[0][0] - resident, peak[0][1])
        os.write(handle, json.dumps({"outcome": outcome, "told": told[:2000], "peak": taken}).encode())
    finally:
        os._exit(0)


def judge(
    path: Path,
    read: Callable[[Path], Reading],
    errors: tuple[type[Exception], ...],
    explain: Callable[[bytes | None, Reading, Reading], str | None],
    original: Reading,
    peak: list[tuple[int, int]],
) -> tuple[str, str]:
    """(class, what is told) of a file that is read in this process; `peak` gets what `_most_memory` says after it."""
    try:
        try:
            found = read(path)
        finally:
            peak.append(_most_memory())
    except BaseException as error:
        told = f"{type(error).__name__}: {error}"
        if _lacked_memory(error):
            return "memory", told
        # Of a file that is not there, a reader that looks for it can only name the folder.
        name = path.name if is_given(path) else str(path.parent)
        named = isinstance(error, errors) and name in str(error)
        return ("refused" if named else "unnamed"), told
    if same(found, original):
        return "same", ""
    if path.is_file() or not is_given(path):
        data = path.read_bytes() if path.is_file() else None
    else:
        return "unexplained", "what is no file was read as if it were one, or as if nothing were there"
    try:
        why = explain(data, found, original)
    except Exception as error:  # the second reading does not accept what the first did
        return "unexplained", f"the second reading fails: {type(error).__name__}: {error}"
    if why is None:
        changed = [name for name, value in found.items() if name not in original or not same(value, original[name])]
        return "unexplained", f"changed: {', '.join(changed)}"
    return "changed", why


def _most_memory() -> tuple[int, int]:
    """Bytes that this process had in memory at most, and those of the process that it started with the most."""
    own, started = (resource.getrusage(whose).ru_maxrss for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return own * _UNIT, started * _UNIT


def _held() -> tuple[int, int]:
    """Bytes in memory, and bytes of data asked for, of this process; nought where the system does not tell."""
    try:
        pages = Path("/proc/self/statm").read_text(encoding="ascii").split()
    except OSError:
        return 0, 0
    return int(pages[1]) * resource.getpagesize(), int(pages[5]) * resource.getpagesize()


def _lacked_memory(error: BaseException | None) -> bool:
    """Whether there was no memory left, however the reader wrapped it."""
    while error is not None:
        if isinstance(error, MemoryError) or "insufficient memory" in str(error).lower():
            return True
        error = error.__cause__ or error.__context__
    return False


def as_row(verdict: Verdict) -> dict:
    """A verdict for JSON."""
    return asdict(verdict)
