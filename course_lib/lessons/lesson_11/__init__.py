"""Lesson 11, the spherical camera: a panorama and its sphere side by side, a view cut out of it, what seams do."""

from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_11.alternative_texts import ALT
from course_lib.lessons.lesson_11.figures import bearings_figure, idea_figure, seam_figure, views_figure
from course_lib.lessons.lesson_11.panel import PANELS, sphere_panel
from course_lib.lessons.lesson_11.views import all_bearings, look_up, object_at_the_seam, scene

__all__ = [
    "ALT",
    "PANELS",
    "all_bearings",
    "bearings_figure",
    "idea_figure",
    "look_up",
    "object_at_the_seam",
    "scene",
    "seam_figure",
    "sphere_panel",
    "the_image",
    "views_figure",
]
