"""Lesson 07, estimate and resample: means on the circle, four resamplers and a bug in one, and the filter stepper."""

from course_lib.lessons.lesson_07.figures import circle_figure, comb_figure, copies_figure, rounds_figure
from course_lib.lessons.lesson_07.panel import PANELS, stepper_panel
from course_lib.lessons.lesson_07.resampling import (
    SCHEMES,
    copies_of,
    different_over_rounds,
    follow,
    mean_copies,
    numpy_global_seed,
)

__all__ = [
    "PANELS",
    "SCHEMES",
    "circle_figure",
    "comb_figure",
    "copies_figure",
    "copies_of",
    "different_over_rounds",
    "follow",
    "mean_copies",
    "numpy_global_seed",
    "rounds_figure",
    "stepper_panel",
]
