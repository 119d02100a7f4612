"""nbgrader itself on what we make: released, handed in solved, untouched, mistaken and forged, graded, fed back."""

import html
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook, new_output
from traitlets.config import Config

from course_lib.classroom.assignment_cells import read_assignments, tag_of
from course_lib.classroom.leaks import find_leaks, teachers_words
from course_lib.classroom.model_answers import model_bodies
from course_lib.classroom.nbgrader_course import canary_of, graded_cell, source_notebook
from course_lib.classroom.nbgrader_steps import (
    SKIP,
    RunWhatCounts,
    configure,
    graded_outputs,
    grading_module,
    only_defines,
    only_shows,
)
from course_lib.classroom.nbgrader_trial import leaks_of, nbgrader_api, scores, submit, told, try_assignment

SEED = 12_345_678_901_234
LESSON, PROJECT = read_assignments(["00", "P2"])


# The source notebooks


@pytest.mark.parametrize("assignment", read_assignments(), ids=lambda one: one.name)
def test_every_answer_has_one_graded_cell_after_its_check_and_nothing_else_is_graded(assignment):
    cells = source_notebook(assignment, "the-canary").cells
    graded = [index for index, cell in enumerate(cells) if cell.metadata.get("nbgrader", {}).get("grade")]
    numbers = [one.number for one in assignment.exercises()] + ([assignment.name] if assignment.is_project else [])
    assert [cells[index].metadata.nbgrader.grade_id for index in graded] == [
        f"points-{number.replace('.', '-')}" for number in numbers
    ]
    for index, number in zip(graded, numbers, strict=True):
        mark = cells[index].metadata.nbgrader
        assert mark.locked
        assert not mark.solution
        assert mark.points > 0
        hidden = re.search(r"### BEGIN HIDDEN TESTS\n(.*)\n### END HIDDEN TESTS", cells[index].source, re.S)[1]
        assert re.fullmatch(rf'from course_grading import points\n\npoints\("{re.escape(number)}", \w+\)', hidden)
        before = cells[index - 1]
        assert tag_of(before) == ("submission" if number == assignment.name else "check")
        assert "nbgrader" not in before.metadata or number == assignment.name
    answers = [cell for cell in cells if cell.metadata.get("nbgrader", {}).get("solution")]
    assert len(answers) == len(graded)
    assert all("    # the-canary\n" in cell.source for cell in answers)


# What nbgrader does besides its own


def test_a_cell_that_only_shows_is_skipped_and_one_that_binds_a_name_is_not():
    assert only_shows('show(figure, alt="x")\ncheck("06.1", f)')
    assert not only_shows("x = 3\nshow(x)")
    assert not only_shows("show(x := 3)")
    assert not only_shows("lesson.show(x)")
    assert not only_shows("for x in range(3):\n    print(x)")
    assert not only_shows("%matplotlib inline")
    assert not only_shows("")
    assert only_defines("import numpy as np\ndef f(): ...")
    assert not only_defines("x = 3")


def test_nobody_has_a_graded_cell_skipped():
    cell = graded_cell("06.1", "raw_score", 2)
    cell.metadata["tags"] = [SKIP, "mine"]
    shown = new_code_cell('check("06.1", raw_score)', metadata={"tags": ["check"]})
    answer = new_code_cell("def raw_score(hidden, alpha):\n    ...", metadata={"tags": [SKIP]})
    RunWhatCounts().preprocess(new_notebook(cells=[cell, shown, answer]), {})
    assert cell.metadata["tags"] == ["mine"]
    assert shown.metadata["tags"] == ["check", SKIP]
    assert answer.metadata["tags"] == []


def result(text):
    return new_output("execute_result", data={"text/plain": text}, execution_count=1)


def stream(name, text):
    return new_output("stream", name=name, text=text)


@pytest.mark.parametrize(
    ("outputs", "words"),
    [
        ([], "0 results"),
        ([stream("stdout", "6.0")], "0 results"),
        ([result("6.0"), result("0.0")], "2 results"),
        ([result("6.5")], "no number of points"),
        ([result("-1")], "no number of points"),
        ([result("nan")], "no number of points"),
        ([result("'6.0'")], "no number of points"),
        ([new_output("error", ename="NameError", evalue="x", traceback=["points('06.1', f)"])], "NameError"),
        ([result("6.0"), new_output("error", ename="KeyboardInterrupt", evalue="", traceback=[])], "KeyboardInterrupt"),
    ],
)
def test_nothing_but_one_number_of_points_is_points(outputs, words):
    (refused,) = graded_outputs(outputs, 6.0)
    assert refused.output_type == "error"
    assert words in refused.evalue
    assert refused.traceback == [refused.evalue], "no traceback: it would show the hidden test"


def test_one_number_and_what_was_printed_are_kept_and_the_error_stream_is_not():
    kept = graded_outputs([stream("stderr", "a warning"), stream("stdout", "06.1: right.\n"), result("6.0")], 6.0)
    assert [one.output_type for one in kept] == ["stream", "execute_result"]
    assert kept[0].name == "stdout"


def test_without_its_graded_tests_a_course_says_what_is_missing(tmp_path):
    with pytest.raises(FileNotFoundError, match="stay together"):
        grading_module(tmp_path)


# nbgrader itself


@pytest.fixture(scope="module")
def lesson(tmp_path_factory):
    """The three submissions of a lesson: the course's folder and what came of them."""
    folder = tmp_path_factory.mktemp("lesson")
    return folder / "nbgrader", try_assignment(LESSON, SEED, answers_only=True, folder=folder)


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    folder = tmp_path_factory.mktemp("project")
    return folder / "nbgrader", try_assignment(PROJECT, SEED, answers_only=True, folder=folder)


