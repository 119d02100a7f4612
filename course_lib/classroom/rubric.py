"""The teacher's page for a lesson: what each exercise asks and is worth, typical mistakes, what to talk about."""

import re

from course_lib.classroom.assignment_cells import Assignment
from course_lib.classroom.points import BY_HAND, SCORE_POINTS, points_of
from course_lib.classroom.templates import template
from course_lib.classroom.worlds import LINES, paper_value
from course_lib.lessons.kit.exercises import find_exercise
from course_lib.lessons.kit.projects import find_project

MOVED = "the hidden rooms, on maps that are turned and shifted, the rig turned"
WORLDS = {"P1": "recordings of the secret seed", "P2": MOVED, "P3": MOVED, "P4": "cameras of the secret seed"}


def rubric(assignment: Assignment, canary: str) -> str:
    """Return the page of one lesson or project, Markdown."""
    exercises = [(one, find_exercise(one.number)) for one in assignment.exercises()]
    points = {one.number: points_of(exercise) for one, exercise in exercises}
    values = {"assignment": assignment, "canary": canary, "exercises": exercises, "points": points, "project": None}
    values |= {"score_points": SCORE_POINTS, "by_hand": BY_HAND, "first_question": first_question}
    most = sum(points.values())
    if assignment.is_project:
        project, most = find_project(assignment.name), most + SCORE_POINTS + BY_HAND
        values |= {"project": project, "worlds": WORLDS[project.name], "line": LINES[project.name][1]}
        values |= {"paper": project.told(paper_value(project))}
    return template("rubric.md").render(values | {"most": most})


def first_question(hints: str) -> str:
    """Return the words of the first hint, which is a question."""
    first = hints.split("</details>")[0]
    return " ".join(re.sub(r"<details>|<summary>.*?</summary>", "", first).split())
