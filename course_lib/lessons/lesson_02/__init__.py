"""Lesson 02, a map from a laser scan: a small room's maps and what a camera sees of them, the corridor's map."""

from course_lib.lessons.lesson_02.figures import (
    corridor_figure,
    fusion_figure,
    idea_figure,
    maps_figure,
    registration_figure,
    views_figure,
)
from course_lib.lessons.lesson_02.panel import PANELS, survey_panel
from course_lib.lessons.lesson_02.small_room import (
    STATIONS,
    camera_view,
    corridor_difference,
    distance_to_room,
    fusion,
    quality,
    room_map,
    row,
    scans,
    true_view,
)
