"""The walls around a submission: bubblewrap makes them, prlimit bounds each process, and we watch the sum.

In its own namespaces a submission finds the system, Python and the course read-only, without the folder
`courseware/answers`. It has a folder of limited size, no network and no other process. A filter refuses system calls
that go around the namespaces or the watch. `--trust` runs the same process without walls.
"""

import compileall
import contextlib
import errno
import mmap
import os
import pickle
import platform
import shutil
import signal
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import NamedTuple

import psutil

from courseware import PACKED
from courseware.classroom.exchange import AnswerFormatError, load, one_line
from courseware.paths import REPOSITORY

PACKAGES = ("course_lib", "courseware")
SYSTEM = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache", "/etc/fonts", "/etc/localtime")
SYSTEM += ("/etc/alternatives", "/sys/devices/system/cpu")
ENVIRONMENT = {
    "PATH": "/usr/bin:/bin", "HOME": "/tmp", "LANG": "C.UTF-8", "MPLBACKEND": "Agg", "MPLCONFIGDIR": "/tmp",
    "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow", "PYTHONDONTWRITEBYTECODE": "1", "PYTHONHASHSEED": "0",
    "LP_NUM_THREADS": "0", "PYTHONUNBUFFERED": "1",
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"),
}  # fmt: skip
"""All that the process finds in its environment."""
REFUSED = (
    "shmget", "semget", "msgget", "memfd_create", "memfd_secret", "vmsplice",  # memory that no process is charged for
    "socket", "socketpair", "io_uring_setup",  # buffers without bound, other machines, open files on their way
    "add_key", "request_key", "keyctl",  # the session keyring is the teacher's
    "ptrace", "process_vm_readv", "process_vm_writev", "pidfd_getfd", "userfaultfd", "bpf", "perf_event_open",
)  # fmt: skip
"""System calls that no answer needs. The filter answers "not implemented", so libraries use a fallback."""
PYTHON = (sys.executable, "-P", "-s", "-B", "-c")
START_SECONDS = 300.0  # until the file is read; only a fault takes so long
LOOK_EVERY = 0.1  # seconds between two looks at memory
MAX_LINE = 16 << 20  # bytes of one call's answer; right answers have some kilobytes
MAX_MESSAGES = 500  # of one answer
ORDER_SECONDS = 30.0  # of one answer, in addition to its own time
MIN_FREE = 0.05  # of the machine's memory: with less, what runs is stopped, whoever took it
HOW_TO = (
    "strangers' code is kept in by bubblewrap 0.8 or newer and libseccomp. Install both (Debian, Ubuntu: apt install "
    "bubblewrap libseccomp2; Fedora: dnf install bubblewrap libseccomp; the Python package pyseccomp: python3 "
    "course.py check), or grade in the container of courseware/classroom/Containerfile. If you have read every file "
    "and trust it, add --trust"
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


def copy_library(folder: Path) -> None:
    """Copy both packages into an empty folder, without `courseware/answers`."""

    def left_out(place: str, names: list[str]) -> set[str]:
        here = Path(place)
        if here.name == "__pycache__":  # bytecode of an older version may hold solutions; Numba's is machine code
            return {name for name in names if not name.endswith((".nbi", ".nbc"))}
        return {"answers", PACKED} if here == REPOSITORY / "courseware" else set()

    for package in PACKAGES:
        shutil.copytree(REPOSITORY / package, folder / package, ignore=left_out)
        compileall.compile_dir(folder / package, quiet=2)  # once, not in every sandbox
    (folder / "data").symlink_to(REPOSITORY / "data")  # without walls; inside them it is a mount


def require_walls() -> None:
    """Raise `SandboxError` unless bubblewrap and the filter are here, and bubblewrap may make its namespaces."""
    try:
        with start(["sh", "-c", "true & wait"], Limits(), stderr=subprocess.PIPE, text=True) as tried:
            said = tried.stderr.read()
    except (ImportError, RuntimeError, OSError) as error:  # pyseccomp finds no libseccomp, or there is no bwrap
        raise SandboxError(f"{platform.system()} has no walls here ({error}): {HOW_TO}") from None
    if tried.returncode:
        raise SandboxError(f"bubblewrap does not start ({one_line(said, 200)}): {HOW_TO}")


def start(
    command: list[str], limits: Limits, library: Path | None = None, submission: Path | None = None, **given: object
) -> subprocess.Popen:
    """Start a command within the walls. given: more arguments of `Popen`."""
    program = filter_program()
    bound = ["--seccomp", str(program), "prlimit", f"--fsize={limits.folder_mb << 20}", "--nofile=256", "--core=0"]
    bound += [f"--as={4 * limits.memory_mb << 20}", f"--nproc={limits.processes}"]
    try:
        within = [*walls(limits, library, submission), *bound, *command]
        return subprocess.Popen(within, env=ENVIRONMENT, pass_fds=[program], **given)
    finally:
        os.close(program)


def filter_program() -> int:
    """Return an open file from which bubblewrap reads the filter. A process that calls as a 32-bit program is ended."""
    import pyseccomp  # only here, because --trust works without it

    program, refuse = pyseccomp.SyscallFilter(pyseccomp.ALLOW), pyseccomp.ERRNO(errno.ENOSYS)
    program.set_attr(pyseccomp.Attr.ACT_BADARCH, pyseccomp.KILL_PROCESS)
    for name in REFUSED:
        program.add_rule(refuse, name)
    # A child can fill shared memory that has no file, and end. Then no process is charged for it.
    shared = mmap.MAP_SHARED | mmap.MAP_ANONYMOUS
    program.add_rule(refuse, "mmap", pyseccomp.Arg(3, pyseccomp.MASKED_EQ, shared, shared))
    read, write = os.pipe()  # takes 64 kB at once; the program has less than one
    with open(write, "wb") as file:
        program.export_bpf(file)
    return read


def walls(limits: Limits, library: Path | None = None, submission: Path | None = None) -> list[str]:
    """Return bubblewrap's command line, to which what runs is added."""
    command = ["bwrap", "--unshare-all", "--unshare-user", "--disable-userns", "--die-with-parent", "--new-session"]
    command += ["--cap-drop", "ALL", "--uid", "65534", "--gid", "65534", "--hostname", "grading"]
    bounded = ["--size", str(limits.folder_mb << 20), "--tmpfs"]
    command += ["--proc", "/proc", "--dev", "/dev", *bounded, "/tmp", *bounded, "/dev/shm"]
    for path in map(Path, SYSTEM):
        linked = path.is_symlink() and path.parent == Path("/")
        command += ["--symlink", os.readlink(path), str(path)] if linked else ["--ro-bind-try", str(path), str(path)]
    for path in {sys.prefix, sys.base_prefix, sys.exec_prefix} - {"/usr"}:
        command += ["--ro-bind", path, path]
    if library is not None:
        for package in PACKAGES:
            command += ["--ro-bind", str(library / package), f"/course/{package}"]
        command += ["--ro-bind", str(REPOSITORY / "data"), "/course/data"]
    if submission is not None:
        command += ["--ro-bind", str(submission), f"/handed_in/submission{submission.suffix.lower()}"]
    command += ["--ro-bind", "/dev/null", "/dev/zero"]  # zero would give memory without a file; this cannot be opened
    return [*command, "--remount-ro", "/dev", "--remount-ro", "/", "--chdir", "/tmp"]


class Sandbox:
    """One submission in its sandbox: a context manager. `opened` is what the file holds; `run` runs one answer."""

    def __init__(self, submission: Path, library: Path, limits: Limits, trust: bool = False) -> None:
        self.limits, self._ended, self._closed = limits, "", False
        path = submission.resolve() if trust else Path(f"/handed_in/submission{submission.suffix.lower()}")
        place = library if trust else Path("/course")
        code = f"import sys; sys.path.insert(0, {str(place)!r}); from courseware.classroom.inside import main; "
        code += f"main({str(path)!r}, {limits.call_seconds!r}, {limits.seconds!r})"
        python = [*PYTHON, code]
        pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE) | {"start_new_session": True}
        if trust:
            environment = os.environ | ENVIRONMENT | {"HOME": str(library)}
            self._process = subprocess.Popen(python, cwd=library, env=environment, **pipes)
        else:
            self._process = start(python, limits, library, submission.resolve(), **pipes)
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
        most = 2 * self.limits.processes
        try:
            while not self._closed and not self._ended and self._process.poll() is None:
                time.sleep(LOOK_EVERY)
                count, used = processes_and_memory(self._process.pid, most)
                if time.monotonic() > self._deadline:
                    self._ended = "does not end in time"
                elif count > most:  # for root, whose processes the kernel does not limit
                    self._ended = f"starts more than {most} processes"
                elif (memory := psutil.virtual_memory()).available < MIN_FREE * memory.total:
                    self._ended = "takes more memory than there is"
                elif used > self.limits.memory_mb << 20:
                    self._ended = f"takes more than {self.limits.memory_mb} MB ({used >> 20} MB)"
        finally:  # nothing runs unwatched, even if the watch fails
            self._kill()

    def _kill(self) -> None:
        """Kill the outermost process and its group. Within walls, the kernel then ends all others of the namespace."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()


def processes_and_memory(pid: int, most: int) -> tuple[int, int]:
    """Return how many processes there are below one, and the bytes that the first `most` of them hold together."""
    total, found = 0, []
    with contextlib.suppress(psutil.Error):
        found = psutil.Process(pid).children(recursive=True)
    for one in found[:most]:
        with contextlib.suppress(psutil.Error, OSError):
            held = one.memory_full_info()
            total += held.pss + held.swap
            if not held.rss:  # its main thread has ended: what it holds stands only with its other threads
                sizes = [file.read_text().split()[1] for file in Path(f"/proc/{one.pid}/task").glob("*/statm")]
                total += max(map(int, sizes), default=0) * mmap.PAGESIZE
    return len(found), total
