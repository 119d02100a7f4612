"""Lesson 09, six degrees of freedom: why 200 particles are lost, and four ideas that make it work."""

from course_lib.lessons.lesson_09.alternative_texts import ALT
from course_lib.lessons.lesson_09.bare_corridor import slide
from course_lib.lessons.lesson_09.basin import measure_basin
from course_lib.lessons.lesson_09.clouds import cloud_density
from course_lib.lessons.lesson_09.figures import (
    ablation_figure,
    basin_figure,
    cloud_figure,
    coverage_figure,
    deviations_figure,
    levels_figure,
    look_alike_figure,
    slide_figure,
    tracks_figure,
    weights_figure,
)
from course_lib.lessons.lesson_09.hand import FRAMES, SEED, localize
from course_lib.lessons.lesson_09.panel import PANELS, refinement_panel
from course_lib.lessons.lesson_09.stored import ablation, each_recording, stored_table

__all__ = [
    "ALT",
    "FRAMES",
    "PANELS",
    "SEED",
    "ablation",
    "ablation_figure",
    "basin_figure",
    "cloud_density",
    "cloud_figure",
    "coverage_figure",
    "deviations_figure",
    "each_recording",
    "levels_figure",
    "localize",
    "look_alike_figure",
    "measure_basin",
    "refinement_panel",
    "slide",
    "slide_figure",
    "stored_table",
    "tracks_figure",
    "weights_figure",
]
