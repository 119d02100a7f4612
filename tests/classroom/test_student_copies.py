"""Student copies: no solution and no trace of one, all else as stored, every link leads somewhere in the folder."""

import re
from pathlib import PurePosixPath

import nbformat
import pytest

from courseware.classroom.assignment_cells import AssignmentError, read_assignments, tag_of
from courseware.classroom.leaks import find_leaks, solutions
from courseware.classroom.student_copies import (
    solved_notebook,
    student_notebook,
    student_text,
    unsolved_notebook,
    within,
    write_copies,
)
from courseware.lessons.kit.exercises import check
from courseware.working_copies import clear_answers

ASSIGNMENTS = read_assignments()
NAMES = [assignment.name for assignment in ASSIGNMENTS]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A folder of all lessons and projects."""
    folder = tmp_path_factory.mktemp("student")
    write_copies(folder, ASSIGNMENTS)
    return folder


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    """A folder of one lesson and one project."""
    folder = tmp_path_factory.mktemp("two")
    write_copies(folder, read_assignments(["6", "P2"]))
    return folder


LINKED = re.compile(r'(?:\]\(|(?:src|href)=\\?")(?![a-z]+:|//)([^)\s"\\#]+\.(?:md|ipynb|png|svg|jpg|html|py|json|txt))')


def links_of(folder):
    """(page, target) of every link and picture of a folder's pages and lessons that leads to a file."""
    for path in sorted([*folder.rglob("*.md"), *folder.rglob("*.ipynb")]):
        yield from ((path, target) for target in LINKED.findall(path.read_text(encoding="utf-8")))


def test_every_link_picture_and_scene_of_the_folder_is_in_it(whole, two):
    for folder in (whole, two):
        found = list(links_of(folder))
        assert len(found) > 20
        assert [(page.name, target) for page, target in found if not (page.parent / target).is_file()] == []


def test_a_lesson_that_is_not_handed_out_is_no_link(two):
    readme = (two / "README.md").read_text(encoding="utf-8")
    assert "[06 · Likelihood and weights](06_likelihood_and_weights.ipynb)" in readme
    assert "| 07 · Estimate and resample |" in readme


@pytest.mark.parametrize("assignment", ASSIGNMENTS, ids=NAMES)
def test_a_copy_is_the_lesson_without_its_solutions_and_measured_answers(assignment):
    copy = student_notebook(assignment)
    shown = unsolved_notebook(assignment)
    clear_answers(shown.cells)
    assert [cell.get("outputs") for cell in copy.cells] == [cell.get("outputs") for cell in shown.cells]
    kept = [cell for cell in assignment.stored.cells if tag_of(cell) != "solution"]
    assert [cell.id for cell in copy.cells] == [cell.id for cell in kept]
    assert len(kept) == len(assignment.stored.cells) - (0 if assignment.is_project else len(assignment.exercises()))
    for mine, stored in zip(copy.cells, kept, strict=True):
        assert mine.metadata == stored.metadata
        if mine.cell_type == "code":
            assert mine.source == stored.source


@pytest.mark.parametrize("assignment", ASSIGNMENTS, ids=NAMES)
def test_nothing_tells_that_a_cell_was_there(assignment):
    copy = student_notebook(assignment)
    counts = [cell.execution_count for cell in copy.cells if cell.cell_type == "code"]
    assert counts == list(range(1, len(counts) + 1))
    text = nbformat.writes(copy)
    assert "source_hidden" not in text
    assert not re.search(r"_solution\b|-solution\b|[Ss]olution [\dF]\d\.\d|model solution|solutions/", text)
    assert not re.search(r"\b(the|a) solution\b", text, re.I)


def test_the_pages_of_the_series_tell_of_no_solutions(whole):
    for page in ("README.md", "projects/README.md"):
        assert "solution" not in (whole / page).read_text(encoding="utf-8").lower()


def test_no_model_answer_is_in_the_folder_and_a_planted_one_is_found(whole, tmp_path):
    answers = solutions(ASSIGNMENTS)
    assert len(answers) > 110
    assert find_leaks(whole, answers) == []
    write_copies(tmp_path, ASSIGNMENTS[6:7], lambda assignment, resolve: assignment.notebook())
    found = find_leaks(tmp_path, answers)
    assert len(found) == len(ASSIGNMENTS[6].exercises())
    assert found[0].startswith("06_likelihood_and_weights.ipynb holds the model answer of ")


def test_links_to_other_sites_and_within_the_page_stay():
    text = "[a](https://b.c) [d](#e) [f](g.md#h) ![i](pictures/j.png)"
    assert student_text(text, lambda target: None) == "[a](https://b.c) [d](#e) f ![i](pictures/j.png)"
    resolve = within({PurePosixPath("g.md")}, PurePosixPath("projects/P1.ipynb"))
    assert student_text("[f](../g.md#h) [k](l.md)", resolve) == "[f](../g.md#h) k"


def test_a_lesson_that_is_not_there_is_named():
    with pytest.raises(AssignmentError, match="no lesson 77"):
        read_assignments(["06", "77"])


@pytest.mark.parametrize("name", ["06", "12", "P2", "P4"])
def test_a_solved_copy_says_what_running_it_says(name, capsys):
    (assignment,) = read_assignments([name])
    solved = solved_notebook(assignment, canary="a-word")
    names: dict = {}
    exec("import numpy as np", names)
    for cell in solved.cells:
        if tag_of(cell) in ("exercise", "submission"):
            assert cell.source.startswith("# a-word\n")
            exec(cell.source, names)
        elif tag_of(cell) == "check":
            number = cell.metadata["exercise"]
            check(number, eval(cell.source.split(", ")[1].rstrip(")"), names))
            assert capsys.readouterr().out == cell.outputs[0].text == f"{number}: right.\n"
    assert "not attempted" not in nbformat.writes(solved)
