"""Project P3: a matcher that survives the look-alike sofas."""

from courseware.lessons.project_2.rooms import rooms_of
from courseware.lessons.project_3.figures import view_figure
from courseware.lessons.project_3.tasks import prepare
