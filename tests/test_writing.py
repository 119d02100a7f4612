"""Whatever stops a writer, the old or the new is there whole, and the next run clears what was left."""

import contextlib
import ctypes
import os
import random
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from course_lib import unfinished, writing
from course_lib.simulation.data_folder import move_products
from course_lib.unfinished import UNFINISHED
from course_lib.writing import MADE, WriteError, replaced_outputs, write_at_once


def names(folder):
    """Files below a folder, the list of what was made apart."""
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if not p.is_dir() and p.name != MADE)


def left_over(folder):
    return [path.name for path in folder.rglob(f"*{UNFINISHED}*")]


def make(out, contents, command="demo"):
    with replaced_outputs(out, command) as new:
        for name, text in contents.items():
            (new / name).parent.mkdir(parents=True, exist_ok=True)
            (new / name).write_text(text)


def test_a_file_is_written_and_replaced(tmp_path):
    write_at_once(tmp_path / "a.txt", "één")
    write_at_once(tmp_path / "a.txt", b"two")
    assert (tmp_path / "a.txt").read_bytes() == b"two"
    assert names(tmp_path) == ["a.txt"]


def test_a_file_keeps_its_mode_and_a_new_one_gets_the_usual(tmp_path):
    (tmp_path / "plain.txt").write_text("")
    write_at_once(tmp_path / "new.txt", "")
    assert (tmp_path / "new.txt").stat().st_mode == (tmp_path / "plain.txt").stat().st_mode
    (tmp_path / "plain.txt").chmod(0o600)
    write_at_once(tmp_path / "plain.txt", "more")
    assert (tmp_path / "plain.txt").stat().st_mode & 0o777 == 0o600


def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "target.txt").write_text("old")
    (tmp_path / "link.txt").symlink_to("target.txt")
    write_at_once(tmp_path / "link.txt", "new")
    assert (tmp_path / "link.txt").is_symlink()
    assert (tmp_path / "target.txt").read_text() == "new"


def test_what_cannot_be_written_says_where_and_why(tmp_path):
    with pytest.raises(WriteError, match=r"nowhere/a\.txt cannot be written: there is no such folder"):
        write_at_once(tmp_path / "nowhere" / "a.txt", "x")
    (tmp_path / "file").write_text("x")
    with pytest.raises(WriteError, match="a part of its path is a file"):
        write_at_once(tmp_path / "file" / "a.txt", "x")


def test_an_interrupted_write_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    write_at_once(tmp_path / "a.txt", "old")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_at_once(tmp_path / "a.txt", "new")
    assert (tmp_path / "a.txt").read_text() == "old"
    assert names(tmp_path) == ["a.txt"]


def test_outputs_replace_those_of_the_same_command_and_nothing_else(tmp_path):
    out = tmp_path / "out"
    make(out, {"table.json": "1", "old/figure.png": "1"})
    make(out, {"room.json": "1"}, command="other")
    (out / "notes.txt").write_text("mine")
    (out / "mine").symlink_to("old", target_is_directory=True)
    make(out, {"table.json": "2", "new/figure.png": "2"})
    assert names(out) == ["new/figure.png", "notes.txt", "room.json", "table.json"]
    assert (out / "mine").is_symlink()
    assert (out / "table.json").read_text() == "2"
    assert (out / "notes.txt").read_text() == "mine"
    assert left_over(tmp_path) == []


def test_a_failed_run_leaves_the_earlier_outputs(tmp_path):
    out = tmp_path / "out"
    make(out, {"table.json": "1"})
    with contextlib.suppress(ZeroDivisionError), replaced_outputs(out, "demo") as new:
        (new / "table.json").write_text("2")
        raise ZeroDivisionError
    assert names(tmp_path) == ["out/table.json"]
    assert (out / "table.json").read_text() == "1"


def test_a_run_in_the_folder_it_writes_to_leaves_the_caller_where_it_is(tmp_path, monkeypatch):
    out = tmp_path / "out"
    make(out, {"table.json": "1", "gone.png": "1"})
    monkeypatch.chdir(out)
    before = os.stat(".").st_ino
    make(out, {"table.json": "2"})
    assert os.stat(".").st_ino == before == out.stat().st_ino
    assert names(out) == ["table.json"]
    assert (out / "table.json").read_text() == "2"


def test_where_folders_cannot_be_exchanged_the_files_change_places(tmp_path, monkeypatch):
    monkeypatch.setattr(writing, "_exchange", lambda one, other: False)
    out = tmp_path / "out"
    make(out, {"table.json": "1", "gone.png": "1"})
    (out / "notes.txt").write_text("mine")
    make(out, {"table.json": "2"})
    assert names(tmp_path) == ["out/notes.txt", "out/table.json"]
    assert (out / "table.json").read_text() == "2"