def words(path):
    """What a page says."""
    return html.unescape(re.sub(r"<[^>]*>", "", path.read_text(encoding="utf-8").split("<body", 1)[1]))


@pytest.mark.slow
def test_a_lessons_submissions_have_all_none_and_the_right_partial_points(lesson):
    _, trial = lesson
    assert (trial.most, trial.solved, trial.untouched) == (12.0, 12.0, 0.0)
    assert trial.mistaken == trial.expected
    assert 0 < trial.expected < 12
    assert trial.leaks == ()
    assert trial.as_it_must_be


@pytest.mark.slow
def test_a_projects_submissions_have_all_none_and_the_right_partial_points(project):
    _, trial = project
    assert trial.as_it_must_be, trial.row()


@pytest.mark.slow
def test_a_released_stub_is_the_lessons_own(lesson):
    course, _ = lesson
    released = nbformat.read(course / "release" / "00" / "00.ipynb", as_version=4)
    stubs = [cell.source for cell in released.cells if tag_of(cell) == "exercise"]
    assert stubs == [one.stub for one in LESSON.exercises()]
    text = nbformat.writes(released)
    assert "HIDDEN" not in text
    assert "SOLUTION" not in text
    assert json.dumps(released.metadata).count("kernelspec") == 1


@pytest.mark.slow
def test_the_command_releases_the_same_with_the_configuration_of_the_folder(lesson, tmp_path):
    course, _ = lesson
    shutil.copytree(course / "source", tmp_path / "nbgrader" / "source")
    shutil.copy(course / "nbgrader_config.py", tmp_path / "nbgrader")
    shutil.copytree(course.parent / "grading", tmp_path / "grading")
    command = [sys.executable, "-m", "nbgrader", "generate_assignment", "00"]
    subprocess.run(command, cwd=tmp_path / "nbgrader", check=True, capture_output=True)
    name = "release/00/00.ipynb"
    assert (tmp_path / "nbgrader" / name).read_text() == (course / name).read_text()


@pytest.mark.slow
def test_the_feedback_says_the_kind_of_each_mistake_and_shows_no_test(lesson):
    course, _ = lesson
    pages = {student: words(course / "feedback" / student / "00" / "00.html") for student in ("solved", "mistaken")}
    assert pages["solved"].count(": right.") == 3
    assert pages["mistaken"].count(": right.") == 1
    assert pages["mistaken"].count(": not yet. ") == 2
    for page in pages.values():
        assert "points(" not in page
        assert "course_grading" not in page
        assert "Traceback" not in page
    assert words(course / "feedback" / "untouched" / "00" / "00.html").count(": not attempted.") == 3


@pytest.mark.slow
def test_a_leak_is_found_in_every_folder(lesson, tmp_path):
    course, _ = lesson
    copy = tmp_path / "nbgrader"
    shutil.copytree(course, copy)
    canary, body = canary_of(SEED), model_bodies(LESSON)["find_the_camera"]
    places = ("release/00/x.md", "submitted/solved/x.md", "autograded/solved/00/x.md", "feedback/mistaken/00/x.html")
    for number, place in enumerate(places):
        (copy / place).write_text(f"<p>see {canary}</p>" if number % 2 else f"and {SEED}")
    (copy / "feedback" / "untouched" / "00" / "y.html").write_text(f"<pre>{html.escape(body)}</pre>")
    (copy / "release" / "00" / "z.py").write_text(body)
    found = leaks_of(copy, LESSON, SEED)
    assert len(found) == len(places) + 2
    assert {leak.split("/")[0] for leak in found} == {"release", "submitted", "autograded", "feedback"}


FORGERIES = {
    "depth_difference": "import sys\nsys.displayhook(2.0)\nreturn 0",
    "difference_of_vote": "import sys\nsys.modules['course_grading'].SEED = 0\nraise SystemExit",
}
SPY = """import sys
print(open(sys.modules["course_grading"].__file__).read())
print(sys.modules["course_grading"].SEED)"""


@pytest.mark.slow
def test_forged_points_are_none_and_what_is_the_teachers_is_taken_out(lesson):
    course, _ = lesson
    path = submit(course, "00", "forger", FORGERIES)
    notebook = nbformat.read(path, as_version=4)
    graded = [cell for cell in notebook.cells if cell.metadata.get("nbgrader", {}).get("grade")]
    graded[0].source = "12.0"
    graded[1].metadata["tags"] = [SKIP]
    notebook.cells.remove(graded[2])
    notebook.cells.insert(1, new_code_cell(SPY))
    notebook.cells.insert(1, new_code_cell("def points(number, function):\n    return 6.0"))
    nbformat.write(notebook, path)
    (path.parent / "course_grading.py").write_text("def points(number, function):\n    return 6.0\n")
    api = nbgrader_api(course)
    told(api.autograde("00", "forger"))
    told(api.generate_feedback("00", "forger"))
    assert scores(course, "00")["forger"] == 0.0
    for folder in ("autograded", "feedback"):
        teachers = {name: word for name, word in teachers_words(SEED, canary_of(SEED)).items() if "module" not in name}
        assert find_leaks(course / folder / "forger", teachers) == []
    assert "this cell showed what is the teacher's" in words(course / "feedback" / "forger" / "00" / "00.html")


def test_the_configuration_makes_the_programs_of_the_environment_found(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", "/usr/bin")
    config = Config()
    configure(config, tmp_path / "nbgrader")
    assert os.environ["PATH"].split(os.pathsep)[0] == str(Path(sys.executable).parent)
    assert config.ClearSolutions.code_stub == {"python": "..."}
    assert config.IgnorePattern.enabled
    assert re.search(config.IgnorePattern.pattern, "\n")
