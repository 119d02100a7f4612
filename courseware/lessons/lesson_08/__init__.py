"""Lesson 08, the corridor experiment: its figures, and a panel that runs the filter along the corridor at once."""

from courseware.lessons.lesson_08 import figures
from courseware.lessons.lesson_08.panel import PANELS, STRETCH, along_panel
from courseware.lessons.lesson_08.stored import over_seeds, spread_over_seeds, stored_runs, table_1
