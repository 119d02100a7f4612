"""Lesson 01, poses and frames: its figures, and a camera that six sliders drive through the corridor."""

from course_lib.lessons.lesson_01.alternative_texts import ALT
from course_lib.lessons.lesson_01.figures import frames_figure, lock_figure, mean_figure, turns_figure
from course_lib.lessons.lesson_01.panel import PANELS, drive_panel
from course_lib.lessons.lesson_01.poses import AXES, matrix_text, turn_per_degree
from course_lib.plots.figures import depth_images

__all__ = [
    "ALT",
    "AXES",
    "PANELS",
    "depth_images",
    "drive_panel",
    "frames_figure",
    "lock_figure",
    "matrix_text",
    "mean_figure",
    "turn_per_degree",
    "turns_figure",
]
