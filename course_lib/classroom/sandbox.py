"""The grader's side of the sandbox: one answer in a process of its own, watched, and what it said read with bounds."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import sysconfig
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

from course_lib.classroom.answers import AnswerFormatError, dump, load, printable
from course_lib.classroom.confinement import Limits
from course_lib.classroom.sandbox_process import Assignment
from course_lib.paths import REPOSITORY

LOOK_EVERY_S = 0.05
"""How often threads and the folder are looked at."""
START_SECONDS = 600.0
"""Only what hangs takes so long to start."""

SYSTEM_FILES = (
    "/lib", "/lib32", "/lib64", "/usr/lib", "/usr/lib32", "/usr/lib64", "/usr/local/lib", "/usr/share",
    "/etc/ld.so.cache", "/etc/fonts", "/etc/localtime", "/dev/urandom", "/dev/random", "/dev/zero",
    "/proc/cpuinfo", "/proc/meminfo", "/sys/devices/system/cpu",
)  # fmt: skip
"""What Python and compiled libraries read of the system. Not /proc, /home, /root, /tmp, /run, nor /etc as a whole."""

KEPT_BACK = ("exercises.py", "project.py", "rivals.py")
"""Modules of a lesson or project with references, hidden seeds or rivals."""
DATA_KEPT_BACK = ("rooms_hidden.json",)
ENVIRONMENT = {
    "PATH": "/usr/bin:/bin",
    "LANG": "C.UTF-8",
    "MPLBACKEND": "Agg",
    "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow",
    "PYTHONDONTWRITEBYTECODE": "1",
    "PYTHONHASHSEED": "0",
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"),
    "LP_NUM_THREADS": "0",
}
"""All that a child finds in its environment: one thread a library, and the same order of sets in every run."""

START = (
    "import sys; sys.path.insert(0, sys.argv[1]); "
    "from course_lib.classroom.sandbox_process import main; main(int(sys.argv[2]))"
)
MAX_MESSAGES = 1000
MAX_FILES = 1000
SHOWN = 1000
"""Characters of what was printed that are kept."""


class SandboxError(RuntimeError):
    """The sandbox does not start, has ended, or lacks a wall."""


@dataclass
class Run:
    """What came of one answer.

    messages: what the child sent of the calls. refused: what it tried, in words that follow "tried to". problems:
    statements of the notebook that failed. ended: why it did not come to its end, in words that follow "Your function",
    or None. missing_walls: protections that this machine does not have. printed: outside the calls, by any way.
    """

    messages: list[dict] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    missing_walls: list[str] = field(default_factory=list)
    ended: str | None = None
    done: bool = False
    printed: str = ""
    peak_mb: float = 0.0


def readable_paths() -> tuple[list[Path], list[Path]]:
    """Files and folders that an answer may read, and folders whose names it may list: Python, its packages, the
    library without references and the grader's own modules, and the data without the hidden rooms."""
    python = {Path(sysconfig.get_paths()[name]) for name in ("stdlib", "platstdlib", "purelib", "platlib")}
    python |= {Path(sys.base_prefix, "lib")} if sys.base_prefix != "/usr" else set()
    library, data = REPOSITORY / "course_lib", REPOSITORY / "data"
    apart = {library / "lessons": KEPT_BACK, data / "projects": DATA_KEPT_BACK}
    paths = [Path(path) for path in SYSTEM_FILES] + sorted(python)
    paths += [path for path in library.iterdir() if path.name not in ("lessons", "classroom", "commands")]
    paths += [path for path in data.iterdir() if path.name != "projects"]
    for folder, kept_back in apart.items():
        for path in folder.rglob("*"):
            if path.is_file() and path.name not in kept_back and "__pycache__" not in path.parts:
                paths.append(path)
    return sorted(path for path in set(paths) if path.exists()), [library]


