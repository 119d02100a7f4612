"""Lesson 08, the corridor experiment: its figures, and a panel that runs the filter along the corridor at once."""

from course_lib.lessons.lesson_08.along import STRETCH
from course_lib.lessons.lesson_08.figures import (
    ALT,
    along_figure,
    as_in_the_paper_figure,
    experiment_figure,
    lost_figure,
    relative_weights_figure,
    two_errors_figure,
)
from course_lib.lessons.lesson_08.panel import PANELS, along_panel
from course_lib.lessons.lesson_08.stored import over_seeds, spread_over_seeds, stored_runs, table_1
