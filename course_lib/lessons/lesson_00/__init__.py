"""Lesson 00, start here: the corridor's recording beside its map, the panel that looks for eq. (8)'s peak, a room."""

from course_lib.lessons.lesson_00.figures import covered_figure, filter_figure, hills_figure, idea_figure, room_figure
from course_lib.lessons.lesson_00.panel import PANELS, pose_panel
from course_lib.lessons.lesson_00.recorded import FRAME, mean_votes, moment, moved, wall_reads
