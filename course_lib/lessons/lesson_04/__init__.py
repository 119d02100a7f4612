"""Lesson 04, the depth camera: its scene, its faults one by one, figures and panel."""

from course_lib.lessons.lesson_04.alternative_texts import ALT
from course_lib.lessons.lesson_04.figures import (
    idea_figure,
    noise_figure,
    phase_figure,
    recorded_figure,
    two_surfaces_figure,
)
from course_lib.lessons.lesson_04.panel import PANELS, faults_panel
from course_lib.lessons.lesson_04.recorded import kinds_of, on_a_surface, sort_errors, true_depths
from course_lib.lessons.lesson_04.time_of_flight import capture, frames_of, returns, wall

__all__ = [
    "ALT",
    "PANELS",
    "capture",
    "faults_panel",
    "frames_of",
    "idea_figure",
    "kinds_of",
    "noise_figure",
    "on_a_surface",
    "phase_figure",
    "recorded_figure",
    "returns",
    "sort_errors",
    "true_depths",
    "two_surfaces_figure",
    "wall",
]
