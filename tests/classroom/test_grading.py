"""A folder's grading: each result written at once, what was judged is not judged again, the class at a glance."""

import csv
import io
import json
import os
import sys
from pathlib import Path

import pytest

from courseware.classroom import grading
from courseware.classroom.grading import grade_folder
from courseware.classroom.handout import canary_of
from courseware.classroom.judge import Graded, Judged
from courseware.classroom.pages import feedback_name, write_results
from courseware.classroom.results import Entry, table_text, what_counts
from courseware.classroom.sandbox import Limits, SandboxError
from courseware.classroom.submissions import Submission, read_roster
from courseware.cli import main
from tests.classroom.handed_in import handed_in, mistaken, solved
from tests.notebooks.driven_lab import require_chromium, serious_findings

SEED = 5_000_017
LESSONS = ["06", "P1"]
SPY = """import pickle, sys
def spied():
    frame = sys._getframe()
    while type(frame.f_locals.get("arguments")) is not bytes:
        frame = frame.f_back
    raise ValueError(f"the inputs are {pickle.loads(frame.f_locals['arguments'])}")
found = spied()
def weigh_rightly(*given):
    return found
"""


@pytest.fixture(scope="module")
def graded(library, tmp_path_factory):
    """Grade a class of two lessons, with copies, versions, damaged files, a spy and somebody missing."""
    folder = tmp_path_factory.mktemp("class")
    out = folder.with_name("class-grades")
    answers = solved("06")
    handed_in(folder / "alice" / "homework.ipynb", "06", answers)
    handed_in(folder / "alice" / "P1.ipynb", "P1", {})
    handed_in(folder / "bob_06_v1.ipynb", "06", {})
    os.utime(folder / "bob_06_v1.ipynb", (1, 1))
    wrong = {"06.1": f"# {canary_of(3)}\n{mistaken('06.1')}", "06.2": SPY}
    handed_in(folder / "bob_06_v2.ipynb", "06", answers | wrong)
    (folder / "dora_06.ipynb").write_text("{", encoding="utf-8")
    roster = folder.with_name("class.csv")
    roster.write_text("name,id\nalice,7\nbob,8\ncarol,9\n", encoding="utf-8")
    results = grade_folder(folder, out, SEED, Limits(), jobs=2, roster=read_roster(roster), lessons=LESSONS)
    write_results(results, out)
    return results, folder, out


def table(path):
    return list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8-sig"))))


def test_totals_have_everybody_in_the_class_with_the_columns_of_the_list(graded):
    results, _, out = graded
    rows = table(out / "totals.csv")
    assert [(row["student"], row["id"], row["06 (of 16)"], row["handed in"]) for row in rows] == [
        ("alice", "7", "16", "yes"), ("bob", "8", "10", "yes"), ("carol", "9", "", "no"), ("dora", "", "", "no"),
    ]  # fmt: skip
    assert (out / "totals.csv").read_bytes().startswith(b"\xef\xbb\xbf")
    assert results.most("P1") == 28 + 10
    assert {row["tries"] for row in table(out / "answers.csv")} == {""}


def test_the_newest_version_counts_and_what_is_not_read_is_named(graded):
    why = {one.name: one.why for one in graded[0].not_read}
    assert why["bob_06_v1.ipynb"] == "is older than bob_06_v2.ipynb, which counts for 06"
    assert "not a notebook" in why["dora_06.ipynb"]


def test_the_class_exercise_by_exercise_with_the_commonest_hint(graded):
    row = next(row for row in graded[0].per_exercise() if row["number"] == "06.1")
    assert (row["statuses"]["right"], row["statuses"]["wrong"], row["most"]) == (1, 1, 2)
    assert row["hint"][1] == 1


def test_equal_answers_and_the_teachers_words_are_named_without_accusation(graded):
    results, _, out = graded
    assert ("06.3", ["alice", "bob"]) in results.same_shape()
    assert [one.student for one in results.entries if one.canary] == ["bob"]
    assert "no accusation" in (out / "grades.html").read_text(encoding="utf-8")


def test_a_students_page_holds_no_input_and_nothing_of_the_others(graded):
    page = (graded[2] / "feedback" / "bob.html").read_text(encoding="utf-8")
    assert "10</strong> of 16" in page
    for words in ("alice", str(graded[0].seed), "inputs right"):
        assert words not in page


def test_what_a_stopping_statement_says_of_the_inputs_reaches_the_teacher_alone(graded):
    pages = [(graded[2] / name).read_text(encoding="utf-8") for name in ("grades.html", "feedback/bob.html")]
    assert "line 7 stops with ValueError in its line 1: the inputs are [(" in pages[0]
    assert "line 7 stops with ValueError in its line 1: the inputs are []" in pages[1]
    assert pages[1].count("the inputs are") == 1


@pytest.mark.parametrize(("handed_in", "asked", "lessons"), [
    ({"alice": ["06"], "bob": ["06", "13"]}, [], ["06"]),
    ({"alice": ["06"], "bob": ["06", "13"]}, ["06", "13"], ["06", "13"]),
    ({"alice": ["06"], "bob": ["13"]}, [], ["06", "13"]),
    ({"alice": ["06", "07"]}, ["07", "08"], ["07"]),
])  # fmt: skip
def test_lessons_that_nobody_set_have_no_column(handed_in, asked, lessons):
    judged = [
        Entry(Submission(who, Path(who)), Judged(names, [Graded(f"{name}.1", "right", 2, "Right.") for name in names]))
        for who, names in handed_in.items()
    ]
    entries, not_read = what_counts(judged, asked)
    assert sorted({name for one in entries for name in one.judged.lessons}) == lessons
    assert {a.number[:2] for one in entries for a in one.judged.answers} == set(lessons)
    held = {name for names in handed_in.values() for name in names}
    assert all(any(name in one.why for one in not_read) for name in held - set(lessons))
    assert [one.name for one in not_read if not one.student] == [f"lesson {one}" for one in asked if one not in held]


