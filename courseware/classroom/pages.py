"""What a grading writes: the teacher's page, a feedback page for each student, and tables for an LMS."""

import itertools
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from course_lib.files import atomic_write
from courseware.classroom.points import BY_HAND
from courseware.classroom.results import Results, table_text
from courseware.classroom.templates import PAGES
from courseware.lessons.kit.projects import project_names

MARKS = {"right": "\u2713", "partly right": "\u00bd", "wrong": "\u2717", "not attempted": "\u2013"}
"""A sign beside the word, so that a column can be skimmed."""


def write_results(results: Results, out: Path) -> list[str]:
    """Write all pages and tables into a folder and return their names."""
    values = {"results": results, "marks": MARKS, "projects": project_names(), "by_hand": BY_HAND}
    atomic_write(out / "grades.html", PAGES.get_template("grades.html").render(values))
    tables = {"totals.csv": totals(results), "answers.csv": answers(results)}
    for name, rows in tables.items():
        atomic_write(out / name, table_text(rows))
    (out / "feedback").mkdir(exist_ok=True)
    taken: dict[str, str] = {}
    for student in results.students:
        name = feedback_name(student, taken)
        page = PAGES.get_template("feedback.html").render(values | {"student": student})
        atomic_write(out / "feedback" / name, page)
    return ["grades.html", *tables, "feedback/"]


def feedback_name(student: str, taken: dict[str, str]) -> str:
    """Return a file name for a student's page that no other student has."""
    plain = re.sub(r"[^\w.@-]+", "_", student).strip("._")[:50] or "student"
    for k in itertools.count():
        name = f"{plain}-{k}" if k else plain
        if taken.setdefault(name.casefold(), student) == student:
            break
    return f"{name}.html"


def totals(results: Results) -> Iterable[Sequence[object]]:
    """Yield a row for each student: the roster's columns as they were, points of each lesson, and their sum."""
    lessons = results.lessons
    most = [results.most(lesson) for lesson in lessons]
    columns = [name for name in results.roster.columns if name]
    headings = [f"{lesson} (of {of})" for lesson, of in zip(lessons, most, strict=True)]
    yield ["student", *columns, *headings, f"sum (of {sum(most)})", "handed in"]
    for student in results.students:
        row = results.roster.rows.get(student, {})
        points = [results.points(student, lesson) for lesson in lessons]
        shown = ["" if one is None else f"{one:g}" for one in points]
        handed_in = "yes" if results.of(student) else "no"
        yield [student, *(row.get(name, "") for name in columns), *shown, f"{results.total(student):g}", handed_in]


def answers(results: Results) -> Iterable[Sequence[object]]:
    """Yield a row for each student and exercise."""
    yield ["student", "exercise", "status", "points", "of", "inputs right", "inputs", "tries", "what was said", "file"]
    for student in results.students:
        for entry in results.of(student):
            for one in entry.judged.answers:
                inputs, tries = [one.right_inputs, one.inputs], entry.judged.tries.get(one.number, "")
                said = [f"{one.points:g}", one.most, *inputs, tries, one.sentence, entry.name]
                yield [student, one.number, one.status, *said]
