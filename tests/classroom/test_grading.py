"""A whole folder graded: tables and page, whatever is in it; the same bytes again; nothing left behind."""

import csv
import io
import os
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path

import pytest

from course_lib.classroom import grading
from course_lib.classroom.confinement import Limits
from course_lib.classroom.grade_page import grade_page
from course_lib.classroom.grade_tables import answers_table, totals_table, written
from course_lib.classroom.grading import Results, grade_folder
from course_lib.classroom.judging import Graded, Task
from course_lib.classroom.probe import PROTECTIONS
from course_lib.classroom.sandbox import SandboxError
from course_lib.classroom.submissions import Collection, NotRead
from course_lib.commands import grade as command
from tests.classroom.handed_in import assignment_of, handed_in, mistaken, solved
from tests.classroom.walls import require_walls

SEED = 20_001
WILD = "=cmd|'calc', \"x\""


pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Seven students of lesson 06, and what else lies in such a folder."""
    folder = tmp_path_factory.mktemp("class") / "handed in"
    right = solved("06")
    handed_in(folder / "alice" / assignment_of("06").path.name, "06", right)
    handed_in(folder / "bob_06.ipynb", "06", {})
    handed_in(folder / f"{WILD}_06.ipynb", "06", {number: mistaken(number) for number in right})
    removes = "def raw_score(hidden, alpha):\n    import os\n    os.remove(__file__ if 0 else '/etc/hostname')\n"
    handed_in(folder / "mallory" / "06.ipynb", "06", right | {"06.1": removes})
    half = "def raw_score(hidden, alpha):\n    [1][len(hidden) % 2]\n"
    half += "    return (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)\n"
    handed_in(folder / "nina_06.ipynb", "06", {"06.1": half, "06.2": "def weigh_rightly(:"})
    (folder / "oscar_06.py").write_text("\n".join(["import numpy as np", *right.values()]), encoding="utf-8")
    (folder / "peggy_06.ipynb").write_text('{"cells": [', encoding="utf-8")
    (folder / "class.zip").write_bytes(b"PK")
    os.symlink("/etc/passwd", folder / "victor_06.ipynb")
    return folder


@pytest.fixture(scope="module")
def results(folder, tmp_path_factory):
    require_walls(tmp_path_factory.mktemp("walls"))
    return grade_folder(folder, SEED, jobs=2)


def of(results: Results, student: str) -> dict[str, Graded]:
    return {one.number: one for one in results.graded if one.student == student}


def rows(text: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text)))


def test_the_solved_notebook_earns_all_points_and_so_does_a_python_file(results):
    for student in ("alice", "oscar"):
        found = of(results, student)
        assert [one.points for one in found.values()] == [2, 4, 4, 6], found
        assert not any(one.refused for one in found.values())


def test_the_untouched_notebook_earns_nothing_and_is_called_not_attempted(results):
    found = of(results, "bob").values()
    assert {(one.status, one.points) for one in found} == {("not attempted", 0)}


def test_a_typical_mistake_gets_its_own_hint(results):
    from course_lib.lessons.kit.exercises import find_exercise

    for number, one in of(results, WILD).items():
        assert one.sentence in [mistake.hint for mistake in find_exercise(number).known]
        assert one.status in ("wrong", "partly right")


def test_what_was_refused_is_said_and_the_other_answers_count(results):
    found = of(results, "mallory")
    assert found["06.1"].refused == ("remove /etc/hostname",)
    assert found["06.1"].points == 0
    assert [found[number].points for number in ("06.2", "06.3", "06.4")] == [4, 4, 6]


def test_a_cell_that_cannot_be_read_is_said(results):
    one = of(results, "nina")["06.2"]
    assert one.points == 0
    assert "SyntaxError" in one.problems[0]


def test_a_damaged_file_is_said_for_every_exercise(results):
    found = of(results, "peggy").values()
    assert {one.status for one in found} == {"not read"}
    assert len(found) == 4
    assert all("damaged" in one.sentence for one in found)


def test_the_table_has_a_row_for_each_student_and_exercise_and_no_formula(results):
    header, *body = rows(answers_table(results))
    assert header[:6] == ["student", "lesson", "exercise", "status", "points", "of"]
    assert len(body) == 7 * 4
    assert {row[0] for row in body} >= {"alice", "'" + WILD}
    assert not any(cell.startswith(("=", "+", "-", "@")) for row in body for cell in row)


def test_the_totals_add_up(results):
    header, *body = rows(totals_table(results))
    assert header == ["student", "06 (of 16)", "sum (of 16)"]
    totals = {row[0]: row[1:] for row in body}
    assert totals["alice"] == ["16", "16"]
    assert totals["mallory"] == ["14", "14"]
    assert totals["bob"] == ["0", "0"]
    assert totals["victor"] == ["", "0"]


class Page(HTMLParser):
    """Tags, their attributes, and texts of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags, self.text, self.open = [], "", []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag not in ("meta", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def test_the_page_stands_alone_and_says_all_of_it(results):
    text = grade_page(results)
    page = Page(text)
    assert not page.open
    tags = [tag for tag, _ in page.tags]
    assert not {"script", "img", "link", "iframe", "object", "form"} & set(tags)
    assert "http" not in text.replace("http-equiv", "")
    for words in ("alice", WILD, "Tried to remove /etc/hostname: refused.", "links are not followed", "unpack it"):
        assert words in page.text
    assert all(words in page.text for words in PROTECTIONS)
    assert f"Seed of the inputs: {SEED}" in page.text


def test_the_page_is_accessible_by_its_structure(results):
    page = Page(grade_page(results))
    tags = [tag for tag, _ in page.tags]
    assert dict(page.tags)["html"] == {"lang": "en"}
    assert tags.count("h1") == tags.count("main") == tags.count("title") == 1
    assert tags.count("table") == tags.count("caption") > 3
    assert all("scope" in attributes for tag, attributes in page.tags if tag == "th")
    ids = [attributes["id"] for _, attributes in page.tags if "id" in attributes]
    assert len(ids) == len(set(ids))
    linked = {attributes["href"].removeprefix("#") for tag, attributes in page.tags if tag == "a"}
    named = {attributes["aria-labelledby"] for _, attributes in page.tags if "aria-labelledby" in attributes}
    assert linked | named <= set(ids)


def test_the_same_folder_and_seed_give_the_same_bytes_with_any_number_of_jobs(results, folder):
    again = grade_folder(folder, SEED, jobs=1)
    for table in (answers_table, totals_table, grade_page):
        assert table(again) == table(results)


def test_nothing_is_run_on_a_machine_without_walls_unless_trusted(folder, monkeypatch):
    monkeypatch.setattr(grading, "missing_protections", lambda *given: ("there is no network",))
    monkeypatch.setattr(grading, "_graded", lambda *given: iter(()))
    with pytest.raises(SandboxError, match=r"nothing was run.*there is no network.*--trusted"):
        grade_folder(folder, SEED)
    found = grade_folder(folder, SEED, trusted=True)
    assert found.missing == ("there is no network",)
    assert "graded all the same (--trusted)" in grade_page(found)


# Workers that hang or die: what a value can do to the comparison


@pytest.fixture
def worker(tmp_path):
    worker = grading._Worker(tmp_path / "worker", SEED, Limits(), False)
    yield worker
    worker.end()


def test_a_comparison_that_hangs_or_ends_the_worker_costs_this_answer_alone(worker, folder):
    task = Task("alice", "06", folder / "alice" / assignment_of("06").path.name, "06.1", "raw_score")
    worker.give(task)
    worker._deadline = 0.0
    late = worker.result(is_ready=False)
    assert (late.status, late.points) == ("wrong", 0)
    assert "comparing this answer took too long" in late.sentence
    worker.give(task)
    worker._process.kill()
    worker._process.join()
    ended = worker.result(is_ready=worker.connection.poll(60))
    assert "ended while it looked at this answer" in ended.sentence
    worker.give(task)
    assert worker.connection.poll(600)
    assert worker.result(is_ready=True).status == "right"


# The command


def test_ctrl_c_leaves_no_process_and_no_folder_behind(tmp_path, folder):
    class_, scratch = tmp_path / "class", tmp_path / "scratch"
    scratch.mkdir()
    handed_in(class_ / "eve_06.ipynb", "06", {"06.1": "def raw_score(hidden, alpha):\n    while True: pass\n"})
    words = [sys.executable, "-P", "-m", "course_lib", "grade", str(class_), "--jobs", "1", "--call-seconds", "600"]
    environment = os.environ | {"TMPDIR": str(scratch)}
    with subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        waited = time.monotonic() + 600
        while not list(scratch.glob("*/worker-*/answer")):
            assert process.poll() is None
            assert time.monotonic() < waited
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=600)[0].decode()
    assert process.returncode == 130, said
    assert said.endswith("Stopped.\n")
    assert not list(scratch.iterdir())
    assert not [one for one in Path("/proc").glob("[0-9]*/cwd") if stands_in(one, scratch)]
    assert not (tmp_path / "class-grades").exists()


