"""What an exercise is worth and what an answer earns: the one scale of every way of grading."""

import hashlib
from collections.abc import Sequence

from courseware.lessons.kit.exercises import find_exercise
from courseware.lessons.kit.projects import project_names

POINTS = {"warm-up": 2, "core": 4, "challenge": 6}
"""By the exercise's level; a half of each is a whole number."""
SCORE_POINTS = 12
"""Of a project's function in the graded worlds, in addition to its stages."""
BY_HAND = 10
"""Of a project's written part, which the teacher gives."""


def lesson_of(number: str) -> str:
    """Return the lesson or project of exercise "06.1" or of the score of project "P1"."""
    return number.partition(".")[0]


def most_of(number: str) -> int:
    """Return the points of exercise "06.1" or of the score of project "P1", if all is right."""
    return SCORE_POINTS if number in project_names() else POINTS[find_exercise(number).level]


def earned(most: int, right: Sequence[bool]) -> int:
    """Return the points for the inputs on which the answer is right: all of them, or half for at least half of them.

    A function that is right by chance, or for one case alone, earns nothing.
    """
    return most if all(right) else most // 2 if sum(right) >= len(right) / 2 else 0


def secret(seed: int, number: str) -> int:
    """Return the seed of one exercise's inputs: another for each, and none of the course's own."""
    return 1_000_000 + int.from_bytes(hashlib.sha256(f"{seed}/{number}".encode()).digest()[:6], "big")
