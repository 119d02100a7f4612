"""Progress, shown in words and as a page, and brought up to date by a check."""

import datetime
import re
from html.parser import HTMLParser

import pytest

from course_lib.cli import main
from course_lib.lessons.kit.exercises import check
from course_lib.lessons.kit.lesson_progress import Progress, Table, tables
from course_lib.lessons.kit.predictions import Predictions
from course_lib.lessons.kit.show_progress import as_page, as_text, update_page
from course_lib.lessons.kit.student_record import RECORD
from course_lib.paths import notebook_paths, project_paths
from tests.lessons.kit.test_lesson_progress import keep, record  # noqa: F401

NOW = datetime.datetime(2026, 11, 23, 9, 5)


def right_06_1(hidden, alpha):
    return (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)


def test_the_columns_of_the_text_stand_below_their_headings(record):  # noqa: F811
    lines = as_text(tables()[0]).splitlines()
    column = lines[0].index("checks right")
    assert all(re.match(r"checks right|\d+ of \d+", line[column:]) for line in lines)


class Headings(HTMLParser):
    """Scopes of the table headings, captions, and whatever would be fetched or run."""

    def __init__(self):
        super().__init__()
        self.scopes, self.captions, self.foreign = [], 0, []

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.captions += tag == "caption"
        if tag == "th":
            self.scopes.append(named.get("scope"))
        if tag in ("script", "img", "iframe") or named.get("src") or named.get("href", "data:,") != "data:,":
            self.foreign.append(tag)


def test_the_page_is_a_table_with_headings_that_needs_nothing_else(record):  # noqa: F811
    keep(record, "06", _1="r", _2="r")
    page = as_page(tables(), NOW)
    found = Headings()
    found.feed(page)
    assert (found.captions, found.foreign) == (2, [])
    rows = len(notebook_paths()) + len(project_paths()) + 2
    assert sorted(found.scopes) == ["col"] * (6 + 5) + ["row"] * rows
    assert '<td>2 of 4<span class="bar" aria-hidden="true"><span style="width: 50%">' in page
    for words in ('<html lang="en">', "prefers-color-scheme: dark", "2026-11-23 09:05", "<td>begun</td>"):
        assert words in page


def test_what_a_lesson_or_a_record_says_is_no_html():
    one = Progress("<script>06", 0, ("06.1",), right=("06.1",), attempted=("06.1",), said="<b>06.json</b>")
    page = as_page([Table("Lessons", ("lesson", "checks right", "attempted", "state", "not right yet"), (one,))], NOW)
    assert not re.search("<script>|<b>", page)
    assert "&lt;b&gt;06.json" in page
    assert '<tr class="done">' in page


def test_a_damaged_or_a_foreign_record_is_named_and_the_others_count(record, capfd):  # noqa: F811
    (record / "06.json").write_text("{")
    (record / "notes.txt").write_text("mine")
    (record / "99.json").write_text("no lesson of ours")
    (record / "08.unreadable-1.json").write_text("set aside earlier")
    keep(record, "07", _1="r")
    before = {path.name: path.read_text() for path in record.iterdir()}
    assert main(["progress"]) == 0
    printed, page = capfd.readouterr().out, (record.parent / "progress.html").read_text()
    assert re.search(r"07 · .* 1 of 4", printed)
    for told in (printed, page):
        assert re.search(r"06 · Likelihood and weights: .*06\.json is not a valid record of lesson 06", told)
        assert re.search(r"notes.txt belongs to no lesson of this course; it is not changed", told)
        assert "99.json belongs" in told
        assert "unreadable" not in told
    assert {path.name: path.read_text() for path in record.iterdir()} == before


def test_a_check_and_a_prediction_bring_the_page_up_to_date(record, capsys):  # noqa: F811
    page = record.parent / "progress.html"
    check("06.1", right_06_1)
    assert "<td>1 of 4<span" in page.read_text()
    page.unlink()
    Predictions("06", ("How many?",)).boxes[0].value = "ten"
    assert page.exists()


def test_a_page_that_cannot_be_written_disturbs_no_check(record, capsys):  # noqa: F811
    (record.parent / "progress.html").mkdir()
    check("06.1", right_06_1)
    assert capsys.readouterr().out == "06.1: right.\n"
    assert {path.name for path in record.parent.iterdir()} == {"progress.html", "record"}


def test_without_a_record_no_page_is_written(tmp_path, monkeypatch):
    monkeypatch.delenv(RECORD, raising=False)
    monkeypatch.chdir(tmp_path)
    update_page()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("folder", "code"), [(".", 0), ("nowhere", 2)])
def test_the_command_writes_the_page_where_it_is_wanted(record, tmp_path, capfd, folder, code):  # noqa: F811
    assert main(["progress", "--out", str(tmp_path / folder / "mine.html")]) == code
    assert (tmp_path / folder / "mine.html").exists() == (code == 0)
    assert not (record.parent / "progress.html").exists()
    assert ("No such file or directory" in capfd.readouterr().err) == (code == 2)
