"""Lesson 20, your own data: a reader's recording or pair of panoramas, else the course's; the ways to misread one."""

from courseware.lessons.lesson_20.figures import PANELS, check_figure, disparity_picture, reading_panel, track_figure
from courseware.lessons.lesson_20.own_panoramas import near_features, panorama_pair
from courseware.lessons.lesson_20.recordings import Checker, compare_readings, misread_run, readings_table, recording
