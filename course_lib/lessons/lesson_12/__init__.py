"""Lesson 12, detecting objects: a sofa that the seam cuts, thresholds, and the hue and saturation of a box."""

from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_12.alternative_texts import ALT
from course_lib.lessons.lesson_12.figures import crops_figure, hues_and_saturations, idea_figure, threshold_figure
from course_lib.lessons.lesson_12.learning import anchors, training_figure, training_picture
from course_lib.lessons.lesson_12.panel import PANELS
from course_lib.lessons.lesson_12.scores import colours_against_map, precision_and_recall
from course_lib.lessons.lesson_12.seam_cuts import (
    chosen_threshold,
    cut_counts,
    cut_sofa,
    cut_sofas,
    cut_table,
    detector,
    said_of_the_sofa,
    true_object,
)

__all__ = [
    "ALT",
    "PANELS",
    "anchors",
    "chosen_threshold",
    "colours_against_map",
    "crops_figure",
    "cut_counts",
    "cut_sofa",
    "cut_sofas",
    "cut_table",
    "detector",
    "hues_and_saturations",
    "idea_figure",
    "precision_and_recall",
    "said_of_the_sofa",
    "the_image",
    "threshold_figure",
    "training_figure",
    "training_picture",
    "true_object",
]
