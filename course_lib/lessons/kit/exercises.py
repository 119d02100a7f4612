"""Exercises that answer at once: `check("03.1", function)` says not attempted, right, or wrong with a fitting hint.

An `Exercise` holds what is right (a reference function), how to make inputs, and the mistakes that people really make,
each as a wrong function with the hint that mends it. A student's function runs on the cases that matter and on several
random inputs; its values are compared with the reference's and, where they differ, with those of every known mistake.
Neither the inputs nor the reference are ever shown. Lesson NN keeps its exercises in
`course_lib/lessons/lesson_NN/exercises.py`, as a list `EXERCISES`.
"""

from __future__ import annotations

import copy
import dis
import importlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from course_lib.lessons.kit.attempt import SECONDS, attempt
from course_lib.lessons.kit.hints import MISSING_RETURN, agree, agree_all, hint, kind_of, known_mistake
from course_lib.lessons.kit.progress_page import bring_up_to_date
from course_lib.lessons.kit.student_record import record_check, record_folder

# Random inputs per check: enough that a case drawn for one input in five is never missed, save once in 200 checks.
N_INPUTS = 24
SHOWN = 1000
"""Characters shown of what a student's function prints; the first call's alone."""

Level = Literal["warm-up", "core", "challenge"]


@dataclass(frozen=True)
class Mistake:
    """A mistake that people really make: `function` computes what they compute, `hint` says what to look at.

    others: the same mistake made in other ways, whose values differ.
    """

    function: Callable
    hint: str
    others: tuple[Callable, ...] = ()

    @property
    def functions(self) -> tuple[Callable, ...]:
        """Every way in which the mistake is made."""
        return (self.function, *self.others)


@dataclass(frozen=True)
class Exercise:
    """One exercise.

    number: such as "03.1". reference: the right function. inputs: makes one tuple of arguments from a
    `numpy.random.Generator`. mistakes: at least three. tolerance: absolute, plus the same share of the value.
    level: how hard it is. cases: like `inputs`, each drawn once in every check: the seam, the mirror image, the empty,
    the equal and the extreme case. others: other functions that the task allows, such as another estimator.
    verify: where many answers are right, `verify(arguments, answer)` tells what is wrong with one, or None, instead of
    a comparison with the reference's.
    """

    number: str
    reference: Callable
    inputs: Callable[[np.random.Generator], tuple]
    mistakes: tuple[Mistake, ...]
    tolerance: float = 1e-6
    level: Level = "core"
    cases: tuple[Callable[[np.random.Generator], tuple], ...] = ()
    others: tuple[Callable, ...] = ()
    verify: Callable[[tuple, object], str | None] | None = None

    def draw(self, rng: np.random.Generator) -> list[tuple]:
        """Arguments of every call of one check: the cases, then `N_INPUTS` random ones."""
        return [make(rng) for make in (*self.cases, *[self.inputs] * N_INPUTS)]


@dataclass(frozen=True)
class Verdict:
    """Outcome of a check, the sentence that is printed, and what the function itself `printed` in its first call."""

    status: Literal["not attempted", "right", "wrong"]
    message: str
    printed: str = ""


class UnknownExerciseError(KeyError):
    """There is no exercise of that number."""

    def __str__(self) -> str:
        return str(self.args[0])


def check(number: str, function: Callable) -> None:
    """Print whether `function` solves exercise `number`: not attempted, right, or not yet with a hint."""
    verdict = judge(find_exercise(number), function)
    if verdict.printed:
        print(f"(your function prints) {verdict.printed[:SHOWN].rstrip()}")
    print(f"{number}: {verdict.message}")
    if record_folder() is not None:
        try:
            if said := record_check(number, verdict.status):
                print(f"({said})")
        except OSError as error:
            print(f"(not kept: {error})")
        bring_up_to_date()


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


