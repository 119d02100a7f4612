"""What only the notebooks use: a folder for each lesson with its figures, panel and measurements, and `kit/`.

Every notebook imports from here what it needs to ask, check and show. What belongs to one lesson, it imports from the
module that holds it, such as `courseware.lessons.lesson_06.figures`. CONTRIBUTING.md says what a new lesson needs.
"""

from courseware.lessons.kit.display import show
from courseware.lessons.kit.exercises import check
from courseware.lessons.kit.predictions import predict, recall
from courseware.lessons.kit.progress_bar import progress
from courseware.lessons.kit.scene import show_scene
from courseware.paths import data_path

__all__ = ["check", "data_path", "predict", "progress", "recall", "show", "show_scene"]