def test_a_run_killed_while_files_change_places_is_completed_by_the_next(tmp_path, monkeypatch):
    out = tmp_path / "out"
    make(out, {"a.json": "1", "b.json": "1", "gone.png": "1"})
    monkeypatch.setattr(writing, "_exchange", lambda one, other: False)
    with monkeypatch.context() as killed:
        killed.setattr(unfinished, "_move_all", lambda beside, out: (_ for _ in ()).throw(SystemExit))
        killed.setattr(unfinished.shutil, "rmtree", lambda *_, **__: None)
        with pytest.raises(SystemExit):
            make(out, {"a.json": "2", "b.json": "2"})
    assert len(left_over(out)) == 1
    make(out, {"room.json": "1"}, command="other")
    assert names(out) == ["a.json", "b.json", "room.json"]
    assert (out / "a.json").read_text() == (out / "b.json").read_text() == "2"
    assert left_over(tmp_path) == []


def test_what_a_list_of_outputs_names_outside_its_folder_is_never_removed(tmp_path):
    out = tmp_path / "out"
    make(out, {"a.json": "1"})
    (tmp_path / "precious").write_text("x")
    (out / MADE).write_text('{"demo": ["../precious", "a.json"]}')
    make(out, {"b.json": "1"})
    assert (tmp_path / "precious").exists()
    assert names(out) == ["b.json"]


def test_without_a_command_no_list_is_kept_and_the_products_are_replaced_folders_and_all(tmp_path):
    out = tmp_path / "out"
    (out / "lessons" / "old").mkdir(parents=True)
    (out / "lessons" / "old" / "03.ipynb").write_text("old")
    (out / "mine").mkdir()
    (out / "notes.txt").write_text("mine")
    with replaced_outputs(out, None, ("lessons",)) as new:
        (new / "lessons").mkdir()
        (new / "lessons" / "06.ipynb").write_text("new")
    found = sorted(path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*"))
    assert found == ["out", "out/lessons", "out/lessons/06.ipynb", "out/mine", "out/notes.txt"]


def test_a_folder_that_is_kept_keeps_its_mode(tmp_path):
    out = tmp_path / "out"
    make(out, {"a.json": "1"})
    (out / "private").mkdir(mode=0o700)
    (out / "private" / "notes.txt").write_text("mine")
    make(out, {"a.json": "2"})
    assert (out / "private").stat().st_mode & 0o777 == 0o700


def test_interrupted_while_files_change_places_what_was_made_whole_is_moved_whole(tmp_path, monkeypatch):
    """Ctrl-C between two of the files: neither half of the one run nor half of the other."""
    monkeypatch.setattr(writing, "_exchange", lambda one, other: False)
    out = tmp_path / "out"
    make(out, {"a.json": "1", "b.json": "1"})
    replace, moved = os.replace, []

    def interrupted(old, new):
        if str(new).endswith("b.json") and not moved:
            moved.append(new)
            raise KeyboardInterrupt
        replace(old, new)

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        make(out, {"a.json": "2", "b.json": "2"})
    assert moved
    assert {(out / name).read_text() for name in ("a.json", "b.json")} == {"2"}
    assert left_over(tmp_path) == []


@pytest.mark.skipif(not hasattr(signal, "raise_signal") or os.name == "nt", reason="Ctrl-C at a step of the system")
@pytest.mark.parametrize("step", ["os.mkdir", "open", "fcntl.flock"])
def test_ctrl_c_between_making_and_knowing_leaves_nothing(tmp_path, step):
    (tmp_path / "alone.txt").write_text("old")
    program = f"""
import signal, sys
from pathlib import Path
from course_lib.writing import replaced_outputs, staged, write_at_once
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


def test_files_are_staged_beside_their_places_and_nothing_is_left(tmp_path):
    left = tmp_path / f".{tmp_path.name}{UNFINISHED}abcdefgh"
    left.mkdir()
    (left / "0").write_text("of a killed run")
    with writing.staged(tmp_path) as stage:
        assert not left.exists()
        write_at_once(stage / "0", "new")
        os.replace(stage / "0", tmp_path / "a.txt")
        write_at_once(stage / "1", "not moved")
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_copies_of_made_data_name_the_full_disk(tmp_path, monkeypatch):
    """`copytree` would collect what every file said, and the number of the error would be lost."""
    (tmp_path / "made" / "wagon").mkdir(parents=True)
    (tmp_path / "made" / "wagon" / "0.png").write_text("x")

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("shutil.copy2", full)
    with pytest.raises(WriteError, match="data cannot be written: the disk is full"):
        move_products(tmp_path / "made", tmp_path / "data", ["wagon"])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["made"]


def test_what_cannot_be_written_is_refused_before_the_work(tmp_path):
    writing.require_writable(tmp_path / "new" / "deep")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").write_text("x")
    for folder in (tmp_path / "file", tmp_path / "file" / "deep", "/proc/nope") if os.path.isdir("/proc") else ():
        with pytest.raises(WriteError, match=re.escape(str(folder))):
            writing.require_writable(folder)


@pytest.mark.parametrize("text", ["", "[", "[1]", '{"demo": 3}', '{"demo": [3]}', "\udc80"])
def test_a_damaged_list_of_outputs_costs_nothing(tmp_path, text):
    out = tmp_path / "out"
    make(out, {"a.json": "1"})
    (out / MADE).write_bytes(text.encode("utf-8", "surrogatepass"))
    make(out, {"b.json": "1"})
    assert names(out) == ["a.json", "b.json"]


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
from course_lib.writing import replaced_outputs, write_at_once
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
from course_lib.writing import WriteError, replaced_outputs, require_writable, write_at_once
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
