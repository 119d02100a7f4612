"""What only the notebooks use: each lesson's figures, panel and exercises, and what several of them share.

`kit/` holds what several lessons share: `predictions` asks before and shows again after, `exercises` judges answers,
`student_record` keeps both for the student, `lesson_progress` counts them and `progress_page` shows them, `projects`
scores what a project ends in, `panel`, `live_figure` and `progress_bar` are the moving parts, `display` shows a figure,
`scene` a scene in three dimensions, and `room_photographs`, `panorama_features`, `room_observations` and
`corridor_views` load what more than one lesson looks at. A lesson's methods are never here: they are in
`course_lib.depth_mcl` and `course_lib.spherical_stereo`; figures and objects of scenes that commands draw too are in
`course_lib.plots`.

A new lesson NN is a notebook and a folder:

* `notebooks/NN_title.ipynb`, its cells with ids "NN-something"; the parts and their order are what
  tests/notebooks/test_shape.py checks. The five cells of an exercise share `metadata.exercise = "NN.1"` and have one of
  the tags task, exercise (the stub), check, hint, solution (with `metadata.jupyter.source_hidden = true`).
* `lessons/lesson_NN/`, of which the notebook imports the package alone:
  `__init__.py` hands on what the notebook calls as `lesson_NN.something`, and `PANELS`.
  `figures.py`: a figure comes from `figures.new_figure` and goes to `show(figure, alt=lesson_NN.ALT["name"])`.
  `alternative_texts.py`: `ALT`, what each figure shows, by name; out of the cells, where it would give answers away.
  A scene comes from `plots.scenes.new_plotter`, the notebook's own cell adds what is seen (`plots.scenes`,
  `kit.scene_objects`, PyVista), and it goes to `show_scene(plotter, "NN_name", title=..., alt=...)`.
  `panel.py`: `PANELS = {title: function that makes the panel}`; its figure is a `LiveFigure`, its `draw` a plain
  function of the controls' values that returns a `Drawing`.
  `exercises.py`: `EXERCISES`, each with a reference, an input generator and three mistakes or more with their hints.
  What the three share (scenes, data, what is measured) has modules of its own, named after what they hold.

A project n is `notebooks/projects/Pn_title.ipynb` and `lessons/project_n/`: `exercises.py` as above, for its stages,
and `project.py` with its `PROJECT` (`kit/projects.py`); tests/notebooks/test_projects.py checks its parts. Its model
solution stands apart, in `notebooks/projects/solutions/`, and its rivals' numbers in data/projects/.

Then `.venv/bin/python -m tools.refresh NN` runs the notebook and stores its outputs. The tests find all of it by the
names.
"""

from course_lib.lessons.kit.display import show
from course_lib.lessons.kit.exercises import check
from course_lib.lessons.kit.predictions import predict, recall
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.scene import show_scene
from course_lib.paths import data_path

__all__ = ["check", "data_path", "predict", "progress", "recall", "show", "show_scene"]
