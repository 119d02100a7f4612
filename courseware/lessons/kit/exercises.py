"""Exercises: `check("03.1", function)` says at once: not attempted, right, or wrong with a hint.

A student's function runs on special cases and on random inputs, and its values are compared with the solution's. If
they differ, they are compared with the values of every known mistake. The student never sees the inputs. The exercises
of lesson NN are the list `EXERCISES` in `courseware/answers/lesson_NN.py`, and their mistakes with the hints are the
file `lesson_NN.hints` next to it.
"""

import copy
import dis
import functools
import importlib
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Literal, NamedTuple

import numpy as np

from courseware.lessons.kit.attempt import TIME_LIMIT, attempt
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.hints import MISSING_RETURN, hint, kind_of, known_mistake
from courseware.lessons.kit.mistakes import EditError, read_hints
from courseware.lessons.kit.show_progress import update_page
from courseware.lessons.kit.student_record import record_check, record_folder
from courseware.lessons.kit.values import agree, agree_all

PACKAGES = {"lesson": "", "foundation": "F", "project": "P"}  # a package's kind -> the letter of its number
MAX_SHOWN = 1000  # characters of a function's printed text; only the first call's text is shown


class Verdict(NamedTuple):
    """The result of a check: its status, the message, and the text that the function `printed` in its first call."""

    status: Literal["not attempted", "right", "wrong"]
    message: str
    printed: str = ""


SIGNS = {"right": ("\u2713", 32), "wrong": ("\u2717", 31)}  # and their colours, by number (ANSI)

SEE_CHECK = "Not right. The exercise's own check in the notebook says more."
NOT_ATTEMPTED = Verdict("not attempted", "not attempted yet. Replace the `...` above, then run both cells.")


class UnknownExerciseError(LookupError):
    """No exercise has this number."""


def check(number: str, function: Callable) -> None:
    """Print whether `function` solves exercise `number`: not attempted, right, or not yet with a hint."""
    verdict = judge(find_exercise(number), function)
    said, tries = "", 0
    if record_folder() is not None:
        try:
            said, tries = record_check(number, verdict.status)
        except OSError as error:
            said = f"not kept: {error}"
    show_printed(verdict.printed)
    print(f"{number}: {signed(verdict)}" + (f" (try {tries})" if tries else ""))
    if said:
        print(f"({said})")
    update_page()


def signed(verdict: Verdict) -> str:
    """Return a verdict's message. In a notebook, an answer has its sign, in a colour of JupyterLab's theme."""
    if verdict.status not in SIGNS or not type(sys.stdout).__module__.startswith("ipykernel"):
        return verdict.message
    sign, colour = SIGNS[verdict.status]
    first, stop, rest = verdict.message.partition(".")
    return f"\x1b[1;{colour}m{sign} {first}\x1b[0m{stop}{rest}"


def show_printed(text: str) -> None:
    """Print the text that a student's function printed, if there is any."""
    if text:
        print(f"(your function prints) {text[:MAX_SHOWN].rstrip()}")


def find_exercise(number: str) -> Exercise:
    """Return the exercise of this number. Raises `UnknownExerciseError`, which lists all numbers."""
    lesson = str(number).partition(".")[0]
    for exercise in lesson_exercises(lesson):
        if exercise.number == number:
            return exercise
    known = [exercise.number for name in lesson_numbers() for exercise in lesson_exercises(name)]
    raise UnknownExerciseError(f"there is no exercise {number!r}; there are {', '.join(known)}")


def lesson_numbers() -> list[str]:
    """Return the numbers ("03") of the lessons with exercises, and the names of foundations ("F1") and projects."""
    found = (re.fullmatch(r"([a-z]+)_(\d+)\.py", path.name) for path in answers_folder().iterdir())
    return sorted(PACKAGES[match[1]] + match[2] for match in found if match)


def answers_folder() -> Traversable:
    """Return the folder `courseware/answers`, which is packed into one file in a student's copy of the course."""
    return resources.files("courseware.answers")


def package_name(number: str) -> str:
    """Return the folder's name of a lesson ("03": lesson_03), foundation ("F1": foundation_1) or project ("P1")."""
    kind = next((kind for kind, letter in PACKAGES.items() if letter and number.startswith(letter)), "lesson")
    return f"{kind}_{number.removeprefix(PACKAGES[kind])}"


