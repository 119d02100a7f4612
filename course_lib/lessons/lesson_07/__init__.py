"""Lesson 07, estimate and resample: means on the circle, four resamplers, the Kalman filter, and the filter stepper."""

from course_lib.lessons.lesson_07.beside_kalman import beside_kalman, best_bells, door_likelihood, wagon_and_laser
from course_lib.lessons.lesson_07.draws import SCHEMES, copies, copies_figure, different_over_rounds, numpy_global_seed
from course_lib.lessons.lesson_07.figures import SCENE_ALT, circle_figure, comb_figure, doors_figure, rounds_figure
from course_lib.lessons.lesson_07.filter_stepper import follow
from course_lib.lessons.lesson_07.panel import PANELS, stepper_panel
