"""Lesson 13, matching two spheres: one object of the upper panorama, its band and its matches in the lower one."""

from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.kit.room_photographs import pair_of
from course_lib.lessons.lesson_13.alternative_texts import ALT
from course_lib.lessons.lesson_13.figures import counts_figure, matched_figure, pair_figure
from course_lib.lessons.lesson_13.matching import (
    PLACES,
    WAYS,
    matches_when_turned,
    negative_scene,
    object_names,
    plain_object,
    score,
    turned_scene,
)
from course_lib.lessons.lesson_13.panel import PANELS, matching_panel
from course_lib.lessons.lesson_13.sphere_scene import half_circle, upright_plane

__all__ = [
    "ALT",
    "PANELS",
    "PLACES",
    "WAYS",
    "counts_figure",
    "half_circle",
    "matched_figure",
    "matches_when_turned",
    "matching_panel",
    "negative_scene",
    "object_names",
    "pair_figure",
    "pair_of",
    "plain_object",
    "scene",
    "score",
    "turned_scene",
    "upright_plane",
]
