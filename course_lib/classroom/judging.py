"""One answer: its inputs drawn, run in the sandbox, compared with the reference here, and given its points.

What decides is never in reach of the student's code: it gets arguments and gives values, nothing else. What a value can
still do is take long, or much memory, while it is compared; so `grading` runs this in a process that it can end.
"""

import contextlib
import copy
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from course_lib.classroom.answers import AnswerFormatError, decode, printable
from course_lib.classroom.confinement import Limits
from course_lib.classroom.graded_tests import secret
from course_lib.classroom.needed_code import NeededCode, needed_code
from course_lib.classroom.packed_arguments import packed, server
from course_lib.classroom.points import earned, points_of
from course_lib.classroom.sandbox import Run, Sandbox
from course_lib.classroom.sandbox_process import Assignment
from course_lib.classroom.sandboxed_score import outcomes
from course_lib.classroom.score_worlds import MAX_POINTS, graded_project, score_points, score_sentence
from course_lib.classroom.submissions import SubmissionError, read_cells
from course_lib.lessons.kit.exercises import Exercise, fault, find_exercise, right_on

Status = Literal["right", "partly right", "wrong", "not attempted", "not read"]
LONGEST_SENTENCE = 600
DEFAULT_LIMITS = Limits()


class Task(NamedTuple):
    """One answer to grade: whose, of which file, to which exercise, in which function."""

    student: str
    lesson: str
    path: Path
    number: str
    function: str


@dataclass(frozen=True)
class Graded:
    """What one answer earned.

    points, most: earned and possible. right_inputs, inputs: on how many it is right. sentence: what is to be said.
    refused: what the code tried and was refused. problems: cells that failed, where the answer is not right. printed:
    the start of what the first call printed.
    """

    student: str
    lesson: str
    number: str
    status: Status
    points: int
    most: int
    right_inputs: int
    inputs: int
    sentence: str
    refused: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()
    printed: str = ""
    peak_mb: float = 0.0


def grade(task: Task, sandbox: Sandbox, seed: int, limits: Limits = DEFAULT_LIMITS) -> Graded:
    """Run and judge one answer, whatever is in its file."""
    try:
        code = needed_code(read_cells(task.path), task.function)
    except SubmissionError as error:
        return not_judged(task, "not read", f"The file {error}.")
    if task.number == task.lesson:
        return scored(task, code, sandbox, seed)
    exercise = find_exercise(task.number)
    arguments = exercise.draw(np.random.default_rng(secret(seed, task.number)))
    content, kept_here = packed(copy.deepcopy(arguments))
    run = sandbox.run(Assignment(code.cells, task.function, content, limits), server(kept_here))
    run.problems[:0] = code.problems
    return judged(task, exercise, arguments, run, str(sandbox.folder))


def not_judged(task: Task, status: Status, sentence: str) -> Graded:
    """No points, for a reason that is not in the answer."""
    most = MAX_POINTS if task.number == task.lesson else points_of(find_exercise(task.number))
    return Graded(task.student, task.lesson, task.number, status, 0, most, 0, 0, sentence)


def scored(task: Task, code: NeededCode, sandbox: Sandbox, seed: int) -> Graded:
    """Points of a project's last function, in the worlds of the secret seed; "inputs" are worlds in which it runs."""
    project = graded_project(task.number, secret(seed, task.number))
    found, runs = outcomes(project, code, sandbox)
    values = [outcome.value for outcome in found]
    failed = [outcome.remark for outcome in found if outcome.failed]
    points = int(score_points(project, values))
    sentence = score_sentence(project, values, len(failed)) + (f" {failed[0]}" if failed else "")
    status: Status = "right" if points == MAX_POINTS else "partly right" if points else "wrong"
    if len(failed) == len(found) and failed[0].endswith("is not attempted."):
        status, sentence = "not attempted", "Not attempted."
    folder = str(sandbox.folder)
    return Graded(
        task.student,
        task.lesson,
        task.number,
        status,
        points,
        MAX_POINTS,
        len(found) - len(failed),
        len(found),
        tidy(sentence, folder),
        tuple(dict.fromkeys(tidy(what, folder) for run in runs for what in run.refused)),
        tuple(dict.fromkeys(tidy(what, folder) for run in runs for what in run.problems)) if failed else (),
        peak_mb=max(run.peak_mb for run in runs),
    )


