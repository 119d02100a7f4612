"""A file is written or replaced as a whole, and what goes wrong says where and why."""

import os

import pytest

from course_lib import unfinished
from course_lib.writing import WriteError, write_at_once
from tests.made_outputs import names


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


@pytest.mark.parametrize("locks", [True, False])
def test_an_interrupted_write_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch, locks):
    if not locks:  # as on Windows, where nobody clears what another one may be writing
        monkeypatch.setattr(unfinished, "fcntl", None)
    write_at_once(tmp_path / "a.txt", "old")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_at_once(tmp_path / "a.txt", "new")
    assert (tmp_path / "a.txt").read_text() == "old"
    assert names(tmp_path) == ["a.txt"]
