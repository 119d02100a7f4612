"""Lesson 14, triangulation: how noise of two directions becomes an ellipse, and two distances of every object."""

from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.kit.room_photographs import pair_of, room_map, room_recording
from course_lib.lessons.lesson_14.figures import errors_figure, growth_figure, places_figure
from course_lib.lessons.lesson_14.noise import PIXEL, directions_to, noisy_directions, sampled_places
from course_lib.lessons.lesson_14.panel import PANELS, triangulation_panel
from course_lib.lessons.lesson_14.places import SPACE, azimuth_gaps, places_in_space
from course_lib.lessons.lesson_14.ranges import PLACES, both_ranges, error_texts, exact_box_ranges
from course_lib.lessons.lesson_14.sizes import cuboid_range, ranges_of_one_object
from course_lib.lessons.lesson_14.triangle import ellipse_figure, triangle_figure
