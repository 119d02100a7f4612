"""Lesson 01, poses and frames: its figures, and a camera that six sliders drive through the corridor."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.lesson_01.figures import AXES, PANELS, drive_panel, frames_figure, lock_figure, mean_figure
from courseware.lessons.lesson_01.figures import order_figure, turn_per_degree, turns_figure
