"""Lesson 04, the depth camera: its scene, its faults one by one, figures and panel."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.kit.opengl import vtk
from courseware.lessons.lesson_04.figures import PANELS, faults_panel, idea_figure, phase_figure
from courseware.lessons.lesson_04.figures import SCENE_ALT, recorded_figure, two_surfaces_figure
from courseware.lessons.lesson_04.time_of_flight import capture, kinds_of, on_a_surface, returns
from courseware.lessons.lesson_04.time_of_flight import true_depths, wall_frames
