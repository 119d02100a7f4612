"""Project P3: a matcher that survives the look-alike sofas."""

from course_lib.lessons.project_2.rooms import rooms_of
from course_lib.lessons.project_3.figures import view_figure
from course_lib.lessons.project_3.project import prepare
