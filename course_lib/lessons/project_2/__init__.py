"""Project P2: from the boxes of two images to a pose."""

from course_lib.lessons.project_2.figures import boxes_figure
from course_lib.lessons.project_2.project import rooms_of
