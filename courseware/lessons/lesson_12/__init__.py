"""Lesson 12, detecting objects: a sofa that the seam cuts, thresholds, and the hue and saturation of a box."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.kit.progress_bar import progress
from courseware.lessons.kit.room_data import the_image
from courseware.lessons.lesson_12.figures import PANELS, crops_figure, hue_panel, idea_figure, seam_panel
from courseware.lessons.lesson_12.figures import threshold_figure, training_figure
from courseware.lessons.lesson_12.measures import anchors, colours_against_map, hues_and_saturations, training_picture
from courseware.lessons.lesson_12.measures import cut_counts, cut_sofa, cut_table, precision_and_recall
from courseware.lessons.lesson_12.measures import said_of_the_sofa, true_object
