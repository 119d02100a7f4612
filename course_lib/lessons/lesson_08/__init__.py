"""Lesson 08, the corridor experiment: its figures, and a panel that runs the filter along the corridor at once."""

from course_lib.lessons.lesson_08.along import STRETCH
from course_lib.lessons.lesson_08.figures import (
    along_figure,
    experiment_figure,
    lost_figure,
    relative_weights_figure,
    two_errors_figure,
)
from course_lib.lessons.lesson_08.panel import PANELS, along_panel
from course_lib.lessons.lesson_08.stored_runs import over_seeds, stored_runs, table_1

__all__ = [
    "PANELS",
    "STRETCH",
    "along_figure",
    "along_panel",
    "experiment_figure",
    "lost_figure",
    "over_seeds",
    "relative_weights_figure",
    "stored_runs",
    "table_1",
    "two_errors_figure",
]