# The verdict


def judged(task: Task, exercise: Exercise, arguments: list[tuple], run: Run, folder: str = "") -> Graded:
    """Points and sentence, from what came back for each of the arguments."""

    def graded(status: Status, sentence: str, right: list[bool] | None = None) -> Graded:
        right = right or [False] * len(arguments)
        return Graded(
            task.student,
            task.lesson,
            task.number,
            status,
            earned(exercise, right),
            points_of(exercise),
            sum(right),
            len(arguments),
            tidy(sentence, folder),
            tuple(tidy(what, folder) for what in run.refused),
            tuple(tidy(what, folder) for what in run.problems) if not all(right) else (),
            tidy(str(calls[0].get("printed", "")) if calls else "", folder) or tidy(run.printed, folder),
            run.peak_mb,
        )

    calls = [message for message in run.messages if "value" in message or "failure" in message][: len(arguments)]
    none = next((message["none"] for message in run.messages if "none" in message), None)
    if none == "stub" or (none == "missing" and not run.problems):
        return graded("not attempted", "Not attempted." if none == "stub" else f"No function {task.function}().")
    if none is not None:
        said = "there is none" if none == "missing" else f"it is a {printable(none)[:60]}"
        return graded("wrong", f"A function {task.function}() is asked; {said}.")
    answers, troubles = _answers(calls, len(arguments), run)
    if calls and answers[0] is ...:
        return graded("not attempted", "Not attempted.")
    right, amiss = _right(exercise, arguments, answers)
    if all(right):
        return graded("right", "Right.", right)
    status: Status = "partly right" if earned(exercise, right) else "wrong"
    return graded(status, _sentence(exercise, arguments, answers, troubles, amiss), right)


def _answers(calls: list[dict], wanted: int, run: Run) -> tuple[list, list[str]]:
    """An answer for each input, None where there is none, and the troubles in words that follow "Your function"."""
    answers, troubles = [], []
    for call in calls:
        value = None
        if "failure" in call:
            troubles.append(printable(call["failure"])[:LONGEST_SENTENCE])
        elif call.get("changed"):
            troubles.append("changes the array it was given: work on a new one.")
        else:
            try:
                value = decode(call["value"])
            except AnswerFormatError as error:
                troubles.append(f"sends the grader what is no answer: {error}.")
        answers.append(value)
    if run.ended is not None:
        troubles.insert(0, f"{run.ended.rstrip('.')}.")
    elif len(answers) < wanted and not troubles:
        troubles.append("does not answer every call.")
    return answers + [None] * (wanted - len(answers)), troubles


def _right(exercise: Exercise, arguments: list[tuple], answers: list) -> tuple[list[bool], bool]:
    """Where the answers are right, and whether one is of a kind that the comparison cannot take (then: wrong)."""
    with np.errstate(all="ignore"):
        try:
            return right_on(exercise, arguments, answers), False
        except Exception:
            right = []
            for given, answer in zip(arguments, answers, strict=True):
                one = [False]
                with contextlib.suppress(Exception):
                    one = right_on(exercise, [given], [answer])
                right += one
            return right, True


def _sentence(exercise: Exercise, arguments: list, answers: list, troubles: list[str], amiss: bool) -> str:
    """What is to be said of answers that are not all right."""
    if troubles:
        return f"Your function {troubles[0]}"
    if amiss:
        return "Your function returns something that is no answer to this task: look at the kind of what it returns."
    with np.errstate(all="ignore"):
        return fault(exercise, arguments, answers) or "Right on every input, but not by one and the same method."


def tidy(text: str, folder: str = "") -> str:
    """A stranger's words in one bounded line, without what differs from run to run: addresses, the sandbox's folder."""
    text = printable(text)[: 2 * LONGEST_SENTENCE]
    text = text.replace(folder, "(its folder)") if folder else text
    return re.sub(r"0x[0-9a-fA-F]{6,}", "0x...", text)[:LONGEST_SENTENCE]
