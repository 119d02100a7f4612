"""Lesson 11, the spherical camera: a panorama and its sphere side by side, a view cut out of it, what seams do."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.kit.room_data import the_image, the_pair
from courseware.lessons.lesson_11.figures import PANELS, all_bearings, bearings_figure, idea_figure, seam_figure
from courseware.lessons.lesson_11.figures import sphere_panel, views_figure
from courseware.lessons.lesson_11.sphere_view import look_up
