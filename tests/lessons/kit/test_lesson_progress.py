"""Progress: counted from the lessons and the records."""

import os

import nbformat
import pytest

from courseware.lessons.kit import lesson_progress
from courseware.lessons.kit.exercises import lesson_exercises
from courseware.lessons.kit.lesson_progress import Progress, progress_in, tables
from courseware.paths import notebook_paths, numbered_paths

ASKED = Progress("06 · Likelihood", 2, ("06.1", "06.2", "06.3", "06.4"))


@pytest.mark.parametrize("path", numbered_paths().values(), ids=lambda path: path.name[:2])
def test_the_exercises_counted_are_those_that_the_lesson_checks(path):
    number = path.name[:2]
    assert progress_in(path).exercises == tuple(exercise.number for exercise in lesson_exercises(number))
    assert progress_in(path).title.startswith(f"{number} · ")


def test_predictions_are_counted_where_the_lesson_asks_them_and_anew_when_it_was_written_anew(tmp_path):
    path = tmp_path / "06_x.ipynb"
    for n in (1, 2):
        cells = [
            nbformat.v4.new_markdown_cell("# 06 · A title: and what it promises\n\npredict(1, 2)"),
            nbformat.v4.new_code_cell(f'predict("06", "How many?",\n        {", ".join(["name"] * n)}, "How far?")'),
            nbformat.v4.new_code_cell("state, P = filter.predict(x, P); famous = update(*predict(*famous, u=0.3), z)"),
            nbformat.v4.new_code_cell("predict(states, sigma, rng); predict()  # functions of the student's"),
        ]
        nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
        os.utime(path, ns=(n, n))
        assert progress_in(path) == Progress("06 · A title", 2 + n)
    path.write_text("<<<<<<< HEAD")
    assert progress_in(path) == Progress("06 (its notebook cannot be read)")


@pytest.mark.parametrize(
    ("predictions", "letters", "typed", "right", "attempted", "state"),
    [
        (["ten", " "], "", 1, "", "", "begun"),
        (["ten", "far", "asked no more"], "rwnnr", 2, "1", "12", "begun"),
        (["ten", "far"], "rrrr", 2, "1234", "1234", "done"),
        (["ten"], "rrrr", 1, "1234", "1234", "begun"),
        ([], "n", 0, "", "", "not begun"),
    ],
)
def test_a_row_says_what_was_typed_tried_and_right(
    record, keep, monkeypatch, predictions, letters, typed, right, attempted, state
):
    monkeypatch.setattr(lesson_progress, "_asked", lambda path, written: ASKED)
    keep("06", letters, predictions)
    one = progress_in(record / "06.json")
    right, attempted = (tuple(f"06.{n}" for n in numbers) for numbers in (right, attempted))
    assert one == Progress(ASKED.title, 2, ASKED.exercises, typed, right, attempted)
    assert one.state == state


def test_the_rows_add_up(keep):
    keep("06", "rw")
    keep("07", "r")
    keep("P1", "r")
    lessons, _, projects = tables()
    total = sum(len(lesson_exercises(path.name[:2])) for path in notebook_paths())
    assert lessons.rows()[-1][:3] == ("together", f"2 of {total}", f"3 of {total}")
    assert lessons.rows()[6][1:] == ("1 of 4", "2 of 4", "0 of 3", "begun", "06.2")
    assert [cells[3] for cells in projects.rows()] == ["begun", *["not begun"] * 3, "0 of 4 done"]
