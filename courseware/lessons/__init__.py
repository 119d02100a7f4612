"""Code that only the notebooks use: each lesson's figures, panel and exercises, and the tools in `kit/`.

Several lessons share `kit/`. `predictions` asks for predictions and prints them again beside the results. `exercises`
checks answers, `projects` scores projects, and `statements` says what of a notebook an answer needs. `student_record`
keeps predictions and results, `lesson_progress` counts them, and `show_progress` shows the counts. `display` shows a
figure and `scene` a 3D scene. `panel`, `live_figure` and `progress_bar` are the moving parts. `intervals` prints
medians and shares with their intervals. `room_photographs`, `panorama_features`, `room_observations` and
`corridor_views` load the data of several lessons. The methods are not here but in `course_lib.depth_mcl` and
`course_lib.spherical_stereo`. Figures and scene objects that commands draw too are in `courseware.plots`.

A new lesson NN needs a notebook and a folder:

* `notebooks/NN_title.ipynb`. The ids of its cells are "NN-something". tests/notebooks/test_shape.py checks its parts
  and their order. The five cells of an exercise share `metadata.exercise = "NN.1"`, and each has one of the tags task,
  exercise (the stub), check, hint, solution (with `metadata.jupyter.source_hidden = true`).
* `lessons/lesson_NN/`. The notebook imports only the package itself.
  `__init__.py` exports what the notebook calls as `lesson_NN.something`, and `PANELS`.
  `figures.py`: functions that make a figure with `figures.new_figure` and return `described(figure, "what it shows")`,
  which the notebook hands to `show`. The alternative text is not in the cells, because it may give answers away.
  A scene starts with `plots.scenes.new_plotter`. The notebook's own cell adds the objects (`plots.scenes`,
  `kit.scene_objects`, PyVista) and shows them with `show_scene(plotter, "NN_name", title=...)`. Its
  alternative text is `SCENE_ALT` in `figures.py`.
  There or in `panel.py`: `PANELS = {title: function that makes the panel}`. A panel's figure is a `LiveFigure`. Its
  `draw` is a plain function that takes the controls' values and returns a `Drawing`.
  `exercises.py`: `EXERCISES`, each with a solution, an input generator, and mistakes as edits of it with hints.
  Code that these files share (scenes, data, measurements) has its own modules, named after their contents.

A foundation n needs `notebooks/foundations/Fn_title.ipynb` and `lessons/foundation_n/`, in the same form. The ids of
its cells are "Fn-something".

A project n needs `notebooks/projects/Pn_title.ipynb` and `lessons/project_n/`. Its `exercises.py` holds the stages, as
above, and `project.py` holds `PROJECT` (see `kit/projects.py`). tests/notebooks/test_projects.py checks the parts. The
model solution is in `notebooks/projects/solutions/`, and the rivals' results are in `answers/project_n.json`.

Then `.venv/bin/python -m tools.refresh NN` runs the notebook and stores its outputs. The tests find all files by their
names.
"""

from courseware.lessons.kit.display import show
from courseware.lessons.kit.exercises import check
from courseware.lessons.kit.predictions import predict, recall
from courseware.lessons.kit.progress_bar import progress
from courseware.lessons.kit.scene import show_scene
from courseware.paths import data_path

__all__ = ["check", "data_path", "predict", "progress", "recall", "show", "show_scene"]
