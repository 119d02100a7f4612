"""The teacher's page for a lesson: what each exercise asks and is worth, typical mistakes, what to talk about."""

import re

from course_lib.classroom.assignment_cells import Assignment, ExerciseCells
from course_lib.classroom.points import BY_HAND, SCORE_POINTS, points_of
from course_lib.classroom.worlds import LINES, paper_value
from course_lib.lessons.kit.exercises import find_exercise
from course_lib.lessons.kit.projects import find_project

RULE = (
    "An answer is judged on inputs that the class's secret seed draws: **all** points where every one is right, "
    "**half** where at least half of them are, else **0**. What is not attempted has 0."
)


def rubric(assignment: Assignment, canary: str) -> str:
    """The page of one lesson or project, Markdown."""
    exercises = assignment.exercises()
    most = sum(points_of(find_exercise(one.number)) for one in exercises)
    score = SCORE_POINTS + BY_HAND if assignment.is_project else 0
    parts = [
        f"# Rubric · {assignment.title}",
        f"For the teacher alone ({canary}).",
        f"**{most + score} points.** {RULE}",
    ]
    parts += ["| exercise | level | points |\n|---|---|---|\n" + "\n".join(_row(one) for one in exercises)]
    if assignment.is_project:
        parts[-1] += (
            f"\n| {assignment.name}, the score | | {SCORE_POINTS} |\n| the written part, by hand | | {BY_HAND} |"
        )
    parts += [_exercise(one) for one in exercises]
    if assignment.is_project:
        parts.append(_score(assignment.name))
    return "\n\n".join(parts) + "\n"


def _row(one: ExerciseCells) -> str:
    exercise = find_exercise(one.number)
    return f"| {one.number} {one.title} | {exercise.level} | {points_of(exercise)} |"


def _exercise(one: ExerciseCells) -> str:
    exercise = find_exercise(one.number)
    task = "\n".join(one.task.splitlines()[1:]).strip()
    hints = list(dict.fromkeys(mistake.hint for mistake in exercise.known))
    listed = "\n".join(f"* {hint}" for hint in hints)
    return (
        f"## {one.number} {one.title} · {exercise.level}, {points_of(exercise)} points\n\n{task}\n\n"
        f"**Typical mistakes**, each as the check and the feedback answer it:\n\n{listed}\n\n"
        f"**To talk about.** {first_question(one.hints)} Then put two of the mistakes above side by side: on which "
        "inputs do they agree with the right answer, and which small case tells them apart?"
    )


def first_question(hints: str) -> str:
    """The words of the first hint, which is a question."""
    first = hints.split("</details>")[0]
    return " ".join(re.sub(r"<details>|<summary>.*?</summary>", "", first).split())


def _score(name: str) -> str:
    project, line = find_project(name), LINES[name]
    worlds = (
        "the hidden rooms, on maps that are turned and shifted, the rig turned"
        if name in ("P2", "P3")
        else "recordings of the secret seed"
        if name == "P1"
        else "cameras of the secret seed"
    )
    return (
        f"## {name}, the score · {SCORE_POINTS} points\n\n`{project.function}` runs in other worlds: {worlds}. What "
        f"counts is the median of: {project.title}.\n\n"
        f"| the median is | points |\n|---|---|\n| {line.words} | {SCORE_POINTS} |\n"
        f"| better than the paper's method ({project.told(paper_value(project))} on the hidden seeds) "
        f"| {SCORE_POINTS // 2} |\n"
        f"| worse, but the function runs in every world | {SCORE_POINTS // 4} |\n| else | 0 |\n\n"
        f"The written part, which no program reads, has {BY_HAND} points: write them into `by_hand.csv` of the grades.\n\n"
        "**To talk about.** What did you change, what did it gain on your own seeds, and how would you know that it "
        "was not luck? Which idea did *not* help?"
    )