def judge(exercise: Exercise, function: Callable, seed: int = 0, seconds: float = SECONDS) -> Verdict:
    """Verdict on `function`, from its values on inputs drawn with `seed`; one call may take so many `seconds`."""
    if not callable(function):
        return _wrong(f"Give the function itself, without calling it; this is a {kind_of(function)}.")
    if is_stub(function):
        return _not_attempted()
    arguments = exercise.draw(np.random.default_rng(seed))
    answers, printed = [], ""
    for index, given in enumerate(arguments):
        call = attempt(function, used := copy.deepcopy(given), seconds)
        printed = printed if index else call.printed
        if call.failure is not None:
            return _wrong(f"Your function {call.failure}", printed)
        if call.value is ...:
            return _not_attempted()
        if not same_values(used, given):
            return _wrong("Your function changes the array it was given: work on a new one.", printed)
        answers.append(call.value)
    sentence = fault(exercise, arguments, answers)
    return Verdict("right", "right.", printed) if sentence is None else _wrong(sentence, printed)


def right_on(exercise: Exercise, arguments: list[tuple], answers: list) -> list[bool]:
    """For each input whether the answer is right: the reference's, or that of the one other function that fits best.

    An answer of None is wrong. The arguments are not changed. What is partly right can so be told from what is wrong.
    """
    if exercise.verify is not None:
        return [
            answer is not None and exercise.verify(copy.deepcopy(given), answer) is None
            for given, answer in zip(arguments, answers, strict=True)
        ]
    return max(
        (
            [
                agree(a, allowed(*copy.deepcopy(given)), exercise.tolerance)
                for given, a in zip(arguments, answers, strict=True)
            ]
            for allowed in (exercise.reference, *exercise.others)
        ),
        key=sum,
    )


def fault(exercise: Exercise, arguments: list[tuple], answers: list) -> str | None:
    """What is wrong with the answers, in a sentence that shows neither inputs nor right values; None: nothing is."""
    return _verified(exercise, arguments, answers) if exercise.verify else _compared(exercise, arguments, answers)


def _compared(exercise: Exercise, arguments: list[tuple], answers: list) -> str | None:
    """None where the answers are those of the reference or of another function that the task allows, else a hint."""
    wanted = [exercise.reference(*copy.deepcopy(given)) for given in arguments]
    if agree_all(answers, wanted, exercise.tolerance):
        return None
    for other in exercise.others:
        if agree_all(answers, [other(*copy.deepcopy(given)) for given in arguments], exercise.tolerance):
            return None
    return hint(exercise, arguments, answers, wanted)


def _verified(exercise: Exercise, arguments: list[tuple], answers: list) -> str | None:
    """A known mistake's hint, or what `verify` says of the first answer that it refuses; None where it refuses none."""
    for given, answer in zip(arguments, answers, strict=True):
        if answer is None:
            return MISSING_RETURN
        if (sentence := exercise.verify(copy.deepcopy(given), answer)) is not None:
            return known_mistake(exercise, arguments, answers) or sentence
    return None


def is_stub(function: Callable) -> bool:
    """Whether the body is still a docstring and `...` alone: it does nothing but return None."""
    if not hasattr(function, "__code__"):
        return False
    idle = {"RESUME", "NOP", "LOAD_CONST", "RETURN_CONST", "RETURN_VALUE", "COPY_FREE_VARS"}
    instructions = list(dis.get_instructions(function))
    constants = [i.argval for i in instructions if i.opname in ("LOAD_CONST", "RETURN_CONST")]
    return all(i.opname in idle for i in instructions) and constants == [None]


def same_values(given: tuple, kept: tuple) -> bool:
    """Whether arguments after a call are what they were before it."""
    pairs = zip(given, kept, strict=True)
    return all(np.array_equal(g, k, equal_nan=np.asarray(k).dtype.kind == "f") for g, k in pairs)


def _wrong(sentence: str, printed: str = "") -> Verdict:
    return Verdict("wrong", f"not yet. {sentence}", printed)


def _not_attempted() -> Verdict:
    return Verdict("not attempted", "not attempted yet. Replace the `...` above, then run both cells.")
