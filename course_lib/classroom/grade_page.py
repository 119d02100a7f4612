"""The results as one page that needs nothing else: no script, no picture, no font from anywhere."""

import html
from collections.abc import Iterable

from course_lib.classroom.grade_tables import by_student, first_graded, lesson_points
from course_lib.classroom.grading import Results
from course_lib.classroom.judging import Graded
from course_lib.classroom.probe import PROTECTIONS

STYLE = """
:root { color-scheme: light dark; --line: #8a8a8a; --soft: #f1f3f5; }
@media (prefers-color-scheme: dark) { :root { --soft: #23272b; } }
body { font: 1rem/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 64rem; padding: 1rem; }
table { border-collapse: collapse; margin: .5rem 0 1rem; }
caption { text-align: left; font-weight: 600; padding: .3rem 0; }
th, td { border: 1px solid var(--line); padding: .25rem .5rem; text-align: left; vertical-align: top; }
td.status { white-space: nowrap; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
thead th { background: var(--soft); }
td { overflow-wrap: anywhere; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; background: var(--soft); padding: .4rem; margin: .3rem 0; }
.wide { overflow-x: auto; }
.refused { border-left: .3rem solid currentcolor; padding-left: .5rem; margin: .3rem 0; }
a:focus-visible, summary:focus-visible, .wide:focus-visible { outline: 3px solid #1a73e8; outline-offset: 2px; }
"""
MARKS = {"right": "\u2713", "partly right": "\u00bd", "wrong": "\u2717", "not attempted": "\u2013", "not read": "!"}
"""A sign beside the word, so that a column can be skimmed."""


def grade_page(results: Results) -> str:
    """The page: totals, what was not read, how it was graded, and each student's answers."""
    students = by_student(results)
    sections = [_student(number, name, graded) for number, (name, graded) in enumerate(students.items(), 1)]
    body = [
        "<h1>Grades</h1>",
        _summary(results, len(students)),
        _totals(results, students),
        _not_read(results),
        _protections(results),
        "<h2>Students</h2>",
        *sections,
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
        f"<title>Grades</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<main>\n"
        + "\n".join(part for part in body if part)
        + "\n</main>\n</body>\n</html>\n"
    )


def _summary(results: Results, n_students: int) -> str:
    refused = sum(bool(one.refused) for one in results.graded)
    lessons = ", ".join(_text(assignment.name) for assignment in results.assignments) or "none"
    return (
        f"<p>{n_students} students, {len(results.graded)} answers; lessons: {lessons}. Answers whose code tried "
        f"what it may not, and was refused: {refused}; what it was is said beside the answer.</p>\n"
        f"<p>Seed of the inputs: {results.seed}. The same submissions and seed give this page again. It is for the "
        "teacher: what a student's code printed or said of an error may tell hidden inputs.</p>"
    )


def _totals(results: Results, students: dict[str, list[Graded]]) -> str:
    lessons = [assignment.name for assignment in results.assignments]
    most = {lesson: sum(one.most for one in first_graded(results, lesson)) for lesson in lessons}
    head = "".join(f'<th scope="col" class="number">{_text(name)} (of {most[name]})</th>' for name in lessons)
    rows = []
    for number, (name, graded) in enumerate(students.items(), 1):
        points = [lesson_points(graded, lesson) for lesson in lessons]
        cells = "".join(f'<td class="number">{"none" if earned is None else earned}</td>' for earned in points)
        total = sum(earned or 0 for earned in points)
        rows.append(
            f'<tr><th scope="row"><a href="#student-{number}">{_text(name)}</a></th>{cells}'
            f'<td class="number">{total}</td></tr>'
        )
    return (
        '<h2 id="points">Points</h2>\n<div class="wide" role="region" aria-labelledby="points" tabindex="0"><table>\n'
        "<caption>Points by student and lesson; none: nothing was handed in</caption>\n"
        f'<thead><tr><th scope="col">Student</th>{head}<th scope="col" class="number">Sum (of '
        f"{sum(most.values())})</th></tr></thead>\n<tbody>\n{_lines(rows)}\n</tbody></table></div>"
    )


def _not_read(results: Results) -> str:
    if not results.collection.not_read:
        return ""
    rows = [
        f'<tr><th scope="row">{_text(one.name)}</th><td>{_text(one.student or "nobody")}</td>'
        f"<td>{_text(one.why)}</td></tr>"
        for one in results.collection.not_read
    ]
    return (
        "<h2>Not read</h2>\n<table><caption>Files that were not graded, and why</caption>\n"
        '<thead><tr><th scope="col">File</th><th scope="col">Whose</th><th scope="col">Why</th></tr></thead>\n'
        f"<tbody>\n{_lines(rows)}\n</tbody></table>"
    )


def _protections(results: Results) -> str:
    given = [words for words in PROTECTIONS if words not in results.missing]
    text = f"<p>Tried before anything was run, and held on this machine: {_text('; '.join(given) or 'nothing')}.</p>"
    if results.missing:
        text += (
            "\n<p><strong>Not held on this machine, and graded all the same (--trusted):</strong> what these say is "
            f"not so here: {_text('; '.join(results.missing))}.</p>"
        )
    return f"<h2>How strangers' code was kept in</h2>\n{text}"


def _student(number: int, name: str, graded: list[Graded]) -> str:
    points, most = sum(one.points for one in graded), sum(one.most for one in graded)
    rows = _lines(_answer(one) for one in graded)
    table = (
        f'<div class="wide" role="region" aria-labelledby="student-{number}" tabindex="0"><table>\n'
        f"<caption>Answers of {_text(name)}: {points} of {most} points</caption>\n"
        '<thead><tr><th scope="col">Exercise</th><th scope="col">Status</th><th scope="col" class="number">Points</th>'
        '<th scope="col" class="number">Inputs right</th><th scope="col">What was said</th></tr></thead>\n'
        f"<tbody>\n{rows}\n</tbody></table></div>"
        if graded
        else "<p>Nothing of theirs could be read.</p>"
    )
    back = '<p><a href="#points">Back to all points</a></p>'
    return f'<section>\n<h3 id="student-{number}">{_text(name)}</h3>\n{table}\n{back}\n</section>'


def _answer(one: Graded) -> str:
    said = [f"<div>{_text(one.sentence)}</div>"]
    said += [f'<div class="refused">Tried to {_text(what)}: refused.</div>' for what in one.refused]
    said += [f"<div>While the notebook was read: {_text(what)}</div>" for what in one.problems]
    if one.printed and one.status != "right":
        summary = f"<summary>What {_text(one.number)} printed</summary>"
        said.append(f"<details>{summary}<pre>{_text(one.printed)}</pre></details>")
    inputs = f"{one.right_inputs} of {one.inputs}" if one.inputs else "none run"
    return (
        f'<tr><th scope="row">{_text(one.number)}</th>'
        f'<td class="status"><span aria-hidden="true">{MARKS[one.status]}</span> {one.status}</td>'
        f'<td class="number">{one.points} of {one.most}</td><td class="number">{inputs}</td>'
        f"<td>{''.join(said)}</td></tr>"
    )


def _lines(parts: Iterable[str]) -> str:
    return "\n".join(parts)


def _text(text: object) -> str:
    return html.escape(str(text), quote=True)