class Sandbox:
    """A clean process that makes one for each answer; a context manager.

    folder: everything that it makes lies in here; the caller removes it. trusted: run although a wall is missing.
    """

    def __init__(self, folder: Path, trusted: bool = False) -> None:
        self.folder, self._trusted = Path(folder), trusted
        self._process: subprocess.Popen | None = None
        self._line: socket.socket | None = None

    def __enter__(self) -> Sandbox:
        self._start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the process; its child dies with it."""
        if self._process is not None:
            self._line.close()
            self._process.kill()
            self._process.wait()
            self._process = self._line = None

    def _start(self) -> None:
        mine, theirs = socket.socketpair()
        self.folder.mkdir(parents=True, exist_ok=True)
        environment = ENVIRONMENT | {"HOME": str(self.folder)}
        with theirs, open(self.folder / "sandbox.log", "wb") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-s", "-c", START, str(REPOSITORY), str(theirs.fileno())],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=environment,
                cwd=self.folder,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
        self._line = mine
        mine.settimeout(START_SECONDS)
        readable, listable = readable_paths()
        settings = [[str(path) for path in readable], [str(path) for path in listable], self._trusted]
        try:
            mine.sendall(json.dumps(settings).encode() + b"\n")
            ready = mine.recv(16) == b"ready"
        except OSError:
            ready = False
        if not ready:
            said = (self.folder / "sandbox.log").read_text("utf-8", "replace").strip().splitlines()
            self.close()
            raise SandboxError(f"the sandbox does not start: {said[-1] if said else 'no reason given'}")

    def run(self, assignment: Assignment, serve: Callable[[dict], dict] | None = None) -> Run:
        """Run one answer in a fresh process and folder. `serve` answers the calls of functions that stayed here."""
        if self._process is None:
            self._start()
        own_folder = self.folder / "answer"
        remove(own_folder)
        own_folder.mkdir(mode=0o700)
        run = Run()
        orders, results, printed = os.pipe(), os.pipe(), os.pipe()
        child = None
        try:
            try:
                theirs = [orders[0], results[1], printed[1]]
                socket.send_fds(self._line, [os.fsencode(own_folder)], theirs)
                child = int(self._line.recv(32))
            finally:
                for descriptor in theirs:
                    os.close(descriptor)
            _Watch(assignment.limits, child, own_folder, run, serve).watch(
                orders[1], results[0], printed[0], assignment
            )
        except (OSError, ValueError) as error:
            self.close()
            raise SandboxError(f"the sandbox ended: {error}") from error
        finally:
            for descriptor in (orders[1], results[0], printed[0]):
                os.close(descriptor)
            if child is not None and self._process is not None:
                self._reap(child, run, assignment.limits)
            remove(own_folder)
        return run

    def _reap(self, child: int, run: Run, limits: Limits) -> None:
        for kill in (os.killpg, os.kill):
            with contextlib.suppress(ProcessLookupError, PermissionError):
                kill(child, signal.SIGKILL)
        self._line.sendall(b"reap")
        code, run.peak_mb = json.loads(self._line.recv(256))
        if run.ended is None and not run.done:
            run.ended = _told_exit(code, limits)


class _Watch:
    """Reads what a child sends, answers its calls, and kills it where it takes more than its share."""

    def __init__(self, limits: Limits, child: int, own_folder: Path, run: Run, serve: Callable | None) -> None:
        self._limits, self._child, self._folder, self._run, self._serve = limits, child, own_folder, run, serve
        self._buffer, self._searched, self._received = bytearray(), 0, 0
        self._outgoing = bytearray()
        self._printed, self._n_printed = bytearray(), 0

    def watch(self, orders: int, results: int, printed: int, assignment: Assignment) -> None:
        """Until the child closes its line, or is stopped: `run.ended` then says why."""
        for descriptor in (orders, results, printed):
            os.set_blocking(descriptor, False)
        content = pickle.dumps(tuple(assignment))
        self._outgoing += struct.pack("=Q", len(content)) + content
        deadline = time.monotonic() + self._limits.seconds
        open_ends = {results, printed}
        while results in open_ends and self._run.ended is None and not self._run.done:
            ready, writable, _ = select.select(open_ends, [orders] if self._outgoing else [], [], LOOK_EVERY_S)
            for descriptor in ready:
                if not (content := os.read(descriptor, 1 << 16)):
                    open_ends.discard(descriptor)
                elif descriptor == results:
                    self._take(content)
                else:
                    self._take_printed(content)
            if writable:
                try:
                    del self._outgoing[: os.write(orders, self._outgoing[: 1 << 16])]
                except BrokenPipeError:
                    self._outgoing.clear()
            self._run.ended = self._run.ended or self._too_much(deadline)
        with contextlib.suppress(BlockingIOError):
            while printed in open_ends and self._n_printed < SHOWN and (content := os.read(printed, 1 << 16)):
                self._take_printed(content)
        self._run.printed = self._printed[:SHOWN].decode("utf-8", "replace")

    def _take(self, content: bytes) -> None:
        self._received += len(content)
        self._buffer += content
        if self._received > self._limits.answers_mb << 20:
            self._run.ended = f"answers more than {self._limits.answers_mb} MB"
            return
        while (end := self._buffer.find(b"\n", self._searched)) >= 0:
            line = bytes(self._buffer[:end])
            del self._buffer[: end + 1]
            self._searched = 0
            try:
                self._understand(load(line))
            except AnswerFormatError as error:
                self._run.ended = f"sends the grader {error}"
                return
        self._searched = len(self._buffer)

    def _understand(self, message: dict) -> None:
        run = self._run
        if type(message.get("missing walls")) is list and not run.messages:
            run.missing_walls = run.missing_walls or [printable(wall)[:200] for wall in message["missing walls"]]
        elif "refused" in message:
            _note(run.refused, message["refused"])
        elif "problem" in message:
            _note(run.problems, message["problem"])
        elif "done" in message:
            run.done = True
        elif "call" in message:
            reply = self._serve(message) if self._serve else {"error": ["RuntimeError", "nothing to call"]}
            self._outgoing += dump(reply)
        elif len(run.messages) < MAX_MESSAGES:
            run.messages.append(message)
        else:
            raise AnswerFormatError("more messages than there are calls")

    def _take_printed(self, content: bytes) -> None:
        self._n_printed += len(content)
        self._printed += content[: max(0, 4 * SHOWN - len(self._printed))]
        if self._n_printed > self._limits.printed_kb << 10:
            self._run.ended = f"prints more than {self._limits.printed_kb} kB: is there a print inside a loop?"

    def _too_much(self, deadline: float) -> str | None:
        """What the child takes more of than it may, in words that follow "Your function"; None where it does not."""
        limits = self._limits
        if time.monotonic() > deadline:
            return f"does not end within {limits.seconds:g} seconds, all its calls together; it was stopped"
        with contextlib.suppress(OSError):
            if len(os.listdir(f"/proc/{self._child}/task")) > limits.threads:
                return f"starts more than {limits.threads} threads; it was stopped"
        with contextlib.suppress(OSError):
            entries = islice(os.scandir(self._folder), MAX_FILES + 1)  # no more: they may come as fast as one looks
            files = [entry.stat(follow_symlinks=False).st_blocks * 512 for entry in entries]
            if sum(files) > limits.folder_mb << 20 or len(files) > MAX_FILES:
                return f"writes more than {limits.folder_mb} MB or {MAX_FILES} files; it was stopped"
        return None


def _note(notes: list[str], text: object) -> None:
    """Keep one more note of a stranger's, within bounds."""
    if type(text) is str and len(notes) < 20 and (text := printable(text)[:600]) not in notes:
        notes.append(text)


def _told_exit(code: int, limits: Limits) -> str:
    """How a process ended before all its answers were there, in words that follow "Your function"."""
    if code >= 0:
        return "ends its process (os._exit, or what is like it) before it has answered"
    if -code == signal.SIGXCPU:
        return f"takes more than {limits.seconds:g} seconds of processor time; it was stopped"
    name = signal.Signals(-code).name if -code in set(signal.Signals) else str(-code)
    why = {"SIGKILL": "; was it out of memory?", "SIGSEGV": ", an access to memory that is not its own"}.get(name, "")
    return f"crashes its process ({name}{why})"


def remove(folder: Path) -> None:
    """Remove a folder and all in it, whatever rights its files have; what cannot be removed stays."""

    def once_more(function: Callable, path: str, _: object) -> None:
        with contextlib.suppress(OSError):
            os.chmod(path, 0o700)
            function(path)

    if folder.exists():
        shutil.rmtree(folder, onerror=once_more)
