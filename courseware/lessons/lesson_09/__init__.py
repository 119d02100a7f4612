"""Lesson 09, six degrees of freedom: why 200 particles are lost, and the ideas that make it work."""

from courseware.lessons.lesson_09 import figures
from courseware.lessons.lesson_09.panel import PANELS, refinement_panel
from courseware.lessons.lesson_09.stored import ablation, each_recording, stored_table
from courseware.lessons.lesson_09.trials import FRAMES, SEED, cloud_density, drawn, localize, measure_basin, slide
