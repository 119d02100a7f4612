"""Try, before every grading, what a hostile answer would try. Each attempt runs in the sandbox and must fail."""

import contextlib
import json
import os
import platform
import socket
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from string import Template

from course_lib.files import temporary_folder
from courseware.classroom.sandbox import ENVIRONMENT, PYTHON, Limits, SandboxError, start

ATTEMPTS: dict[str, str] = tomllib.loads(Path(__file__).with_name("attempts.toml").read_text(encoding="utf-8"))
"""What is tried, in words, and how."""
MARK = "course-target"  # in the command line of the process that an attempt looks for
FRAME = """
import ctypes, json, os, socket, sys, tempfile
libc = ctypes.CDLL(None, use_errno=True)
KNOWN, PYTHON = {known}, {python}

def grader(pid):
    return {mark!r} in open(f"/proc/{{pid}}/cmdline").read()

def fill(files):
    for file in files:
        os.posix_fallocate(file.fileno(), 0, {folder} // 10)
    globals()["filled"] = True

for what, code in json.loads({attempts!r}).items():
    names, filled = dict(globals(), got=None), False
    try:
        exec(code, names)
    except BaseException:
        names["got"] = None
    got = names["got"] or (filled and "more than the limit")
    print(json.dumps([what, repr(got)[:80] if got else ""]), flush=True)
    names.clear()
    for folder in ("/tmp/", "/dev/shm/"):
        for name in os.listdir(folder):
            if name.isdigit():
                os.remove(folder + name)
"""


def self_test(library: Path, limits: Limits) -> tuple[list[str], str]:
    """Return what was tried in vain, and what this machine is. Raises `SandboxError` if an attempt succeeded."""
    found = attempts(library, limits)
    if through := [f"{what} ({got})" for what, got in found.items() if got]:
        raise SandboxError(
            f"nothing was graded, because this machine's walls do not hold. Strangers' code can {'; '.join(through)}. "
            "Grade in the container of courseware/classroom/Containerfile, or add --trust if you have read every file"
        )
    version = subprocess.run(["bwrap", "--version"], capture_output=True, text=True, check=True).stdout.strip()
    return list(found), f"{platform.system()} {platform.release()}, {version}, Python {platform.python_version()}"


def attempts(library: Path, limits: Limits) -> dict[str, str]:
    """Return for every attempt what it got, or "" if it failed."""
    with _outside() as there:
        names = there | {"bytes": limits.folder_mb << 20, "home": Path.home()}
        codes = {what: Template(code).substitute(names) for what, code in ATTEMPTS.items()}
        program = FRAME.format(
            mark=MARK, known=[*ENVIRONMENT, "LC_CTYPE", "PWD"], attempts=json.dumps(codes), folder=names["bytes"],
            python=[*Path(sys.prefix).parts, *Path(sys.base_prefix).parts],
        )  # fmt: skip
        submission = there["folder"] / "submission.py"
        submission.touch()
        pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        with start([*PYTHON, program], limits, library, submission, **pipes) as process:
            try:
                out, said = process.communicate(timeout=120)
            except subprocess.TimeoutExpired:
                process.kill()
                raise SandboxError("the walls' test does not end on this machine") from None
    found = dict(json.loads(line) for line in out.splitlines())
    if list(found) != list(ATTEMPTS):
        raise SandboxError(f"the walls' test did not run to its end: {said.strip()[-300:]}")
    return found


@contextlib.contextmanager
def _outside() -> Iterator[dict]:
    """Put outside what an attempt looks for, and yield its names."""
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(temporary_folder())
        (folder / "secret").write_text("secret", encoding="utf-8")
        asleep = [sys.executable, "-c", "import time; time.sleep(600)", MARK]
        process = stack.enter_context(subprocess.Popen(asleep))
        stack.callback(process.kill)
        listening = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        abstract = f"course-{os.getpid()}"
        for name in (f"{folder}/socket", f"\0{abstract}"):
            stack.enter_context(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)).bind(name)
        port = listening.getsockname()[1]
        yield {"secret": folder / "secret", "folder": folder, "abstract": abstract, "port": port, "pid": process.pid}