def test_a_file_that_takes_too_long_is_not_tried_again_and_its_student_waits(library, tmp_path, monkeypatch):
    for name in ("a", "b"):
        handed_in(tmp_path / "in" / "eve" / f"{name}.ipynb", "06", {"06.1": f"# {name}"})
    for name in ("FILE_SECONDS", "FILE_ANSWERS", "STUDENT_FILES"):
        monkeypatch.setattr(grading, name, 0)
    said = [{one.name: one.why for one in grade_folder(tmp_path / "in", tmp_path, SEED, Limits()).not_read}
            for _ in range(2)]  # fmt: skip
    assert ["kept in judged/" in why for why in said[0].values()] == [True, False]
    assert "was not judged yet" in said[0]["b.ipynb"]
    assert said[1]["a.ipynb"] == said[0]["a.ipynb"]
    assert "kept in judged/" in said[1]["b.ipynb"]


@pytest.mark.parametrize("place", ["/usr/share/course", "/lib/x", sys.prefix, "."])
def test_no_results_lie_among_the_submissions_or_where_every_submission_can_read_them(place, tmp_path, capsys):
    out = tmp_path / place / "new-grades"
    assert main(["grade", str(tmp_path), "--out", str(out)]) == 2
    why = "lies among the submissions" if place == "." else "which students' code can read"
    assert why in capsys.readouterr().err
    assert not out.exists()


def test_the_pages_have_no_serious_finding_in_light_and_in_dark(graded, browser):
    for colours in ("light", "dark"):
        page = browser.new_page(color_scheme=colours, bypass_csp=True)
        for name in ("grades.html", "feedback/bob.html"):
            page.goto((graded[2] / name).as_uri())
            assert serious_findings(page, "main") == []


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=require_chromium(), args=["--no-sandbox"])
        yield browser
        browser.close()


def test_points_by_hand_are_asked_for_and_added(graded, library):
    _, folder, out = graded
    rows = (out / "by_hand.csv").read_text(encoding="utf-8-sig")
    assert rows.splitlines()[1] == '"alice","P1","",""'
    (out / "by_hand.csv").write_text("student;project;points;remark\nalice;P1;7,5;good\n", encoding="utf-8")
    again = grade_folder(folder, out, SEED, Limits(), lessons=LESSONS)
    assert again.points("alice", "P1") == 7.5
    (out / "by_hand.csv").write_text(rows.replace('"",""', '"99",""'), encoding="utf-8")
    with pytest.raises(ValueError, match="from 0 to 10"):
        grade_folder(folder, out, SEED, Limits(), lessons=LESSONS)
    (out / "by_hand.csv").unlink()


def test_a_run_that_was_ended_goes_on_and_what_was_judged_is_not_judged_again(graded, library, monkeypatch):
    results, folder, out = graded
    sorted((out / "judged").glob("*.json"))[0].unlink()
    judged = []
    process = grading.FORKS.Process
    monkeypatch.setattr(grading.FORKS, "Process", lambda *a, **k: judged.append(k["args"][0]) or process(*a, **k))
    again = grade_folder(folder, out, SEED, Limits(), lessons=LESSONS)
    assert len(judged) == 1
    assert [one.judged for one in again.entries] == [one.judged for one in results.entries]


def test_nothing_runs_without_walls_unless_it_is_trusted(tmp_path, monkeypatch, capsys):
    handed_in(tmp_path / "in" / "alice_06.ipynb", "06", solved("06"))

    def none():
        raise SandboxError("no walls here")

    monkeypatch.setattr(grading, "require_walls", none)
    assert main(["grade", str(tmp_path / "in")]) == 2
    assert "no walls here" in capsys.readouterr().err
    assert main(["grade", str(tmp_path / "in"), "--trust", "--seed", "3"]) == 0
    out = capsys.readouterr().out
    assert "1 students, 4 answers: 4 right" in out
    assert "WITHOUT WALLS" in out
    assert "Graded without walls" in (tmp_path / "in-grades" / "grades.html").read_text(encoding="utf-8")
    assert json.loads((tmp_path / "in-grades" / "run.json").read_text())["seed"] == 3


@pytest.mark.parametrize("cell", ["=1+1", "+1", "-1", "@x", "\t=1", " =1", "\uff1d1", "\ufe661", "\uff0b1"])
def test_no_cell_is_a_formula_and_every_text_is_quoted(cell):
    text = table_text([[cell, 'a;b,"c"']])
    assert text.startswith("\ufeff\"'")
    assert next(csv.reader(io.StringIO(text[1:]))) == [f"'{cell}", 'a;b,"c"']


def test_two_students_never_share_a_page():
    taken: dict[str, str] = {}
    names = [feedback_name(student, taken) for student in ("a/b", "a b", "A B", "../x", "", "\U00020000" * 200)]
    assert len({name.casefold() for name in names}) == 6
    assert max(len(name.encode()) for name in names) <= 255
    assert not any("/" in name or name.startswith(".") for name in names)


def test_what_is_judged_is_a_plain_file_as_it_was_read(tmp_path):
    (tmp_path / "link.py").symlink_to(__file__)
    os.mkfifo(tmp_path / "pipe.py")
    for name in ("link.py", "pipe.py", "gone.py"):
        with pytest.raises(OSError, match=r"plain file|symbolic|No such"):
            grading.read_plain(tmp_path / name)
    assert grading.read_plain(__file__)[0].startswith(b'"""A folder')
