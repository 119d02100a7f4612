"""Lesson 07, estimate and resample: means on the circle, four resamplers, the Kalman filter, and the filter stepper."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.lesson_07.figures import SCENE_ALT, circle_figure, comb_figure, copies_figure, doors_figure
from courseware.lessons.lesson_07.figures import rounds_figure
from courseware.lessons.lesson_07.filter_stepper import PANELS, follow, stepper_panel
from courseware.lessons.lesson_07.simulations import SCHEMES, beside_kalman, best_bells, copies, different_over_rounds
from courseware.lessons.lesson_07.simulations import door_likelihood, numpy_global_seed, wagon_and_laser
