"""Progress: counted from the lessons and the records, shown in words and as a page, brought up to date by a check."""

import datetime
import json
import os
import re
from html.parser import HTMLParser
from pathlib import Path

import nbformat
import pytest

from course_lib.cli import main
from course_lib.lessons.kit import lesson_progress
from course_lib.lessons.kit.exercises import check, lesson_exercises
from course_lib.lessons.kit.lesson_progress import Contents, Progress, Table, contents, tables
from course_lib.lessons.kit.predictions import Predictions
from course_lib.lessons.kit.progress_page import as_page, update_page
from course_lib.lessons.kit.student_record import RECORD
from course_lib.paths import notebook_paths, project_paths

NOW = datetime.datetime(2026, 11, 23, 9, 5)


@pytest.fixture
def record(tmp_path, monkeypatch):
    folder = tmp_path / "work" / "record"
    folder.mkdir(parents=True)
    monkeypatch.setenv(RECORD, str(folder))
    return folder


def keep(record, lesson, predictions=(), **checks):
    """A record file: predictions typed, and exercises with their status (r for right, w for wrong, n for none)."""
    words = {"r": "right", "w": "wrong", "n": "not attempted"}
    content = {
        "predictions": {str(n): text for n, text in enumerate(predictions, start=1)},
        "checks": {f"{lesson}.{n[1:]}": {"status": words[s], "attempts": 1} for n, s in checks.items()},
    }
    (record / f"{lesson}.json").write_text(json.dumps(content))


def row(title):
    table = next(table for table in tables() if any(one.contents.title.startswith(title) for one in table.parts))
    one = next(one for one in table.parts if one.contents.title.startswith(title))
    return dict(zip(table.headings, table.cells(one), strict=True))


@pytest.mark.parametrize("path", [*notebook_paths(), *project_paths()], ids=lambda path: path.name[:2])
def test_the_exercises_counted_are_those_that_the_lesson_checks(path):
    number = path.name[:2]
    assert contents(path).exercises == tuple(exercise.number for exercise in lesson_exercises(number))
    assert contents(path).title.startswith(f"{number} · ")


def test_predictions_are_counted_where_the_lesson_asks_them(tmp_path):
    cells = [
        nbformat.v4.new_markdown_cell("# 06 · A title: and what it promises\n\npredict(1, 2)"),
        nbformat.v4.new_code_cell('predict("06", "How many?",\n        "How far?", "How long?")'),
        nbformat.v4.new_code_cell("state, P = filter.predict(x, P); famous = update(*predict(*famous, u=0.3), z)"),
        nbformat.v4.new_code_cell("predict(states, sigma, rng)  # a function of the student's"),
    ]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), tmp_path / "06_x.ipynb")
    assert contents(tmp_path / "06_x.ipynb") == Contents("06 · A title", 3, ())


def test_a_lesson_that_was_written_anew_is_counted_anew(tmp_path):
    path = tmp_path / "06_x.ipynb"
    for n in (1, 2):
        questions = '"Why?", ' * n
        asks = nbformat.v4.new_code_cell(f'predict("06", {questions})')
        nbformat.write(nbformat.v4.new_notebook(cells=[nbformat.v4.new_markdown_cell("# 06 · A title"), asks]), path)
        os.utime(path, ns=(n, n))
        assert contents(path).predictions == n


def test_a_lesson_with_a_merges_marks_has_a_row_of_its_own(tmp_path):
    path = tmp_path / "06_x.ipynb"
    path.write_text("<<<<<<< HEAD")
    assert contents(path) == Contents("06 (its notebook cannot be read)", 0, ())


def test_a_row_says_what_was_typed_tried_and_right(record, monkeypatch):
    asked = Contents("06 · Likelihood", 2, ("06.1", "06.2", "06.3", "06.4"))
    monkeypatch.setattr(lesson_progress, "contents", lambda path: asked)
    keep(record, "06", ["ten", " "])
    assert lesson_progress.progress_in([Path("06_x.ipynb")])[0].typed == 1, "a blank is no prediction"
    keep(record, "06", ["ten", "far", "a third that is asked no more"], _1="r", _2="w", _3="n", _9="r")
    (one,) = lesson_progress.progress_in([Path("06_x.ipynb")])
    assert one == Progress(asked, typed=2, right=("06.1",), attempted=("06.1", "06.2"))
    assert one.state == "begun"
    assert one.not_yet_right == ("06.2",)
    keep(record, "06", ["ten", "far"], _1="r", _2="r", _3="r", _4="r")
    assert lesson_progress.progress_in([Path("06_x.ipynb")])[0].state == "done"
    keep(record, "06", ["ten"], _1="r", _2="r", _3="r", _4="r")
    assert lesson_progress.progress_in([Path("06_x.ipynb")])[0].state == "begun", "a prediction is missing"
    keep(record, "06", _1="n")
    assert lesson_progress.progress_in([Path("06_x.ipynb")])[0].state == "not begun"


