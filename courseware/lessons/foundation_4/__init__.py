"""Foundation F4, two views on spheres: the essential matrix, distance and its error, directions and ranges together."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.foundation_4.figures import PANELS, ellipses_figure, motion_figure, spheres_figure, views_panel
from courseware.lessons.foundation_4.pose_from_sight import informations, pose_errors
from courseware.lessons.foundation_4.two_views import distances, four_motions, motion_errors, random_views, room_views
from courseware.lessons.foundation_4.two_views import shares_in_front, trials
