"""Project P2: from the boxes of two images to a pose."""

from courseware.lessons.project_2.figures import boxes_figure
from courseware.lessons.project_2.rooms import rooms_of
