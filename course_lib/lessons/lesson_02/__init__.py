"""Lesson 02, a map from a laser scan: what a camera sees of a small room's maps, the corridor's map, figures, panel."""

from course_lib.lessons.lesson_02.figures import (
    corridor_figure,
    fusion_figure,
    idea_figure,
    maps_figure,
    registration_figure,
    views_figure,
)
from course_lib.lessons.lesson_02.panel import PANELS, survey_panel
from course_lib.lessons.lesson_02.small_room import STATIONS, distance_to_room, fusion, quality, room_map, scans
from course_lib.lessons.lesson_02.views import camera_view, corridor_difference, row, shipped_numbers, true_view
