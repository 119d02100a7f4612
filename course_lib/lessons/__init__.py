"""What only the notebooks use: figures, panels, exercise checks and each lesson's plumbing.

`paths` finds the data, `figures` and `live_figure` draw, `panel` and `progress_bar` are the moving parts, `exercises`
judges answers. `lesson_NN` holds a lesson's scenes, figures and panels (`PANELS`: title -> function that makes it),
`exercises_NN` its exercises (`EXERCISES`). A lesson's methods are never here: they are in `course_lib.depth_mcl`.
"""

from course_lib.lessons.exercises import check
from course_lib.lessons.figures import show
from course_lib.lessons.paths import data_path
from course_lib.lessons.progress_bar import progress

__all__ = ["check", "data_path", "progress", "show"]
