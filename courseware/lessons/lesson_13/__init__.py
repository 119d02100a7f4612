"""Lesson 13, matching two spheres: one object of the upper panorama, its band and its matches in the lower one."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.kit.room_data import scene
from courseware.lessons.kit.room_data import pair_of
from courseware.lessons.lesson_13.figures import PANELS, counts_figure, half_circle, idea_figure
from courseware.lessons.lesson_13.figures import matching_panel, upright_plane
from courseware.lessons.lesson_13.matching import PLACES, WAYS, matches_when_turned, negative_scene, object_names
from courseware.lessons.lesson_13.matching import plain_object, score, turned_scene
