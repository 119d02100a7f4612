"""Lesson 14, triangulation: how noise of two directions becomes an ellipse, and two distances of every object."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.kit.room_data import scene
from courseware.lessons.kit.room_data import pair_of, room_map, room_recording
from courseware.lessons.lesson_14.figures import PANELS, PIXEL, directions_to, noisy_directions, sampled_places
from courseware.lessons.lesson_14.figures import ellipse_figure, errors_figure, growth_figure, places_figure
from courseware.lessons.lesson_14.figures import triangle_figure, triangulation_panel
from courseware.lessons.lesson_14.room_ranges import PLACES, azimuth_gaps, both_ranges, cuboid_range, error_texts
from courseware.lessons.lesson_14.room_ranges import exact_box_ranges, places_in_space, ranges_of_one_object
