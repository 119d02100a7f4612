"""What an answer is worth in class: judged on inputs that a secret seed draws, with feedback that gives nothing away.

An exercise: full points where every input's answer is right, half where at least half of them are (`points`). What the
feedback says is the kind of the verdict alone: never an input, a value, a text of the student's own making (an error's
message could carry the inputs out), or what it printed.
Whatever the function writes, warns or logs goes nowhere: nbgrader takes one line on the error stream for a failure.
"""

import contextlib
import copy
import hashlib
import io
import os
import sys
import warnings
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from course_lib.classroom.points import earned
from course_lib.classroom.score_worlds import graded_project, score_points, score_sentence
from course_lib.lessons.kit.attempt import attempt
from course_lib.lessons.kit.exercises import Exercise, find_exercise, is_stub, right_on
from course_lib.lessons.kit.forbidden import forbidden_module
from course_lib.lessons.kit.general_mistakes import general_mistake
from course_lib.lessons.kit.hints import kind_of, known_mistake
from course_lib.lessons.kit.projects import Project, outcomes, project_names

CALL_SECONDS = 10.0
"""Longest time of one call; right answers take milliseconds."""
TOO_SLOW = "does not end within"

ERRORS = {
    name: kind
    for name, kind in vars(__import__("builtins")).items()
    if isinstance(kind, type) and issubclass(kind, Exception)
}


class Grade(NamedTuple):
    """Points of one answer, and the sentence that its feedback may show."""

    points: float
    sentence: str


def points(number: str, function: Callable, seed: int) -> float:
    """Points of `function` for exercise or stage `number`, or for the score of a project; prints its feedback.

    seed: the secret one of the class.
    """
    with silence():
        found = grade(number, function, seed)
    print(f"{number}: {found.sentence}")
    return found.points


def grade(number: str, function: Callable, seed: int) -> Grade:
    """Points and feedback of one answer."""
    if not callable(function):
        return Grade(0.0, f"not yet. A function is asked; this is a {kind_of(function)}.")
    if is_stub(function):
        return Grade(0.0, "not attempted.")
    if number in project_names():
        return grade_score(graded_project(number, secret(seed, number)), function)
    return grade_exercise(find_exercise(number), function, secret(seed, number))


def secret(seed: int, number: str) -> int:
    """The seed of one exercise: not that of another, and none of the course's own."""
    digest = hashlib.sha256(f"{seed}/{number}".encode()).digest()
    return 1_000_000 + int.from_bytes(digest[:6], "big")


def grade_exercise(exercise: Exercise, function: Callable, seed: int) -> Grade:
    """Points and feedback of an answer, on the cases and random inputs of the seed."""
    arguments = exercise.draw(np.random.default_rng(seed))
    answers: list = []
    troubles: list[str] = []
    for given in arguments:
        call = attempt(function, used := copy.deepcopy(given), CALL_SECONDS)
        if call.value is ...:
            return Grade(0.0, "not attempted.")
        trouble = failure_kind(call.failure) if call.failure else changed(used, given)
        troubles += [trouble] if trouble else []
        answers.append(None if trouble else call.value)
        if call.failure and call.failure.startswith(TOO_SLOW):
            answers += [None] * (len(arguments) - len(answers))
            break
    right = right_on(exercise, arguments, answers)
    return Grade(float(earned(exercise, right)), sentence_of(exercise, arguments, answers, right, troubles))


def sentence_of(exercise: Exercise, arguments: list, answers: list, right: list[bool], troubles: list[str]) -> str:
    """What the feedback says: right, the trouble of a call, a known mistake's hint, or on how much it is right."""
    if all(right):
        return "right."
    if troubles:
        where = "" if len(troubles) == len(arguments) else " on some inputs"
        return f"not yet. Your function {troubles[0]}{where}."
    if all(answer is None for answer in answers):
        return "not yet. Your function returns None."
    hint = known_mistake(exercise, arguments, answers) or general_mistake(exercise, arguments, answers)
    if hint is not None:
        return f"not yet. {hint}"
    if any(right):
        return "not yet. Right on some inputs, wrong on others: which case is left out?"
    return "not yet. Not right on any input."


def failure_kind(failure: str) -> str:
    """The kind of a failed call, without any word of the student's: an error of Python's own by its name."""
    if failure.startswith(TOO_SLOW):
        return "does not end"
    if failure.startswith("prints"):
        return "prints without end"
    if failure.startswith("calls exit"):
        return "calls exit() or quit()"
    if failure.startswith("calls itself"):
        return "calls itself without end"
    name = failure.removeprefix("stops with ").split(":")[0].split(" ")[0].rstrip(".")
    return f"stops with {name}" if name in ERRORS else "stops with an error"


def changed(used: tuple, given: tuple) -> str | None:
    """What is said where the function changed an array that it was given."""
    for one, kept in zip(used, given, strict=True):
        array = np.asarray(kept)
        if not np.array_equal(one, kept, equal_nan=array.dtype.kind == "f"):
            return "changes the array it was given"
    return None


def grade_score(project: Project, function: Callable) -> Grade:
    """Points and feedback of a project's function in the worlds of the secret seed."""
    if (module := forbidden_module(function, project.forbidden)) is not None:
        return Grade(0.0, f"not scored. Your function uses {module}, which this project asks you to write yourself.")
    found = outcomes(project, function, project.seeds)
    values = [outcome.value for outcome in found]
    failed = sum(outcome.failed for outcome in found)
    return Grade(score_points(project, values), score_sentence(project, values, failed))


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Nothing that runs here is heard: not on either stream, at neither level, not as a result, not as a warning.

    Whoever keeps the stream itself (a logging handler) writes to nowhere, too.
    """
    streams = [stream for stream in {id(s): s for s in (sys.stdout, sys.stderr)}.values()]
    for stream in streams:
        stream.flush()
    with contextlib.ExitStack() as stack:
        stack.enter_context(_descriptors_to_nowhere())
        for stream in streams:
            stack.enter_context(_replaced(stream, "write", len))
        stack.enter_context(_replaced(sys, "displayhook", lambda value: None))
        stack.enter_context(contextlib.redirect_stdout(io.StringIO()))
        stack.enter_context(contextlib.redirect_stderr(io.StringIO()))
        stack.enter_context(warnings.catch_warnings())
        warnings.simplefilter("ignore")
        yield


@contextlib.contextmanager
def _replaced(owner: object, name: str, value: object) -> Iterator[None]:
    """An attribute set for a while; what takes none (a file of C's making) is left as it is."""
    kept = vars(owner).get(name, owner) if hasattr(owner, "__dict__") else owner
    try:
        setattr(owner, name, value)
    except AttributeError:
        yield
        return
    try:
        yield
    finally:
        delattr(owner, name) if kept is owner else setattr(owner, name, kept)


@contextlib.contextmanager
def _descriptors_to_nowhere() -> Iterator[None]:
    """File descriptors 1 and 2 to the null device: what compiled code writes, and other processes that it starts."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    kept = {descriptor: os.dup(descriptor) for descriptor in (1, 2)}
    try:
        for descriptor in kept:
            os.dup2(nowhere, descriptor)
        yield
    finally:
        for descriptor, copy_of_it in kept.items():
            os.dup2(copy_of_it, descriptor)
            os.close(copy_of_it)
        os.close(nowhere)
