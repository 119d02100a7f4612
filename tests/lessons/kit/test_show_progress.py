"""Progress, shown in words and as a page, and brought up to date by a check."""

import datetime
import re

import pytest

from courseware.cli import main
from courseware.lessons.kit.exercises import check
from courseware.lessons.kit.lesson_progress import Progress, Table, tables
from courseware.lessons.kit.predictions import Predictions
from courseware.lessons.kit.show_progress import as_page, as_text, update_page
from courseware.lessons.kit.student_record import RECORD
from courseware.paths import numbered_paths
from tests.lessons.kit.conftest import right_06_1

NOW = datetime.datetime(2026, 11, 23, 9, 5)


def test_the_columns_of_the_text_stand_below_their_headings(record):
    lines = as_text(tables()[0]).splitlines()
    column = lines[0].index("checks right")
    assert all(re.match(r"checks right|\d+ of \d+", line[column:]) for line in lines)


def test_the_page_is_a_table_with_headings_that_needs_nothing_else(keep):
    keep("06", "rr")
    page = as_page(tables(), NOW)
    assert page.count("<caption>") == 3
    assert page.count('<th scope="col">') == 6 + 6 + 5
    assert page.count('<th scope="row">') == len(numbered_paths()) + 3
    assert not re.search(r'<th>|<script|<img|<iframe|src=|href="(?!data:,")', page)
    assert '<td>2 of 4<span class="bar" aria-hidden="true"><span style="width: 50%">' in page
    for words in ('<html lang="en">', "prefers-color-scheme: dark", "2026-11-23 09:05", "<td>begun</td>"):
        assert words in page


def test_what_a_lesson_or_a_record_says_is_no_html():
    one = Progress("<script>06", 0, ("06.1",), right=("06.1",), attempted=("06.1",), said="<b>06.json</b>")
    page = as_page([Table("Lessons", ("lesson", "checks right", "attempted", "state", "not right yet"), (one,))], NOW)
    assert not re.search("<script>|<b>", page)
    assert "&lt;b&gt;06.json" in page
    assert '<tr class="done">' in page


def test_a_damaged_or_a_foreign_record_is_named_and_the_others_count(record, keep, capfd):
    for name in ("06.json", "notes.txt", "99.json", "08.unreadable-1.json"):
        (record / name).write_text("{")
    keep("07", "r")
    before = {path.name: path.read_text() for path in record.iterdir()}
    assert main(["progress"]) == 0
    printed, page = capfd.readouterr().out, (record.parent / "progress.html").read_text()
    assert re.search(r"07 · .* 1 of 4", printed)
    for told in (printed, page):
        assert re.search(r"06 · Likelihood and weights: .*06\.json is not a valid record of lesson 06", told)
        assert (
            len(re.findall(r"(?:notes.txt|99.json) belongs to no lesson of this course; it is not changed", told)) == 2
        )
        assert "unreadable" not in told
    assert {path.name: path.read_text() for path in record.iterdir()} == before


def test_a_check_and_a_prediction_bring_the_page_up_to_date_or_go_on_without_it(record, capsys):
    page = record.parent / "progress.html"
    check("06.1", right_06_1)
    assert "<td>1 of 4<span" in page.read_text()
    page.unlink()
    Predictions("06", ("How many?",)).boxes[0].value = "ten"
    page.unlink()
    page.mkdir()  # so that it cannot be written
    check("06.1", right_06_1)
    assert capsys.readouterr().out == "06.1: right. (try 1)\n06.1: right. (try 2)\n"
    assert {path.name for path in record.parent.iterdir()} == {"progress.html", "record"}


def test_without_a_record_no_page_is_written(tmp_path, monkeypatch, capfd):
    monkeypatch.delenv(RECORD, raising=False)
    monkeypatch.chdir(tmp_path)
    update_page()
    monkeypatch.setenv(RECORD, str(tmp_path / "work" / "record"))
    assert main(["progress"]) == 0
    assert "There is no folder work/ yet" in capfd.readouterr().out
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("folder", "code"), [(".", 0), ("nowhere", 2)])
def test_the_command_writes_the_page_where_it_is_wanted(record, tmp_path, capfd, folder, code):
    assert main(["progress", "--out", str(tmp_path / folder / "mine.html")]) == code
    assert (tmp_path / folder / "mine.html").exists() == (code == 0)
    assert not (record.parent / "progress.html").exists()
    assert ("No such file or directory" in capfd.readouterr().err) == (code == 2)
