"""The walls around a submission: bubblewrap makes them, prlimit bounds each process, and we watch the sum.

In its own namespaces a submission finds the system, Python and the course read-only, without the modules that hold
solutions and without the hidden data; a folder of limited size; no network and no other process. `--trust` runs the
same process without walls.
"""

import compileall
import contextlib
import os
import pickle
import platform
import shutil
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import psutil

from course_lib.classroom.answers import AnswerFormatError, load, one_line
from course_lib.paths import REPOSITORY

KEPT_BACK = ("exercises.py", "project.py", "rivals.py")
"""Modules of a lesson or project with solutions, hidden seeds or rivals."""
TEACHERS = ("classroom", "commands")
IN_CLASSROOM = ("__init__.py", "answers.py", "inside.py")
"""What the process in the sandbox needs of this folder."""
HIDDEN_DATA = ("rooms_hidden.json",)
SYSTEM = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache", "/etc/fonts", "/etc/localtime")
SYSTEM += ("/etc/alternatives", "/sys/devices/system/cpu")
ENVIRONMENT = {
    "PATH": "/usr/bin:/bin", "HOME": "/tmp", "LANG": "C.UTF-8", "MPLBACKEND": "Agg", "MPLCONFIGDIR": "/tmp",
    "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow", "PYTHONDONTWRITEBYTECODE": "1", "PYTHONHASHSEED": "0",
    "LP_NUM_THREADS": "0", "PYTHONUNBUFFERED": "1",
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"),
}  # fmt: skip
"""All that the process finds in its environment."""
START_SECONDS = 300.0  # until the file is read; only a fault takes so long
LOOK_EVERY = 0.1  # seconds between two looks at memory
MAX_LINE = 16 << 20  # bytes of one call's answer; right answers have some kilobytes
MAX_MESSAGES = 500  # of one answer
ORDER_SECONDS = 30.0  # of one answer, beside its own time
MIN_FREE = 0.05  # of the machine's memory: with less, what runs is stopped, whoever took it
HOW_TO = (
    "strangers' code is kept in by bubblewrap 0.8 or newer. Install it (Debian, Ubuntu: apt install bubblewrap; "
    "Fedora: dnf install bubblewrap), or grade in the container of course_lib/classroom/Containerfile. If you have "
    "read every file and trust it, add --trust"
)


class SandboxError(RuntimeError):
    """This machine gives no walls. The message says what to do."""


class Limits(NamedTuple):
    """What one submission may use. seconds: of all calls of one answer. memory_mb: of all its processes together."""

    call_seconds: float = 20.0
    seconds: float = 60.0
    memory_mb: int = 1500
    folder_mb: int = 64
    processes: int = 64


class Run(NamedTuple):
    """The outcome of one answer. calls: messages of `inside.answer`. ended: why it stopped, after "Your function"."""

    head: dict
    calls: list[dict]
    ended: str


@contextlib.contextmanager
def library_copy(folder: Path) -> Iterator[Path]:
    """Copy the course's library into a folder, without what no student's code may read."""

    def left_out(place: str, names: list[str]) -> set[str]:
        here = Path(place)
        taught = here.name.startswith(("lesson_", "foundation_", "project_"))
        out = {name for name in names if taught and name in KEPT_BACK}
        out |= {"commands"} if here.name == "course_lib" else set()
        if here.name == "classroom":
            out |= set(names) - set(IN_CLASSROOM)
        if here.name == "__pycache__":  # bytecode would hold the solutions; Numba's files are only machine code
            out |= {name for name in names if not name.endswith((".nbi", ".nbc"))}
        return out

    shutil.copytree(REPOSITORY / "course_lib", folder / "course_lib", ignore=left_out)
    compileall.compile_dir(folder / "course_lib", quiet=2)  # once, not in every sandbox
    (folder / "data").symlink_to(REPOSITORY / "data")  # without walls; inside them it is a mount
    yield folder


def require_walls() -> None:
    """Raise `SandboxError` unless bubblewrap is here and may make its namespaces."""
    if sys.platform != "linux" or shutil.which("bwrap") is None:
        raise SandboxError(f"{platform.system()} has no bwrap here: {HOW_TO}")
    command = [*walls(Limits()), *bounds(Limits()), "sh", "-c", "true & wait"]
    tried = subprocess.run(command, capture_output=True, text=True, check=False)
    if tried.returncode:
        raise SandboxError(f"bubblewrap does not start ({one_line(tried.stderr, 200)}): {HOW_TO}")


def walls(limits: Limits, library: Path | None = None, submission: Path | None = None) -> list[str]:
    """Return the command that runs another one within walls."""
    command = ["bwrap", "--unshare-all", "--unshare-user", "--disable-userns", "--die-with-parent", "--new-session"]
    command += ["--cap-drop", "ALL", "--uid", "65534", "--gid", "65534", "--hostname", "grading", "--clearenv"]
    for name, value in ENVIRONMENT.items():
        command += ["--setenv", name, value]
    size = str(limits.folder_mb << 20)
    command += ["--proc", "/proc", "--dev", "/dev", "--size", size, "--tmpfs", "/tmp", "--size", size]
    command += ["--tmpfs", "/dev/shm"]
    for path in map(Path, SYSTEM):
        linked = path.is_symlink() and path.parent == Path("/")
        command += ["--symlink", os.readlink(path), str(path)] if linked else ["--ro-bind-try", str(path), str(path)]
    for path in {sys.prefix, sys.base_prefix, sys.exec_prefix} - {"/usr"}:
        command += ["--ro-bind", path, path]
    if library is not None:
        command += ["--ro-bind", str(library / "course_lib"), "/course/course_lib"]
        for path in sorted([*(REPOSITORY / "data").iterdir(), *(REPOSITORY / "data" / "projects").iterdir()]):
            if path.name not in (*HIDDEN_DATA, "projects"):
                command += ["--ro-bind", str(path), f"/course/data/{path.relative_to(REPOSITORY / 'data')}"]
    if submission is not None:
        command += ["--ro-bind", str(submission), f"/handed_in/submission{submission.suffix.lower()}"]
    return [*command, "--remount-ro", "/dev", "--remount-ro", "/", "--chdir", "/tmp"]


