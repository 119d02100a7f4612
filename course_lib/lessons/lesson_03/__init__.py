"""Lesson 03, GPU scene simulation: its small scenes, figures and panel."""

from course_lib.lessons.kit.box_world import box_map
from course_lib.lessons.lesson_03.alternative_texts import ALT
from course_lib.lessons.lesson_03.figures import buffer_figure, idea_figure, time_figure, window_figure
from course_lib.lessons.lesson_03.measurements import buffer_step, seconds_per_view, slanted_wall_error, views_that_see
from course_lib.lessons.lesson_03.panel import PANELS, camera_panel
from course_lib.lessons.lesson_03.scenes import SLOPES, corridor, corridor_end, pole_ahead, side_view, wall_with_hole
from course_lib.plots.figures import depth_images

__all__ = [
    "ALT",
    "PANELS",
    "SLOPES",
    "box_map",
    "buffer_figure",
    "buffer_step",
    "camera_panel",
    "corridor",
    "corridor_end",
    "depth_images",
    "idea_figure",
    "pole_ahead",
    "seconds_per_view",
    "side_view",
    "slanted_wall_error",
    "time_figure",
    "views_that_see",
    "wall_with_hole",
    "window_figure",
]
