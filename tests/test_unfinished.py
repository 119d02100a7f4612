"""Whatever stops a writer of a file or a folder, the old or the new is there whole, and what was left is cleared."""

import ctypes
import os
import random
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from course_lib.writing import write_at_once
from tests.made_outputs import left_over, make, names


@pytest.mark.skipif(not hasattr(signal, "raise_signal") or os.name == "nt", reason="Ctrl-C at a step of the system")
@pytest.mark.parametrize("step", ["os.mkdir", "open", "fcntl.flock"])
def test_ctrl_c_between_making_and_knowing_leaves_nothing(tmp_path, step):
    (tmp_path / "alone.txt").write_text("old")
    program = f"""
import signal, sys
from pathlib import Path
from course_lib.output_folder import replaced_outputs, staged
from course_lib.writing import write_at_once
disk, armed = Path({str(tmp_path)!r}), []
def hook(event, arguments):
    if armed and event == {step!r} and (event != "open" or UNFINISHED in str(arguments[0])):
        armed.clear()
        signal.raise_signal(signal.SIGINT)
from course_lib.unfinished import UNFINISHED
sys.addaudithook(hook)
def folder():
    with replaced_outputs(disk / "out", "demo") as new: (new / "a").write_text("new")
def stage():
    with staged(disk): pass
for act in (lambda: write_at_once(disk / "alone.txt", "new"), folder, stage):
    armed.append(1)
    try:
        act()
    except KeyboardInterrupt:
        print("stopped")
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.count("stopped") >= 2
    assert left_over(tmp_path) == []
    assert not any((tmp_path / "out").glob("*"))


def test_many_writers_of_one_name_never_break_each_other(tmp_path):
    def write(i):
        write_at_once(tmp_path / "a.txt", str(i) * 10_000)
        make(tmp_path / "out", {f"{i % 4}.json": str(i) * 1000}, command=f"demo {i % 4}")

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(write, range(200)))
    assert set((tmp_path / "a.txt").read_text()) <= set("0123456789")
    assert names(tmp_path / "out") == ["0.json", "1.json", "2.json", "3.json"]
    assert left_over(tmp_path) == []


WRITER = """
import sys
from pathlib import Path
from course_lib.output_folder import replaced_outputs
from course_lib.writing import write_at_once
out, n = Path(sys.argv[1]), int(sys.argv[2])
print("ready", flush=True)
while True:
    n += 1
    write_at_once(out.parent / "alone.txt", f"{n} " * 20_000)
    with replaced_outputs(out, "demo") as new:
        for name in ("a", "b", "c"):
            (new / name).write_text(f"{n} " * 20_000)
"""


@pytest.mark.skipif(os.name == "nt", reason="kill -9")
def test_killed_at_any_moment_the_old_or_the_new_is_there_whole(tmp_path):
    """40 moments here; `course.py interrupt` has 200 over the commands."""
    out, draw = tmp_path / "in" / "out", random.Random(14)
    out.parent.mkdir()
    for kill in range(40):
        writer = subprocess.Popen(
            [sys.executable, "-c", WRITER, str(out), str(1000 * kill)], stdout=subprocess.PIPE, cwd=tmp_path
        )
        writer.stdout.readline()
        time.sleep(draw.uniform(0, 0.05))
        writer.send_signal(signal.SIGKILL)
        writer.wait()
        writer.stdout.close()
        if out.exists():
            texts = {(out / name).read_text() for name in ("a", "b", "c")}
            assert len(texts) == 1
            assert len(texts.pop().split()) == 20_000
        if (alone := out.parent / "alone.txt").exists():
            assert len(set(alone.read_text().split())) == 1
            assert len(alone.read_text().split()) == 20_000
    make(out, {"a": "1", "b": "1", "c": "1"})
    write_at_once(out.parent / "alone.txt", "1")
    assert names(tmp_path) == ["in/alone.txt", "in/out/a", "in/out/b", "in/out/c"]


def can_mount():
    """Whether this user may mount a small disk in a namespace of its own."""
    if not sys.platform.startswith("linux"):
        return False
    done = subprocess.run(["unshare", "-rm", "true"], capture_output=True, check=False)
    return done.returncode == 0 and hasattr(ctypes.CDLL(None), "mount")


FULL = """
import sys
from pathlib import Path
from course_lib.output_folder import replaced_outputs, require_writable
from course_lib.writing import WriteError, write_at_once
disk = Path(sys.argv[1])
write_at_once(disk / "alone.txt", "old")
for out in (disk / "out", disk):
    with replaced_outputs(out, "demo") as new:
        (new / "a").write_text("old")
for act in ("file", "folder", "mount"):
    try:
        if act == "file":
            write_at_once(disk / "alone.txt", "x" * 2_000_000)
        else:
            with replaced_outputs(disk / "out" if act == "folder" else disk, "demo") as new:
                (new / "a").write_text("new")
                (new / "b").write_text("x" * 2_000_000)
    except WriteError as error:
        print(error)
(disk / "rest").write_bytes(b"")
try:
    with (disk / "rest").open("wb", buffering=0) as file:
        while file.write(bytes(4096)):
            pass
except OSError:
    pass
try:
    require_writable(disk / "results")
except WriteError as error:
    print(error)
(disk / "rest").unlink()
files = [p for p in disk.rglob("*") if p.is_file() and p.name[0] != "."]
print(sorted((p.relative_to(disk).as_posix(), p.read_text()) for p in files))
"""


@pytest.mark.skipif(not can_mount(), reason="no disk of its own can be mounted here")
def test_on_a_full_disk_the_old_stays_and_the_message_names_the_file(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    script = f'mount -t tmpfs -o size=1m none "{disk}" && exec "{sys.executable}" -c "$1" "{disk}"'
    done = subprocess.run(
        ["unshare", "-rm", "sh", "-c", script, "sh", FULL], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    *told, found = done.stdout.splitlines()
    assert [line.split(": ")[0] for line in told] == [
        f"{place} cannot be written" for place in (disk / "alone.txt", disk / "out", disk, disk / "results")
    ]
    assert all("disk is full" in line for line in told)
    assert found == str([("a", "old"), ("alone.txt", "old"), ("out/a", "old")])