def stands_in(link: Path, folder: Path) -> bool:
    try:
        return os.readlink(link).startswith(str(folder))
    except OSError:
        return False


def test_results_never_lie_among_the_submissions(tmp_path):
    with pytest.raises(ValueError, match="among the submissions"):
        command.results_folder(tmp_path, tmp_path / "out")
    assert command.results_folder(tmp_path / "class", None) == tmp_path / "class-grades"


@pytest.mark.parametrize("cell", ["=1+1", "+1", "-1", "@x", "\t=1", " =1", "\r=1"])
def test_a_cell_that_would_be_a_formula_is_a_text(cell):
    assert rows(written([[cell, "a=1", -1]]))[0] == ["'" + cell, "a=1", "-1"]


def test_a_strangers_words_are_never_markup():
    bad = "<script>alert(1)</script>\" onload='x'"
    one = Graded(bad, "06", "06.1", "wrong", 0, 2, 0, 1, bad, (bad,), (bad,), bad)
    results = Results(Collection((), (NotRead(bad, bad, bad),)), (assignment_of("06"),), (one,), 1)
    page = Page(grade_page(results))
    assert "script" not in [tag for tag, _ in page.tags]
    assert not any("onload" in attributes for _, attributes in page.tags)
    assert page.text.count(bad) >= 6
