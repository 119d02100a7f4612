"""Project P1, the whole filter from the equations alone: its recordings, its stages, and what it is measured by."""

from course_lib.lessons.project_1.alternative_texts import ALT
from course_lib.lessons.project_1.figures import frames_figure
from course_lib.lessons.project_1.recordings import CAMERA, PARTICLES, CountedRenderer, recording

__all__ = ["ALT", "CAMERA", "PARTICLES", "CountedRenderer", "frames_figure", "recording"]
