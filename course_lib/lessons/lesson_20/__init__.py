"""Lesson 20, your own data: a reader's recording or pair of panoramas, else the course's; the ways to misread one."""

from course_lib.lessons.lesson_20.alternative_texts import ALT
from course_lib.lessons.lesson_20.figures import check_figure, track_figure
from course_lib.lessons.lesson_20.own_panoramas import disparity_picture, near_features, panorama_pair
from course_lib.lessons.lesson_20.panel import PANELS, reading_panel
from course_lib.lessons.lesson_20.readings import (
    Checker,
    compare_readings,
    misread_run,
    readings_table,
    recording,
)

__all__ = [
    "ALT",
    "PANELS",
    "Checker",
    "check_figure",
    "compare_readings",
    "disparity_picture",
    "misread_run",
    "near_features",
    "panorama_pair",
    "reading_panel",
    "readings_table",
    "recording",
    "track_figure",
]
