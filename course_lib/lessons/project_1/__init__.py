"""Project P1, the whole filter from the equations alone: its recordings, its stages, and how it is measured."""

from course_lib.lessons.project_1.figures import frames_figure
from course_lib.lessons.project_1.recordings import CAMERA, PARTICLES, CountedRenderer, recording
