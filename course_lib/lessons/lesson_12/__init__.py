"""Lesson 12, detecting objects: a sofa that the seam cuts, thresholds, and the hue and saturation of a box."""

from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_12.figures import crops_figure, idea_figure, threshold_figure, training_figure
from course_lib.lessons.lesson_12.measures import (
    anchors,
    colours_against_map,
    cut_counts,
    cut_sofa,
    cut_table,
    hues_and_saturations,
    precision_and_recall,
    said_of_the_sofa,
    training_picture,
    true_object,
)  # fmt: skip
from course_lib.lessons.lesson_12.panel import PANELS, hue_panel, seam_panel