def test_the_rows_add_up(record):
    keep(record, "06", _1="r", _2="w")
    keep(record, "07", _1="r")
    keep(record, "P1", _1="r")
    lessons, projects = tables()
    total = sum(len(lesson_exercises(path.name[:2])) for path in notebook_paths())
    assert lessons.sums()[:3] == ("together", f"2 of {total}", f"3 of {total}")
    assert projects.sums()[1].startswith("1 of ")
    assert row("06")["checks right"] == "1 of 4"
    assert row("06")["not right yet"] == "06.2"
    assert row("P1")["stages right"] == "1 of 7"
    assert row("P2")["state"] == "not begun"
    column = lessons.as_text().splitlines()[0].index("checks right")
    assert all(re.match(r"checks right|\d+ of \d+", line[column:]) for line in lessons.as_text().splitlines())


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


def test_the_page_is_a_table_with_headings_that_needs_nothing_else(record):
    keep(record, "06", _1="r")
    page = as_page(tables(), [], NOW)
    found = Headings()
    found.feed(page)
    assert found.captions == 2
    assert found.scopes.count("col") == 6 + 5
    assert found.scopes.count("row") == len(notebook_paths()) + len(project_paths()) + 2
    assert None not in found.scopes
    assert found.foreign == []
    assert '<html lang="en">' in page
    assert "prefers-color-scheme: dark" in page
    assert "2026-11-23 09:05" in page
    assert "begun" in page, "the state is a word"


def test_what_a_lesson_or_a_record_says_is_no_html(record):
    one = Progress(Contents("<script>06", 1, ("06.1",)), said="<b>06.json</b>")
    page = as_page(
        [Table("Lessons", ("lesson", "checks right", "attempted", "state", "not right yet"), (one,))], ["<b>99"], NOW
    )
    assert "<script>" not in page
    assert "<b>" not in page
    assert "&lt;b&gt;06.json" in page


def test_a_damaged_or_a_foreign_record_is_named_and_the_others_count(record, capfd):
    (record / "06.json").write_text("{")
    (record / "notes.txt").write_text("mine")
    (record / "99.json").write_text("no lesson of ours")
    (record / "08.unreadable-1.json").write_text("set aside earlier")
    keep(record, "07", _1="r")
    before = {path.name: path.read_text() for path in record.iterdir()}
    assert main(["progress"]) == 0
    printed = capfd.readouterr().out
    assert re.search(r"06 · Likelihood and weights: .*06\.json is not a valid record of lesson 06", printed)
    assert re.search(r"07 · .* 1 of 4", printed)
    for name in ("notes.txt", "99.json"):
        assert re.search(rf"{name} belongs to no lesson of this course; it is not changed", printed)
        assert name in (record.parent / "progress.html").read_text()
    assert "unreadable" not in printed
    assert "06.json is not a valid record of lesson 06" in (record.parent / "progress.html").read_text()
    assert {path.name: path.read_text() for path in record.iterdir()} == before


def test_a_check_and_a_prediction_bring_the_page_up_to_date(record, capsys):
    page = record.parent / "progress.html"
    check("06.1", lambda hidden, alpha: (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2))
    assert "<td>1 of 4<span" in page.read_text()
    page.unlink()
    Predictions("06", ("How many?",)).boxes[0].value = "ten"
    assert page.exists()


def test_a_page_that_cannot_be_written_disturbs_no_check(record, capsys):
    (record.parent / "progress.html").mkdir()
    check("06.1", lambda hidden, alpha: (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2))
    assert capsys.readouterr().out == "06.1: right.\n"
    assert [path.name for path in record.parent.iterdir() if path.suffix == ".part"] == []


def test_without_a_record_no_page_is_written(tmp_path, monkeypatch):
    monkeypatch.delenv(RECORD, raising=False)
    monkeypatch.chdir(tmp_path)
    update_page()
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_the_page_where_it_is_wanted(record, tmp_path, capfd):
    assert main(["progress", "--out", str(tmp_path / "mine.html")]) == 0
    assert "Your progress" in (tmp_path / "mine.html").read_text()
    assert not (record.parent / "progress.html").exists()
    assert main(["progress", "--out", str(tmp_path / "nowhere" / "mine.html")]) == 2
    assert "No such file or directory" in capfd.readouterr().err
