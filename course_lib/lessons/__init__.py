"""What only the notebooks use: figures, panels, exercise checks and each lesson's plumbing.

`paths` finds the data, `figures` and `live_figure` draw, `panel` and `progress_bar` are the moving parts, `exercises`
judges answers. A lesson's methods are never here: they are in `course_lib.depth_mcl`.

A new lesson NN is three files:

* `notebooks/NN_title.ipynb`, its cells with ids "NN-something"; the parts and their order are what
  tests/notebooks/test_shape.py checks. The five cells of an exercise share `metadata.exercise = "NN.1"` and have one of
  the tags task, exercise (the stub), check, hint, solution (with `metadata.jupyter.source_hidden = true`).
* `lesson_NN.py`: scenes, figures and panels, with `PANELS = {title: function that makes the panel}`. A figure comes
  from `figures.new_figure` and goes to `show(figure, alt=...)`; a panel's figure is a `LiveFigure`, its `draw` a plain
  function of the controls' values that returns a `Drawing`.
* `exercises_NN.py`: `EXERCISES`, each with a reference, an input generator and three mistakes or more with their hints.

Then `python3 course.py refresh NN` runs the notebook and stores its outputs. The tests find all three by their names.
"""

from course_lib.lessons.kit.exercises import check
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.kit.progress_bar import progress
from course_lib.plots.figures import show

__all__ = ["check", "data_path", "progress", "show"]
