"""A run that is killed, or whose disk is full, leaves the old or the new, never half; without run.json it is not whole.

A run is stopped with SIGKILL at one of the things that it does to files (Python's audit events), so nothing clears up.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
from itertools import count
from pathlib import Path

import pytest

from course_lib.files import atomic_write
from courseware.run_folder import run_folder

pytest.importorskip("resource", reason="kill -9 is POSIX's")
ROOT = Path(__file__).parents[1]
NAMES = ("a.json", "b.csv", "pictures/c.png")


def watch(stage, chosen):
    """Count what this process does to files below `stage` from now on, and kill it at the chosen step."""
    steps = []

    def seen(event, given):
        writes = event == "open" and (given[2] or 0) & (os.O_WRONLY | os.O_RDWR)
        if writes or event in ("os.mkdir", "os.rename", "os.remove", "os.rmdir", "os.chmod"):
            if str(given[0]).startswith(str(stage)):
                steps.append(event)
                if len(steps) == chosen:
                    os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(seen)
    return steps


def comes_to_its_end(work, stage, step):
    """Whether `work`, in a process of its own, ends before that step, at which it is killed."""
    child = os.fork()
    if not child:
        with contextlib.suppress(BaseException):
            watch(stage, step)
            work()
            os._exit(0)
        os._exit(1)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    assert code in (0, -signal.SIGKILL)
    return code == 0


def tree(folder):
    """The files of a folder, without those that are being written: the names of these begin with a dot."""
    paths = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    return {name: path.read_bytes() for name, path in paths.items() if not name.startswith(".")}


def write_run(out, text):
    with run_folder(out, "test") as folder:
        for name in NAMES:
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_text(text)


def test_a_file_is_the_old_or_the_new_wherever_its_writer_is_killed(tmp_path):
    path, new = tmp_path / "map.json", b"new" * 100_000
    for step in count(1):
        path.write_bytes(b"old")
        if comes_to_its_end(lambda: atomic_write(path, new), tmp_path, step):
            break
        assert path.read_bytes() in (b"old", new)
    assert step > 3
    assert path.read_bytes() == new


def test_a_folder_is_the_old_the_new_or_seen_as_not_whole_wherever_its_run_is_killed(tmp_path):
    out, states, ended, steps = tmp_path / "out", set(), False, count(1)
    while not ended:
        shutil.rmtree(out, ignore_errors=True)
        write_run(out, "old")
        ended = comes_to_its_end(lambda: write_run(out, "new"), tmp_path, next(steps))
        files = tree(out)
        is_whole = files.pop("run.json", None) is not None
        assert set(files) == set(NAMES)
        states.add((is_whole, *sorted(set(files.values()))))
    assert states == {(True, b"old"), (False, b"old"), (False, b"new", b"old"), (False, b"new"), (True, b"new")}


@pytest.mark.skipif(subprocess.call("unshare -rm true 2>/dev/null", shell=True) != 0, reason="no mount of one's own")
def test_on_a_full_disk_the_old_stays_whole_and_the_error_says_why(tmp_path):
    program = "import sys; from tests.test_interrupt import *; out = Path(sys.argv[1]) / 'out'; write_run(out, 'old')\n"
    program += "try:\n    write_run(out, 'new' * 100_000)\nexcept OSError as error:\n    print(error)\n"
    program += "print(sorted(tree(out).items()))"
    mount = 'mount -t tmpfs -o size=256k none "$1" && exec "$2" -c "$3" "$1"'
    command = ["unshare", "-rm", "sh", "-c", mount, "sh", str(tmp_path), sys.executable, program]
    error, files = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=True).stdout.splitlines()
    assert "No space left on device" in error
    assert [name for name in NAMES if f"('{name}', b'old')" not in files] == []
    assert "'run.json'" in files
