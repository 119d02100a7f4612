"""Lesson 05, particles and motion: clouds that walk, an oracle that keeps the nearest, their figures and panel."""

from course_lib.lessons.lesson_05.alternative_texts import ALT
from course_lib.lessons.lesson_05.clouds import corner_states, nearest_expected, wagon_states, walk
from course_lib.lessons.lesson_05.figures import (
    beliefs_figure,
    clouds_figure,
    corner_figure,
    spread_figure,
    trade_figure,
)
from course_lib.lessons.lesson_05.panel import PANELS, cloud_panel

__all__ = [
    "ALT",
    "PANELS",
    "beliefs_figure",
    "cloud_panel",
    "clouds_figure",
    "corner_figure",
    "corner_states",
    "nearest_expected",
    "spread_figure",
    "trade_figure",
    "wagon_states",
    "walk",
]
