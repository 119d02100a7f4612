"""Lesson 10, lost and found: a hotel with two rooms alike, kidnappings in it, filters that start anywhere."""

from courseware.lessons.lesson_10 import figures
from courseware.lessons.lesson_10.hotel_floor import (
    CAMERA,
    carried_away,
    carried_next_door,
    hotel_map,
    into_102,
    leaving_101,
)
from courseware.lessons.lesson_10.narrowing import (
    ALPHA,
    BETA,
    RUNS,
    SIGMA,
    coarse,
    coarse_renderer,
    distance_to_either,
    free_space,
    narrow,
    shares,
    start_anywhere,
)
from courseware.lessons.lesson_10.panel import PANELS, alarm_panel, anywhere_panel
from courseware.lessons.lesson_10.trials import KIDNAPPINGS, follow, kidnap, search_run, stored_table
