"""The results as CSV: a row for each student and exercise, and a table of totals."""

import csv
import io
from collections.abc import Iterable, Sequence

from course_lib.classroom.grading import Results
from course_lib.classroom.judging import Graded

COLUMNS = (
    "student", "lesson", "exercise", "status", "points", "of", "inputs right", "inputs", "what was said", "refused",
)  # fmt: skip
FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""A spreadsheet program takes a cell that begins so for a formula, and runs it."""


def answers_table(results: Results) -> str:
    """A row for each student and exercise."""
    rows = [
        (
            one.student, one.lesson, one.number, one.status, one.points, one.most, one.right_inputs, one.inputs,
            one.sentence, "; ".join(one.refused),
        )
        for one in results.graded
    ]  # fmt: skip
    return written([COLUMNS, *rows])


def totals_table(results: Results) -> str:
    """A row for each student: points of each lesson (empty where nothing was handed in), and their sum."""
    lessons = [assignment.name for assignment in results.assignments]
    rows = []
    for student, graded in by_student(results).items():
        points = [lesson_points(graded, lesson) for lesson in lessons]
        cells = ["" if earned is None else earned for earned in points]
        rows.append((student, *cells, sum(earned or 0 for earned in points)))
    most = [sum(one.most for one in first_graded(results, lesson)) for lesson in lessons]
    header = (
        "student",
        *(f"{name} (of {of})" for name, of in zip(lessons, most, strict=True)),
        f"sum (of {sum(most)})",
    )
    return written([header, *rows])


def by_student(results: Results) -> dict[str, list[Graded]]:
    """Every student's answers, in the order of the names; those of whom nothing could be read have none."""
    names = {one.student for one in results.graded}
    names |= {one.student for one in results.collection.not_read if one.student}
    return {name: [one for one in results.graded if one.student == name] for name in sorted(names)}


def lesson_points(graded: Sequence[Graded], lesson: str) -> int | None:
    """Points in one lesson; None where nothing of it was handed in."""
    points = [one.points for one in graded if one.lesson == lesson]
    return sum(points) if points else None


def first_graded(results: Results, lesson: str) -> list[Graded]:
    """One student's answers to a lesson, for what they could have earned."""
    of_lesson = [one for one in results.graded if one.lesson == lesson]
    return [one for one in of_lesson if one.student == of_lesson[0].student]


def written(rows: Iterable[Sequence[object]]) -> str:
    """Rows as CSV, every text as a text: what would be a formula gets an apostrophe before it."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    for row in rows:
        writer.writerow([harmless(cell) for cell in row])
    return text.getvalue()


def harmless(cell: object) -> object:
    """A cell that no spreadsheet program takes for a formula."""
    return f"'{cell}" if isinstance(cell, str) and cell.lstrip(" \n").startswith(FORMULA) else cell
