"""Lesson 00, start here: the corridor's recording beside its map, the panel that looks for eq. (8)'s peak, a room."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.lesson_00.figures import PANELS, covered_figure, filter_figure, hills_figure, idea_figure
from courseware.lessons.lesson_00.figures import pose_panel, room_figure
from courseware.lessons.lesson_00.recorded import FRAME, mean_votes, moment, moved, wall_reads
