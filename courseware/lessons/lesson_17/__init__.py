"""Lesson 17, the room experiment: its places, which poses fail, and a panel that hides objects from the camera."""

from courseware.lessons.kit.room_data import room_map, room_recording
from courseware.lessons.lesson_17.figures import PANELS, judge_panel, outcomes_figure, places_figure, rates_figure
