"""Foundation F1, the Bayes filter: a corridor with three niches, the exact belief, and particles that carry weights."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.foundation_1.corridor import CELL, GRID, WHEN, exact_beliefs, likelihood, misplaced, move
from courseware.lessons.foundation_1.corridor import record, run, trials
from courseware.lessons.foundation_1.figures import PANELS, beliefs_figure, corridor_panel, markov_figure, sizes_figure