@functools.cache
def lesson_exercises(lesson: str) -> tuple[Exercise, ...]:
    """Return the exercises of lesson "03" or foundation "F1", or the stages of "P1", with their hints; () if none."""
    if lesson not in lesson_numbers():
        return ()
    exercises = importlib.import_module(f"courseware.answers.{package_name(lesson)}").EXERCISES
    hints = read_hints(path := answers_folder() / f"{package_name(lesson)}.hints")
    if unknown := set(hints) - {exercise.number for exercise in exercises}:
        raise EditError(f"{path.name}: there is no exercise {', '.join(unknown)}. Correct the heading in brackets.")
    return tuple(replace(exercise, mistakes=hints.get(exercise.number, "")) for exercise in exercises)


def judge(exercise: Exercise, function: Callable, seed: int = 0, seconds: float = TIME_LIMIT) -> Verdict:
    """Run `function` on inputs drawn with `seed` and return the verdict. seconds: time limit of one call."""
    if not callable(function):
        return _wrong(f"Give the function itself, without calling it; this is a {kind_of(function)}.")
    if is_stub(function):
        return NOT_ATTEMPTED
    arguments = exercise.draw(np.random.default_rng(seed))
    answers, printed = [], ""
    for index, given in enumerate(arguments):
        call = attempt(function, used := copy.deepcopy(given), seconds)
        printed = printed if index else call.printed
        if call.failure is not None:
            return _wrong(f"Your function {call.failure}", printed)
        if call.value is ...:
            return NOT_ATTEMPTED
        if not same_values(used, given):
            return _wrong("Your function changes the array it was given: work on a new one.", printed)
        answers.append(call.value)
    sentence = fault(exercise, arguments, answers)
    return Verdict("right", "right.", printed) if sentence is None else _wrong(sentence, printed)


def right_on(exercise: Exercise, arguments: list[tuple], answers: list) -> list[bool]:
    """Return for each input whether the answer is right, so that a partly right function gets part of the points.

    All answers are compared with one function: the solution, or the function of `exercise.others` that agrees with
    more of them. An answer of None is wrong. The arguments are not changed.
    """
    pairs = list(zip(arguments, answers, strict=True))
    if exercise.verify is not None:
        return [a is not None and exercise.verify(copy.deepcopy(given), a) is None for given, a in pairs]
    allowed = (exercise.solution, *exercise.others)
    found = [[agree(a, f(*copy.deepcopy(given)), exercise.tolerance) for given, a in pairs] for f in allowed]
    return max(found, key=sum)


def fault(exercise: Exercise, arguments: list[tuple], answers: list, details: bool = True) -> str | None:
    """Return a sentence about a fault in the answers, or None. It shows neither inputs nor right values.

    details: whether it may describe the answers (`hint`). Without them, a sentence of `verify` with a number in it is
    left out, because the number may be a value.
    """
    if exercise.verify is not None:
        for given, answer in zip(arguments, answers, strict=True):
            if answer is None:
                return MISSING_RETURN
            if (sentence := exercise.verify(copy.deepcopy(given), answer)) is not None:
                safe = details or not any(map(str.isdigit, sentence))
                return known_mistake(exercise, arguments, answers) or (sentence if safe else SEE_CHECK)
        return None
    for allowed in (exercise.solution, *exercise.others):
        values = [allowed(*copy.deepcopy(given)) for given in arguments]
        if agree_all(answers, values, exercise.tolerance):
            return None
    return hint(exercise, arguments, answers, details)


def is_stub(function: Callable) -> bool:
    """Return whether the body is still only a docstring and `...`, so that its bytecode only returns None."""
    if not hasattr(function, "__code__"):
        return False
    idle = {"RESUME", "NOP", "LOAD_CONST", "RETURN_CONST", "RETURN_VALUE", "COPY_FREE_VARS"}
    instructions = list(dis.get_instructions(function))
    constants = [i.argval for i in instructions if i.opname in ("LOAD_CONST", "RETURN_CONST")]
    return all(i.opname in idle for i in instructions) and constants == [None]


def same_values(given: tuple, kept: tuple) -> bool:
    """Return whether the arguments after a call equal those before it."""
    pairs = zip(given, kept, strict=True)
    return all(np.array_equal(g, k, equal_nan=np.asarray(k).dtype.kind == "f") for g, k in pairs)


def _wrong(sentence: str, printed: str = "") -> Verdict:
    return Verdict("wrong", f"not yet. {sentence}", printed)
