"""A run's outputs take the place of the earlier run's as a whole, and what is somebody else's stays."""

import contextlib
import os
import re

import pytest

from course_lib import output_folder, unfinished
from course_lib.output_folder import MADE, replaced_outputs, require_writable, staged
from course_lib.unfinished import UNFINISHED
from course_lib.writing import WriteError, write_at_once
from tests.made_outputs import left_over, make, names


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
    monkeypatch.setattr(output_folder, "_exchange", lambda one, other: False)
    out = tmp_path / "out"
    make(out, {"table.json": "1", "gone.png": "1"})
    (out / "notes.txt").write_text("mine")
    make(out, {"table.json": "2"})
    assert names(tmp_path) == ["out/notes.txt", "out/table.json"]
    assert (out / "table.json").read_text() == "2"


def test_a_run_killed_while_files_change_places_is_completed_by_the_next(tmp_path, monkeypatch):
    out = tmp_path / "out"
    make(out, {"a.json": "1", "b.json": "1", "gone.png": "1"})
    monkeypatch.setattr(output_folder, "_exchange", lambda one, other: False)
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
    monkeypatch.setattr(output_folder, "_exchange", lambda one, other: False)
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


def test_files_are_staged_beside_their_places_and_nothing_is_left(tmp_path):
    left = tmp_path / f".{tmp_path.name}{UNFINISHED}abcdefgh"
    left.mkdir()
    (left / "0").write_text("of a killed run")
    with staged(tmp_path) as stage:
        assert not left.exists()
        write_at_once(stage / "0", "new")
        os.replace(stage / "0", tmp_path / "a.txt")
        write_at_once(stage / "1", "not moved")
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]


def test_a_full_disk_under_a_file_inside_names_the_folder_that_was_asked_for(tmp_path, monkeypatch):
    """What is written beside it has a name that nobody knows, and is gone when the message is read."""

    def full(*_):
        raise OSError(28, "No space left on device")

    def work():
        with replaced_outputs(tmp_path / "data", "make-data") as new:
            monkeypatch.setattr(os, "fsync", full)
            write_at_once(new / "0.png", "x")

    with pytest.raises(WriteError) as told:
        work()
    assert str(told.value).startswith(f"{tmp_path / 'data'} cannot be written: the disk is full")
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_be_written_is_refused_before_the_work(tmp_path):
    require_writable(tmp_path / "new" / "deep")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").write_text("x")
    for folder in (tmp_path / "file", tmp_path / "file" / "deep", "/proc/nope") if os.path.isdir("/proc") else ():
        with pytest.raises(WriteError, match=re.escape(str(folder))):
            require_writable(folder)


@pytest.mark.parametrize("text", ["", "[", "[1]", '{"demo": 3}', '{"demo": [3]}', "\udc80"])
def test_a_damaged_list_of_outputs_costs_nothing(tmp_path, text):
    out = tmp_path / "out"
    make(out, {"a.json": "1"})
    (out / MADE).write_bytes(text.encode("utf-8", "surrogatepass"))
    make(out, {"b.json": "1"})
    assert names(out) == ["a.json", "b.json"]
