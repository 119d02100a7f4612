"""Submissions as students hand them in: a lesson's notebook with answers in place of its stubs."""

import json
from pathlib import Path

import nbformat

from courseware.classroom.assignment_cells import Assignment, read_assignments, tag_of
from courseware.classroom.model_answers import model_answers
from courseware.lessons.kit.exercises import find_exercise
from courseware.lessons.kit.mistakes import ARROW, WHOLE_BODY, edited_text


def assignment_of(name: str) -> Assignment:
    (assignment,) = read_assignments([name])
    return assignment


def handed_in(path: Path, name: str, answers: dict[str, str], release: Path | None = None) -> Path:
    """Write the notebook of a lesson, or a released one, with `answers[number]` in place of a stub; others stay."""
    notebook = nbformat.read(release, as_version=4) if release else assignment_of(name).notebook()
    for cell in notebook.cells:
        if tag_of(cell) == "exercise" and cell.metadata.get("exercise") in answers:
            cell.source = answers[cell.metadata["exercise"]].replace("{stub}", cell.source)
        if cell.cell_type == "code":
            cell.outputs = []
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(notebook), encoding="utf-8")
    return path


def solved(name: str) -> dict[str, str]:
    """Return the model answers of a lesson, by number."""
    return model_answers(assignment_of(name))


def mistaken(number: str) -> str:
    """Return a known mistake of an exercise as a student's cell: an edit that changes a part of the solution."""
    exercise = find_exercise(number)
    edits = (line for line in exercise.mistakes.splitlines() if ARROW in line)
    return edited_text(exercise.solution, next(edit for edit in edits if not edit.strip().startswith(WHOLE_BODY)))
