"""Project P1, the whole filter from the equations alone: its recordings, its stages, and how it is measured."""

from courseware.lessons.project_1.figures import frames_figure
from courseware.lessons.project_1.recordings import CAMERA, PARTICLES, CountedRenderer, recording
