"""Runs of writing commands that are stopped at a chosen moment: by the clock, or at a step of theirs in the system.

A run is a process of its own, with a few lines before its program that count what it does to files (Python's audit
events) and stop it, and what it started, at the one that was chosen. The program itself knows nothing of it. So that
moments fall on the work and not on the imports, runs are forks of a process that has imported what the program needs.
"""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from course_lib.child import python, start
from course_lib.paths import REPOSITORY
from course_lib.scratch import scratch_folder

HANGS_S = 1800.0

STEPS = ("open", "os.mkdir", "os.rename", "os.link", "os.symlink", "os.remove", "os.rmdir", "os.chmod", "os.truncate")
"""Audit events that change files (open: for writing), beside a lock that is taken and an exchange of two folders."""

_FORKING = f"""
import importlib, json, os, signal, sys, threading, time, traceback
sys.path.insert(0, sys.argv[1])

def run(stage, program, words, chosen, delay, number, told):
    me, steps, now = os.getpid(), [0], threading.Event()

    def stop():
        now.wait()
        time.sleep(delay)
        os.killpg(0, number)

    def counted(event, given):
        if os.getpid() != me:
            return
        if event == "ctypes.dlsym":
            if given[1] != "renameat2":
                return
        elif event != "fcntl.flock":
            if event not in {STEPS!r} or (event == "open" and not given[2] & (os.O_WRONLY | os.O_RDWR)):
                return
            path = os.fsdecode(given[0]) if isinstance(given[0], (str, bytes, os.PathLike)) else ""
            if event in ("os.remove", "os.rmdir") and given[1] >= 0 and os.path.exists("/proc/self/fd"):
                path = os.path.join(os.readlink(f"/proc/self/fd/{{given[1]}}"), path)  # of a folder held open
            if os.path.isabs(path) and not path.startswith(stage):
                return
        steps[0] += 1
        if steps[0] == chosen:
            if delay:
                now.set()
            else:
                os.killpg(0, number)

    threading.Thread(target=stop, daemon=True).start()
    sys.argv[1:] = words
    sys.addaudithook(counted)
    try:
        exec(compile(program, "program", "exec"), {{"__name__": "__main__"}})
    finally:
        with open(told, "w") as file:
            json.dump([steps[0], sorted(sys.modules)], file)

for line in sys.stdin:
    call = json.loads(line)
    for name in call.pop("modules"):
        try:
            importlib.import_module(name)
        except Exception:
            pass
    out, error, environment = call.pop("out"), call.pop("error"), call.pop("environment")
    child = os.fork()
    if not child:
        code = 1
        try:
            os.setsid()
            os.chdir(call["stage"])
            os.environ.update(environment)
            for number, path in enumerate((os.devnull, out, error)):
                os.dup2(os.open(path, os.O_RDWR | os.O_CREAT), number)
            signal.signal(signal.SIGINT, signal.default_int_handler)
            run(**call)
            code = 0
        except SystemExit as ended:
            code = ended.code if isinstance(ended.code, int) else int(ended.code is not None)
        except BaseException:
            traceback.print_exc()
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
    print(child, flush=True)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""

COMMAND = "import sys\nfrom course_lib.cli import main\nsys.exit(main(sys.argv[1:]))"


class Moment(NamedTuple):
    """When a run is stopped, and how."""

    seconds: float | None = None
    """By the clock, from its start on."""
    step: int = 0
    """Or at this step, counted from 1 ..."""
    delay: float = 0.0
    """... or so many seconds after it: in the midst of what the step began."""
    signal: int = getattr(signal, "SIGKILL", signal.SIGTERM)

    def __str__(self) -> str:
        how = "Ctrl-C" if self.signal == signal.SIGINT else "kill -9"
        if self.seconds is not None:
            return f"{how} after {self.seconds:.3f} s"
        return f"{how} at step {self.step}" + f" + {self.delay * 1000:.1f} ms" * bool(self.delay)


class Ended(NamedTuple):
    """How a run ended."""

    code: int
    """0 and above: its own; below: minus the signal that stopped it."""
    printed: str
    complained: str
    steps: int
    """What it did to files, where it was not killed."""
    modules: tuple[str, ...]


class Runs:
    """A process whose forks run programs in the folder `stage`; a context manager.

    modules: names of what is imported once, before the forks. before: words before the interpreter's. What a killed run
    leaves in the folder for temporary files lies beside `stage`, and goes with it: whoever runs this keeps none of it.
    """

    def __init__(self, stage: Path, modules: Sequence[str] = (), before: Sequence[str] = ()) -> None:
        self.stage, self.modules = stage, list(modules)
        temporary = stage.parent / "tmp"
        temporary.mkdir(exist_ok=True)
        self._process = start(
            [*before, *python("-c", _FORKING, REPOSITORY)],
            {"PYTHONPATH": str(REPOSITORY), "TMPDIR": str(temporary)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,  # a line waits in the pipe, where `select` sees it, until it is read
        )

    def __enter__(self) -> Runs:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()

    def run(
        self, program: str, words: Sequence[str], environment: dict[str, str], moment: Moment | None = None
    ) -> Ended:
        """Runs Python `program` with `words`, and stops it at a moment (None: never).

        Raises `subprocess.TimeoutExpired` for a run that hangs.
        """
        moment = moment or Moment()
        with scratch_folder() as folder:
            out, error, told = (folder / name for name in ("out", "error", "told"))
            call = {
                "stage": str(self.stage),
                "program": program,
                "words": list(words),
                "chosen": moment.step,
                "delay": moment.delay,
                "number": int(moment.signal),
                "told": str(told),
                "out": str(out),
                "error": str(error),
                "environment": environment,
                "modules": self.modules,
            }
            self.modules = []
            self._process.stdin.write(json.dumps(call).encode() + b"\n")
            child = int(self._process.stdout.readline())
            try:
                if not self._ends_within(HANGS_S if moment.seconds is None else moment.seconds):
                    _stop_all(child)
                    if moment.seconds is None:
                        raise subprocess.TimeoutExpired(list(words), HANGS_S)
                code = int(self._process.stdout.readline())
            finally:
                _stop_all(child)
            texts = [path.read_text("utf-8", "replace") if path.exists() else "" for path in (out, error)]
            steps, modules = json.loads(told.read_text()) if code >= 0 and told.exists() else (0, [])
        return Ended(code, *texts, steps, tuple(modules))

    def _ends_within(self, seconds: float) -> bool:
        return bool(select.select([self._process.stdout], [], [], seconds)[0])


def _stop_all(child: int) -> None:
    """Kills whatever still runs of a run's session."""
    try:
        os.killpg(child, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass
