"""Lesson 07, estimate and resample: means on the circle, four resamplers, the Kalman filter, and the filter stepper."""

from course_lib.lessons.lesson_07.alternative_texts import ALT
from course_lib.lessons.lesson_07.beside_kalman import (
    beside_kalman,
    best_bells,
    door_likelihood,
    doors_figure,
    wagon_and_laser,
)
from course_lib.lessons.lesson_07.figures import circle_figure, comb_figure, copies_figure, rounds_figure
from course_lib.lessons.lesson_07.panel import PANELS, stepper_panel
from course_lib.lessons.lesson_07.resampling import (
    SCHEMES,
    copies,
    different_over_rounds,
    follow,
    mean_copies,
    numpy_global_seed,
)

__all__ = [
    "ALT",
    "PANELS",
    "SCHEMES",
    "beside_kalman",
    "best_bells",
    "circle_figure",
    "comb_figure",
    "copies",
    "copies_figure",
    "different_over_rounds",
    "door_likelihood",
    "doors_figure",
    "follow",
    "mean_copies",
    "numpy_global_seed",
    "rounds_figure",
    "stepper_panel",
    "wagon_and_laser",
]
