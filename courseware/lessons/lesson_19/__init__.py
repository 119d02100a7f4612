"""Lesson 19, both papers in one world: a robot put anywhere in a room, its two sensors, and who helps whom."""

from courseware.lessons.lesson_19.figures import (
    basin_figure,
    named_together,
    sensors_figure,
    stages_figure,
    starts_figure,
)
from courseware.lessons.lesson_19.panel import PANELS, anywhere_panel
from courseware.lessons.lesson_19.stages import (
    journey,
    misplaced,
    plane_error,
    random_places,
    state_error,
    stored_result,
    turn_and_look,
    world,
)
