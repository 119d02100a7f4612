"""Lesson 06, likelihood and weights: one depth image of the corridor, four likelihoods, and their panel."""

from course_lib.lessons.lesson_06.figures import SCENE_ALT, cost_figure, profiles_figure, terms_figure, weights_figure
from course_lib.lessons.lesson_06.forms import FORMS, cost_of_a_pixel, peak, peak_table, profile
from course_lib.lessons.lesson_06.panel import PANELS, likelihood_panel
from course_lib.lessons.lesson_06.places import FRAME, N_PLACES, REACH, offsets, small_scene, views_along
