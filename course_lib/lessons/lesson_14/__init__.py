"""Lesson 14, triangulation: how noise of two directions becomes an ellipse, and two distances of every object."""

from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.kit.room_photographs import pair_of, room_map, room_recording
from course_lib.lessons.lesson_14.alternative_texts import ALT
from course_lib.lessons.lesson_14.figures import (
    ellipse_figure,
    errors_figure,
    growth_figure,
    places_figure,
    triangle_figure,
)
from course_lib.lessons.lesson_14.noise import PIXEL, directions_to, noisy_directions, sampled_places
from course_lib.lessons.lesson_14.panel import PANELS, triangulation_panel
from course_lib.lessons.lesson_14.ranges import (
    PLACES,
    azimuth_gaps,
    both_ranges,
    cuboid_range,
    error_texts,
    exact_box_ranges,
    places_in_room,
    places_in_space,
    ranges_of_one_object,
)

__all__ = [
    "ALT",
    "PANELS",
    "PIXEL",
    "PLACES",
    "azimuth_gaps",
    "both_ranges",
    "cuboid_range",
    "directions_to",
    "ellipse_figure",
    "error_texts",
    "errors_figure",
    "exact_box_ranges",
    "growth_figure",
    "noisy_directions",
    "pair_of",
    "places_figure",
    "places_in_room",
    "places_in_space",
    "ranges_of_one_object",
    "room_map",
    "room_recording",
    "sampled_places",
    "scene",
    "triangle_figure",
    "triangulation_panel",
]
