"""Lesson 19, both papers in one world: a robot put anywhere in a room, its two sensors, and who helps whom."""

from course_lib.lessons.lesson_19.alternative_texts import ALT
from course_lib.lessons.lesson_19.figures import (
    basin_figure,
    named_together,
    sensors_figure,
    stages_figure,
    starts_figure,
    wall_figure,
)
from course_lib.lessons.lesson_19.panel import PANELS, anywhere_panel
from course_lib.lessons.lesson_19.stages import journey, plane_error, state_error
from course_lib.lessons.lesson_19.trials import misplaced, random_places, stored_result, turn_and_look
from course_lib.lessons.lesson_19.world import world

__all__ = [
    "ALT",
    "PANELS",
    "anywhere_panel",
    "basin_figure",
    "journey",
    "misplaced",
    "named_together",
    "plane_error",
    "random_places",
    "sensors_figure",
    "stages_figure",
    "starts_figure",
    "state_error",
    "stored_result",
    "turn_and_look",
    "wall_figure",
    "world",
]
