"""Lesson 13, matching two spheres: one object of the upper panorama, its band and its matches in the lower one."""

from course_lib.lessons.kit.panorama_features import scene
from course_lib.lessons.kit.room_photographs import pair_of
from course_lib.lessons.lesson_13.figures import counts_figure, idea_figure, matched_figure
from course_lib.lessons.lesson_13.matching import PLACES, WAYS, matches_when_turned, object_names, score
from course_lib.lessons.lesson_13.panel import PANELS, matching_panel
from course_lib.lessons.lesson_13.scenes import SPHERES, half_circle, upright_plane
from course_lib.lessons.lesson_13.turned import negative_scene, plain_object, turned_scene
