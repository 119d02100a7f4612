"""Lesson 03, GPU scene simulation: its small scenes and what it measures on them, figures and panel."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.kit.box_world import box_map
from courseware.lessons.kit.opengl import vtk
from courseware.lessons.lesson_03.figures import PANELS, SLOPES, agree_figure, buffer_figure, camera_panel
from courseware.lessons.lesson_03.figures import idea_figure, side_view, time_figure, triangle_figure, window_figure
from courseware.lessons.lesson_03.scenes import buffer_step, corridor, corridor_end, seconds_per_view
from courseware.lessons.lesson_03.scenes import slanted_wall_error, views_that_see, wall_with_hole
