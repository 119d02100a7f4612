"""A project's last function in the sandbox, in the worlds of a secret seed: a process for each world."""

import numpy as np

from course_lib.classroom.answers import AnswerFormatError, decode, printable
from course_lib.classroom.confinement import Limits
from course_lib.classroom.needed_code import NeededCode
from course_lib.classroom.packed_arguments import packed, server
from course_lib.classroom.sandbox import Run, Sandbox
from course_lib.classroom.sandbox_process import Assignment
from course_lib.lessons.kit.projects import AnswerError, Outcome, Project

MEMORY_MB = 2000
ALL_CALLS = 5.0
"""All calls of one world may take so many times what one call may."""


def outcomes(project: Project, code: NeededCode, sandbox: Sandbox) -> tuple[list[Outcome], list[Run]]:
    """Outcome of every world, and what was noted meanwhile; none runs after one that does not attempt it, or hangs."""
    limits = Limits(project.seconds, ALL_CALLS * project.seconds, MEMORY_MB)
    found: list[Outcome] = []
    runs: list[Run] = []
    for seed in project.seeds:
        if found and found[-1].out_of_time:
            found.append(Outcome(project.worst, found[-1].remark, True, True))
            continue
        outcome, run = _outcome(project, code, sandbox, limits, seed)
        found.append(outcome)
        runs.append(run)
    return found, runs


def _outcome(project: Project, code: NeededCode, sandbox: Sandbox, limits: Limits, seed: int) -> tuple[Outcome, Run]:
    task = project.prepare(seed)
    calls = list(task.arguments) if project.many else [task.arguments]
    content, kept_here = packed(calls)
    run = sandbox.run(Assignment(code.cells, project.function, content, limits, keeps=False), server(kept_here))
    answers, failure = _answers(run, len(calls))
    if failure is not None:
        stops = run.ended is not None or not answers
        return Outcome(project.worst, f"Your function {failure}", True, stops), run
    try:
        with np.errstate(all="ignore"):
            result = project.measure(task, answers if project.many else answers[0])
    except AnswerError as error:
        return Outcome(project.worst, f"Your function {printable(error)}.", True), run
    except Exception as error:  # of a kind that nobody measures
        kind = type(error).__name__
        return Outcome(project.worst, f"Your function returns what cannot be measured ({kind}).", True), run
    if not np.isfinite(result.value):
        return Outcome(project.worst, f"failed: {result.remark or 'no number came of it'}", True), run
    return Outcome(float(result.value), result.remark), run


def _answers(run: Run, wanted: int) -> tuple[list, str | None]:
    """The answers of every call, and what failed in words that follow "Your function", or None."""
    answers = []
    for message in run.messages[:wanted]:
        if "failure" in message:
            return answers, printable(message["failure"])
        try:
            answers.append(decode(message.get("value")) if "value" in message else ...)
        except AnswerFormatError as error:
            return answers, f"sends the grader what is no answer: {error}."
    if len(answers) < wanted or any(answer is ... for answer in answers):
        none = next((message["none"] for message in run.messages if "none" in message), None)
        untouched = "is not attempted." if none in ("stub", "missing") else "does not answer every call."
        return [], f"{run.ended}." if run.ended else untouched
    return answers, None
