"""Foundation F1, the Bayes filter: a corridor with three niches, the exact belief, and particles that carry weights."""

# ruff: noqa: I001 (short lines)
from course_lib.lessons.foundation_1.corridor import CELL, GRID, WHEN, exact_beliefs, likelihood, misplaced, move
from course_lib.lessons.foundation_1.corridor import record, run, trials
from course_lib.lessons.foundation_1.figures import PANELS, beliefs_figure, corridor_panel, markov_figure, sizes_figure
