"""Whose a file is and which lesson's, and what is not read and why."""

import json
import os
from pathlib import Path

import pytest

from course_lib.classroom import submissions
from course_lib.classroom.submissions import SubmissionError, collect, read_cells, whose

TITLES = ["06_likelihood_and_weights", "12_detecting_objects", "P1_the_whole_filter"]


@pytest.mark.parametrize(
    ("path", "student", "lesson"),
    [
        ("alice/06_likelihood_and_weights.ipynb", "alice", "06"),
        ("alice/06/anything.ipynb", "alice", "06"),
        ("alice/06_likelihood_and_weights-copy.ipynb", "alice", "06"),
        ("alice/projects/P1_the_whole_filter.ipynb", "alice", "P1"),
        ("alice_06.ipynb", "alice", "06"),
        ("alice_P1.py", "alice", "P1"),
        ("bob_p1.py", "bob", "P1"),
        ("06_alice.ipynb", "alice", "06"),
        ("12_06.ipynb", "12", "06"),
        ("alice 06_likelihood_and_weights.ipynb", "alice", "06"),
        ("06_likelihood_and_weights.ipynb", "", "06"),
        ("notes.ipynb", "", ""),
        ("alice/06/12_detecting_objects.ipynb", "alice", "12"),
        ("20061206/homework_06.ipynb", "20061206", "06"),
    ],
)
def test_student_and_lesson_are_told_by_place_and_name(path, student, lesson):
    assert whose(Path(path), TITLES) == (student, lesson)


def handed_in(path: Path, text: str = "x = 1\n") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def test_every_file_is_graded_or_named_with_a_reason(tmp_path):
    folder = tmp_path / "handed in"
    handed_in(folder / "alice" / "06_likelihood_and_weights.ipynb")
    handed_in(folder / "bob_06.py")
    handed_in(folder / "class.zip")
    handed_in(folder / "carol" / "report_06.pdf")
    handed_in(folder / "carol" / "thoughts.ipynb")
    handed_in(folder / ".ipynb_checkpoints" / "alice_06.ipynb")
    handed_in(tmp_path / "secret_06.ipynb")
    os.symlink(tmp_path / "secret_06.ipynb", folder / "dan_06.ipynb")
    os.symlink(tmp_path, folder / "erin")
    os.mkfifo(folder / "frank_06.ipynb")
    found = collect(folder, TITLES)
    assert [(one.student, one.lesson) for one in found.submissions] == [("alice", "06"), ("bob", "06")]
    whys = {one.name: one.why for one in found.not_read}
    assert "unpack it" in whys["class.zip"]
    assert "neither a notebook" in whys["carol/report_06.pdf"]
    assert "does not say which lesson" in whys["carol/thoughts.ipynb"]
    assert "link" in whys["dan_06.ipynb"]
    assert "link" in whys["erin"]
    assert "no plain file" in whys["frank_06.ipynb"]
    assert len(whys) == 6


def test_of_two_files_of_a_student_the_newer_counts_and_the_older_is_named(tmp_path):
    old, new = handed_in(tmp_path / "alice" / "06.ipynb"), handed_in(tmp_path / "alice" / "06_b.ipynb")
    os.utime(old, (1000, 1000))
    os.utime(new, (2000, 2000))
    found = collect(tmp_path, TITLES)
    assert [one.path for one in found.submissions] == [new]
    assert [(one.name, one.why) for one in found.not_read] == [
        ("alice/06.ipynb", "older than alice/06_b.ipynb, which counts")
    ]
    os.utime(old, (3000, 3000))
    assert [one.path for one in collect(tmp_path, TITLES).submissions] == [old]


def test_a_name_that_is_no_utf_8_is_shown_and_read(tmp_path):
    path = os.fsencode(tmp_path) + b"/ali\xff\x0ace_06.py"
    with open(path, "wb") as file:
        file.write(b"x = 1\n")
    (one,) = collect(tmp_path, TITLES).submissions
    assert one.student == "ali\ufffd\ufffdce"
    assert one.student.encode("utf-8")
    assert read_cells(one.path) == [("the file", "x = 1\n")]


def test_what_is_no_folder_is_named(tmp_path):
    with pytest.raises(SubmissionError, match="is no folder"):
        collect(tmp_path / "nowhere", TITLES)


def test_an_empty_folder_is_named_and_no_empty_table_made_of_it(tmp_path):
    with pytest.raises(SubmissionError, match="is empty: name the folder that holds what the students handed in"):
        collect(tmp_path, TITLES)


def test_cells_are_read_without_running_or_trusting_anything(tmp_path):
    cells = [
        {"cell_type": "markdown", "source": "# x"},
        {"cell_type": "code", "source": ["a = 1\n", "b = 2"]},
        {"cell_type": "code", "source": 7},
        {"cell_type": "code"},
        "no cell",
        {"cell_type": "code", "source": "c = 3"},
    ]
    path = handed_in(tmp_path / "06.ipynb", json.dumps({"cells": cells}))
    assert read_cells(path) == [("cell 2", "a = 1\nb = 2"), ("cell 4", ""), ("cell 6", "c = 3")]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b'{"cells": [', "damaged"),
        (b"", "damaged"),
        (b"[" * 200_000, "damaged"),
        (b"\xff\xfe\x00", "UTF-8"),
        (b"[]", "today's format"),
        (b'{"worksheets": []}', "today's format"),
        (b'{"cells": {"a": 1}}', "today's format"),
    ],
)
def test_a_file_that_is_no_notebook_is_named(tmp_path, content, words):
    path = tmp_path / "06.ipynb"
    path.write_bytes(content)
    with pytest.raises(SubmissionError, match=words):
        read_cells(path)


def test_a_huge_file_is_named_before_it_is_read(tmp_path, monkeypatch):
    monkeypatch.setattr(submissions, "LARGEST_FILE_MB", 1)
    path = tmp_path / "alice_06.ipynb"
    with open(path, "wb") as file:
        file.truncate((1 << 20) + 1)
    assert collect(tmp_path, TITLES).not_read[0].why == "has more than 1 MB"
    with pytest.raises(SubmissionError, match="more than 1 MB"):
        read_cells(path)
    monkeypatch.setattr(submissions, "LARGEST_CODE", 10)
    with pytest.raises(SubmissionError, match="characters of code"):
        read_cells(
            handed_in(tmp_path / "b_06.ipynb", json.dumps({"cells": [{"cell_type": "code", "source": "x" * 11}]}))
        )


def test_a_link_that_comes_after_the_look_is_not_followed(tmp_path):
    secret = handed_in(tmp_path / "secret.py")
    os.symlink(secret, tmp_path / "alice_06.py")
    with pytest.raises(SubmissionError, match="cannot be opened"):
        read_cells(tmp_path / "alice_06.py")


@pytest.mark.parametrize("data", [b"\xff", b"{", b"[]", b"[" * 100_000])
def test_a_file_that_cannot_be_read_is_named(tmp_path, data):
    path = tmp_path / "alice_06.ipynb"
    path.write_bytes(data)
    with pytest.raises(SubmissionError, match=r"^alice_06\.ipynb is "):
        read_cells(path)
