"""Lesson 06, likelihood and weights: one depth image of the corridor, four likelihoods, and their panel."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.lesson_06.figures import PANELS, SCENE_ALT, cost_figure, likelihood_panel, profiles_figure
from courseware.lessons.lesson_06.figures import terms_figure, weights_figure
from courseware.lessons.lesson_06.forms import FORMS, FRAME, N_PLACES, REACH, cost_of_a_pixel, offsets, peak, peak_table
from courseware.lessons.lesson_06.forms import profile, small_scene, views_along
