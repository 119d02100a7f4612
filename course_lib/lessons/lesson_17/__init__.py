"""Lesson 17, the room experiment: its places, which poses fail, and a panel that hides objects from the camera."""

from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_17.alternative_texts import ALT
from course_lib.lessons.lesson_17.experiments import (
    KINDS,
    exact_results,
    failing_places,
    live_places,
    table_1,
)
from course_lib.lessons.lesson_17.figures import outcomes_figure, places_figure, rates_figure
from course_lib.lessons.lesson_17.panel import PANELS, judge_panel
from course_lib.lessons.lesson_17.room_runs import (
    errors,
    rates,
    stored_rooms,
    table_3_or_4,
    table_5,
    two_heights,
    used_pairs,
)

__all__ = [
    "ALT",
    "KINDS",
    "PANELS",
    "errors",
    "exact_results",
    "failing_places",
    "judge_panel",
    "live_places",
    "outcomes_figure",
    "places_figure",
    "rates",
    "rates_figure",
    "room_map",
    "room_recording",
    "stored_rooms",
    "table_1",
    "table_3_or_4",
    "table_5",
    "two_heights",
    "used_pairs",
]
