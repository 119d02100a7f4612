"""Exercises that answer at once: `check("03.1", function)` says not attempted, right, or wrong with a fitting hint.

An `Exercise` holds what is right (a reference function), how to make inputs, and the mistakes that people really make,
each as a wrong function with the hint that mends it. A student's function runs on several random inputs; its values
are compared with the reference's and, where they differ, with those of every known mistake. Neither the inputs nor the
reference are ever shown. Lesson NN keeps its exercises in `course_lib/lessons/lesson_NN/exercises.py`, as a list
`EXERCISES`.
"""

from __future__ import annotations

import copy
import dis
import importlib
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.lessons.kit.hints import agree, hint, kind_of

# Random inputs per check: enough that a case drawn for one input in five is never missed, save once in 200 checks.
N_INPUTS = 24


@dataclass(frozen=True)
class Mistake:
    """A mistake that people really make: `function` computes what they compute, `hint` says what to look at."""

    function: Callable
    hint: str


@dataclass(frozen=True)
class Exercise:
    """One exercise.

    number: such as "03.1". reference: the right function. inputs: makes one tuple of arguments from a
    `numpy.random.Generator`. mistakes: at least three. tolerance: absolute, plus the same share of the value.
    """

    number: str
    reference: Callable
    inputs: Callable[[np.random.Generator], tuple]
    mistakes: tuple[Mistake, ...]
    tolerance: float = 1e-6


@dataclass(frozen=True)
class Verdict:
    """Outcome of a check: status "not attempted", "right" or "wrong", and the sentence that is printed."""

    status: str
    message: str


class UnknownExerciseError(KeyError):
    """There is no exercise of that number."""

    def __str__(self) -> str:
        return str(self.args[0])


def check(number: str, function: Callable) -> None:
    """Print whether `function` solves exercise `number`: not attempted, right, or not yet with a hint."""
    print(f"{number}: {judge(find_exercise(number), function).message}")


def find_exercise(number: str) -> Exercise:
    """The exercise of that number. Raises `UnknownExerciseError`, which names those that there are."""
    lesson = str(number).partition(".")[0]
    for exercise in lesson_exercises(lesson):
        if exercise.number == number:
            return exercise
    known = [exercise.number for name in lesson_numbers() for exercise in lesson_exercises(name)]
    raise UnknownExerciseError(f"there is no exercise {number!r}; there are {', '.join(known)}")


def lesson_numbers() -> list[str]:
    """Numbers ("03") of the lessons that have exercises, and names ("P1") of the projects, whose stages are such."""
    folders = [path.parent.name for path in Path(__file__).parents[1].glob("*_*/exercises.py")]
    return sorted(name.removeprefix("lesson_").replace("project_", "P") for name in folders)


def lesson_exercises(lesson: str) -> tuple[Exercise, ...]:
    """Exercises of lesson "03" or stages of project "P1"; none where there is no file of exercises."""
    if lesson not in lesson_numbers():
        return ()
    folder = f"project_{lesson[1:]}" if lesson.startswith("P") else f"lesson_{lesson}"
    return tuple(importlib.import_module(f"course_lib.lessons.{folder}.exercises").EXERCISES)


def judge(exercise: Exercise, function: Callable, seed: int = 0) -> Verdict:
    """Verdict on `function`, from its values on `N_INPUTS` inputs drawn with `seed`."""
    if not callable(function):
        return Verdict(
            "wrong", f"not yet. Give the function itself, without calling it; this is a {kind_of(function)}."
        )
    if is_stub(function):
        return _not_attempted()
    rng = np.random.default_rng(seed)
    answers, wanted, arguments = [], [], []
    for _ in range(N_INPUTS):
        given = exercise.inputs(rng)
        kept = copy.deepcopy(given)
        try:
            answer = function(*given)
        except Exception as error:
            return Verdict("wrong", f"not yet. Your function stops with {_describe(error, function)}.")
        if answer is ...:
            return _not_attempted()
        if not _same_values(given, kept):
            return Verdict("wrong", "not yet. Your function changes the array it was given: work on a new one.")
        answers.append(answer)
        wanted.append(exercise.reference(*copy.deepcopy(kept)))
        arguments.append(kept)
    if all(agree(a, w, exercise.tolerance) for a, w in zip(answers, wanted, strict=True)):
        return Verdict("right", "right.")
    return Verdict("wrong", f"not yet. {hint(exercise, arguments, answers, wanted)}")


def is_stub(function: Callable) -> bool:
    """Whether the body is still a docstring and `...` alone: it does nothing but return None."""
    if not hasattr(function, "__code__"):
        return False
    idle = {"RESUME", "NOP", "LOAD_CONST", "RETURN_CONST", "RETURN_VALUE", "COPY_FREE_VARS"}
    instructions = list(dis.get_instructions(function))
    constants = [i.argval for i in instructions if i.opname in ("LOAD_CONST", "RETURN_CONST")]
    return all(i.opname in idle for i in instructions) and constants == [None]


def _same_values(given: tuple, kept: tuple) -> bool:
    pairs = zip(given, kept, strict=True)
    return all(np.array_equal(g, k, equal_nan=np.asarray(k).dtype.kind == "f") for g, k in pairs)


def _describe(error: Exception, function: Callable) -> str:
    """Type and first line of an error, and the line of the student's function where it came up."""
    code = getattr(function, "__code__", None)
    frames = traceback.walk_tb(error.__traceback__)
    lines = [line - code.co_firstlineno + 1 for frame, line in frames if frame.f_code is code]
    where = f" in its line {lines[0]}" if lines else ""
    text = (str(error).splitlines() or [""])[0]
    return f"{type(error).__name__}{where}" + (f": {text}" if text else "")


def _not_attempted() -> Verdict:
    return Verdict("not attempted", "not attempted yet. Replace the `...` above, then run both cells.")
