"""Lesson 06, likelihood and weights: one depth image of the corridor, four likelihoods, and their panel."""

from course_lib.lessons.lesson_06.alternative_texts import ALT
from course_lib.lessons.lesson_06.figures import cost_figure, profiles_figure, terms_figure, weights_figure
from course_lib.lessons.lesson_06.panel import PANELS, likelihood_panel
from course_lib.lessons.lesson_06.profiles import (
    AXES,
    FORMS,
    FRAME,
    N_PLACES,
    cost_of_a_pixel,
    peak,
    peak_table,
    profile,
    small_scene,
    views_along,
)

__all__ = [
    "ALT",
    "AXES",
    "FORMS",
    "FRAME",
    "N_PLACES",
    "PANELS",
    "cost_figure",
    "cost_of_a_pixel",
    "likelihood_panel",
    "peak",
    "peak_table",
    "profile",
    "profiles_figure",
    "small_scene",
    "terms_figure",
    "views_along",
    "weights_figure",
]
