"""Lesson 01, poses and frames: its figures, and a camera that six sliders drive through the corridor."""

from course_lib.lessons.lesson_01.figures import frames_figure, lock_figure, mean_figure, order_figure, turns_figure
from course_lib.lessons.lesson_01.panel import PANELS, drive_panel
from course_lib.lessons.lesson_01.poses import AXES, turn_per_degree
