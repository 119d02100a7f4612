"""Foundation F3, Kalman and fusion: the filter in matrices, estimates that share a past, and a test of honesty."""

# ruff: noqa: I001 (short lines)
from courseware.lessons.foundation_3.figures import PANELS, exchanges_figure, honesty_figure, joins_figure, join_panel
from courseware.lessons.foundation_3.figures import update_figure
from courseware.lessons.foundation_3.fusion import F, H, JOINS, Q, R, START, START_COVARIANCE, band, join, sees, wagon
from courseware.lessons.foundation_3.fusion import covariance_intersection, kalman_predict, kalman_update
