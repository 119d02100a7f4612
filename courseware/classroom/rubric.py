"""The teacher's page for a lesson: what each exercise asks and is worth, typical mistakes, what to talk about."""

import re

from courseware.classroom.assignment_cells import Assignment
from courseware.classroom.points import BY_HAND, SCORE_POINTS, most_of
from courseware.classroom.templates import PAGES
from courseware.classroom.worlds import LINES, paper_value
from courseware.lessons.kit.exercises import find_exercise
from courseware.lessons.kit.projects import find_project


def rubric(assignment: Assignment, canary: str) -> str:
    """Return the page of one lesson or project, Markdown."""
    exercises = [(one, find_exercise(one.number)) for one in assignment.exercises()]
    most = sum(map(most_of, assignment.functions()))
    values = {"assignment": assignment, "exercises": exercises, "canary": canary, "most": most, "project": None}
    if assignment.is_project:
        project = find_project(assignment.name)
        values |= {"project": project, "line": LINES[project.name][1], "paper": project.told(paper_value(project))}
        values |= {"most": most + BY_HAND, "score_points": SCORE_POINTS, "by_hand": BY_HAND}
    return PAGES.get_template("rubric.md").render(values, most_of=most_of, first_question=first_question)


def first_question(hints: str) -> str:
    """Return the words of the first hint, which is a question."""
    first = hints.split("</details>")[0]
    return " ".join(re.sub(r"<details>|<summary>.*?</summary>", "", first).split())
