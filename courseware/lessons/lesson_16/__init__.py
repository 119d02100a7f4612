"""Lesson 16, pose from points: matched points of the room, noise on points, the figures and the panel of the fit."""

from courseware.lessons.kit.room_data import room_scenes
from courseware.lessons.lesson_16.figures import centred_figure, heading_figure, noise_figure
from courseware.lessons.lesson_16.fits import (
    LINE,
    ROOM,
    SIGMA,
    expected_sigmas,
    landmarks_of,
    matched_points,
    mirrored_by_plain_svd,
    noisy_fits,
    pose_error,
    ring_of_landmarks,
    weighted_fits,
)
from courseware.lessons.lesson_16.panel import PANELS, fit_panel