def bounds(limits: Limits) -> list[str]:
    """Return the command that bounds each process of another one."""
    file, space = limits.folder_mb << 20, 4 * limits.memory_mb << 20
    return ["prlimit", f"--fsize={file}", f"--as={space}", f"--nproc={limits.processes}", "--nofile=256", "--core=0"]


class Sandbox:
    """One submission in its sandbox: a context manager. `opened` is what the file holds; `run` runs one answer."""

    def __init__(self, submission: Path, library: Path, limits: Limits, trust: bool = False) -> None:
        self.limits, self._ended, self._closed = limits, "", False
        path = submission.resolve() if trust else Path(f"/handed_in/submission{submission.suffix.lower()}")
        place = library if trust else Path("/course")
        start = f"import sys; sys.path.insert(0, {str(place)!r}); from course_lib.classroom.inside import main; "
        start += f"main({str(path)!r}, {limits.call_seconds!r}, {limits.seconds!r})"
        python = [sys.executable, "-P", "-s", "-B", "-c", start]
        around = [] if trust else [*walls(limits, library, submission.resolve()), *bounds(limits)]
        environment = ENVIRONMENT if not trust else os.environ | ENVIRONMENT | {"HOME": str(library)}
        self._process = subprocess.Popen(
            [*around, *python], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment,
            cwd=library, start_new_session=True,
        )  # fmt: skip
        self._deadline = time.monotonic() + START_SECONDS
        self._watcher = threading.Thread(target=self._watch, daemon=True)
        self._watcher.start()

    def __enter__(self) -> "Sandbox":
        self.opened = self._line()
        return self

    def __exit__(self, *_: object) -> None:
        self._closed = True
        self._kill()
        self._watcher.join()
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            with contextlib.suppress(OSError):
                pipe.close()

    def run(self, number: str, function: str, arguments: bytes, forbidden: tuple[str, ...] = ()) -> Run:
        """Run one answer on a pickle of its arguments."""
        order = pickle.dumps((number, function, arguments, forbidden))
        self._deadline = time.monotonic() + self.limits.seconds + ORDER_SECONDS
        head, calls, count = {}, [], 0
        try:
            self._process.stdin.write(struct.pack("=Q", len(order)) + order)
            self._process.stdin.flush()
            while "end" not in (message := self._line()):
                if (count := count + 1) > MAX_MESSAGES:
                    raise AnswerFormatError("sends more messages than there are calls")
                if "call" in message:
                    calls.append(message)
                else:
                    head = message | {"problems": [*head.get("problems", []), *message.get("problems", [])]}
            return Run(head, calls, one_line(message["end"]))
        except (OSError, AnswerFormatError) as error:
            self._ended = self._ended or one_line(error)
            self._kill()
            return Run(head, calls, self._ended)

    def _line(self) -> dict:
        """Return the next message. Raises `AnswerFormatError` with the reason if there is none."""
        line = self._process.stdout.readline(MAX_LINE)
        if not line.endswith(b"\n"):
            if len(line) >= MAX_LINE:
                raise AnswerFormatError(f"answers more than {MAX_LINE >> 20} MB")
            said = self._process.stderr.read(10_000).decode(errors="replace").strip().splitlines()[-1:]
            raise AnswerFormatError(self._ended or one_line(f"ends its process before it has answered {said or ''}"))
        return load(line)

    def _watch(self) -> None:
        """Kill all processes if they last too long, are too many, or take too much memory together."""
        while not self._closed and self._process.poll() is None:
            count, used = processes_and_memory(self._process.pid, 2 * self.limits.processes)
            if time.monotonic() > self._deadline:
                self._ended = "does not end in time"
            elif count > 2 * self.limits.processes:  # for root, whose processes the kernel does not limit
                self._ended = f"starts more than {2 * self.limits.processes} processes"
            elif (memory := psutil.virtual_memory()).available < MIN_FREE * memory.total:
                self._ended = "takes more memory than there is"
            elif used > self.limits.memory_mb << 20:
                self._ended = f"takes more than {self.limits.memory_mb} MB ({used >> 20} MB)"
            if self._ended:
                self._kill()
                return
            time.sleep(LOOK_EVERY)

    def _kill(self) -> None:
        """Kill the outermost process; the kernel ends all others of its namespace, and without walls we do."""
        others = []
        with contextlib.suppress(psutil.Error):
            others = psutil.Process(self._process.pid).children(recursive=True)
        self._process.kill()
        for one in others:
            with contextlib.suppress(psutil.Error):
                one.kill()
        self._process.wait()


def processes_and_memory(pid: int, most: int) -> tuple[int, int]:
    """Return how many processes there are below one, and the bytes that they hold in memory and in files of memory.

    Of more than `most` processes the memory is not asked for.
    """
    total, found = 0, []
    with contextlib.suppress(psutil.Error):
        found = psutil.Process(pid).children(recursive=True)
    for one in found if len(found) <= most else ():
        with contextlib.suppress(psutil.Error, OSError):
            total += one.memory_full_info().pss
            for file in os.scandir(f"/proc/{one.pid}/fd"):
                if os.readlink(file.path).startswith(("/memfd:", "/tmp/", "/dev/shm")):
                    total += os.stat(file.path).st_blocks * 512
    return len(found), total
