"""What an exercise is worth, and what an answer earns: the one rule of every way of grading."""

from collections.abc import Sequence

from course_lib.lessons.kit.exercises import Exercise

POINTS = {"warm-up": 2, "core": 4, "challenge": 6}
"""By the exercise's level; a half of each is a whole number."""


def points_of(exercise: Exercise) -> int:
    """Points of an exercise whose every answer is right."""
    return POINTS[exercise.level]


def earned(exercise: Exercise, right: Sequence[bool]) -> int:
    """Points for the inputs on which the answer is right: all of them, or half for at least half of the inputs.

    A partly right function that is right by chance, or for one case alone, earns nothing.
    """
    share = sum(right) / len(right)
    if share == 1:
        return points_of(exercise)
    return points_of(exercise) // 2 if share >= 0.5 else 0
