"""Lesson 18, similar sofas: poses of two matches, what speaks for each, how sure, and when to say nothing."""

from course_lib.lessons.kit.room_observations import room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.lessons.lesson_18.alternative_texts import ALT
from course_lib.lessons.lesson_18.figures import (
    ambiguities_figure,
    few_seen_figure,
    hypotheses_figure,
    matches_figure,
    risk_figure,
    two_places_figure,
    two_ways_figure,
)
from course_lib.lessons.lesson_18.fits import fit_errors
from course_lib.lessons.lesson_18.panel import PANELS, hypotheses_panel
from course_lib.lessons.lesson_18.scenes import (
    FEW_SEEN,
    PAIR,
    ROOM_WITH_PLANT,
    SYMMETRIC_ROOM,
    exact_view,
    surveyed,
    thinned,
    walk_past_the_plant,
)
from course_lib.lessons.lesson_18.stored_answers import shares_line, stored_answers
from course_lib.lessons.lesson_18.trials import (
    GAP_ALONE,
    answers_of_few,
    answers_of_matchers,
    answers_of_two_views,
    answers_on_both_maps,
    at_threshold,
    belief_at,
    half_seen_scenes,
)
from course_lib.lessons.lesson_18.two_matches import both_right, matched_by_colour, matched_by_two

__all__ = [
    "ALT",
    "FEW_SEEN",
    "GAP_ALONE",
    "PAIR",
    "PANELS",
    "ROOM_WITH_PLANT",
    "SYMMETRIC_ROOM",
    "ambiguities_figure",
    "answers_of_few",
    "answers_of_matchers",
    "answers_of_two_views",
    "answers_on_both_maps",
    "at_threshold",
    "belief_at",
    "both_right",
    "exact_view",
    "few_seen_figure",
    "fit_errors",
    "half_seen_scenes",
    "hypotheses_figure",
    "hypotheses_panel",
    "matched_by_colour",
    "matched_by_two",
    "matches_figure",
    "risk_figure",
    "room_map",
    "room_scenes",
    "shares_line",
    "stored_answers",
    "surveyed",
    "thinned",
    "two_places_figure",
    "two_ways_figure",
    "walk_past_the_plant",
]
