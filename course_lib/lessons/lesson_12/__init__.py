"""Lesson 12, detecting objects: a sofa that the seam cuts, thresholds, and the hue and saturation of a box."""

from course_lib.lessons.kit.room_photographs import the_image
from course_lib.lessons.lesson_12.colours import colours_against_map, crops_figure, hues_and_saturations
from course_lib.lessons.lesson_12.learning import anchors, training_figure, training_picture
from course_lib.lessons.lesson_12.panel import PANELS
from course_lib.lessons.lesson_12.seam_cuts import cut_counts, cut_sofa, cut_sofas, cut_table, idea_figure
from course_lib.lessons.lesson_12.seam_cuts import detector, said_of_the_sofa, true_object
from course_lib.lessons.lesson_12.thresholds import precision_and_recall, threshold_figure
