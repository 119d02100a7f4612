"""Lesson 02, a map from a laser scan: a small room's maps and what a camera sees of them, the corridor's map."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.lesson_02.figures import PANELS, corridor_figure, fusion_figure, idea_figure, maps_figure
from courseware.lessons.lesson_02.figures import registration_figure, survey_panel, views_figure
from courseware.lessons.lesson_02.small_room import STATIONS, camera_view, corridor_difference, distance_to_room, fusion
from courseware.lessons.lesson_02.small_room import quality, room_map, row, scans, true_view
