"""Lesson 05, particles and motion: clouds that walk, an oracle that keeps the nearest, their figures and panel."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.lesson_05.simulations import corner_states, wagon_states, walk
from courseware.lessons.lesson_05.figures import PANELS, SCENE_ALT, beliefs_figure, cloud_panel, clouds_figure
from courseware.lessons.lesson_05.figures import corner_figure, spread_figure, trade_figure
