"""What F2 says of means of orientations holds."""

import numpy as np
import pytest

from course_lib.geometry import pose_matrix, rotation_log
from courseware.lessons.foundation_2.clouds import cloud_about, mean_errors


def test_a_cloud_has_its_spread_about_each_axis_of_the_body_at_any_pitch():
    for pitch in (0.0, np.pi / 2):
        middle = pose_matrix(np.array([0, 0, 0, 0.3, pitch, -1.0]))[:3, :3]
        cloud = pose_matrix(cloud_about(np.array([0.3, pitch, -1.0]), 0.1, n=2000))[:, :3, :3]
        assert rotation_log(middle.T @ cloud).std(axis=0) == pytest.approx([0.1] * 3, rel=0.06)


def test_far_from_the_lock_all_means_agree_and_in_it_only_the_mean_of_rotations_holds():
    plain, circle, rotations = np.rad2deg(np.median(mean_errors(0.3, np.deg2rad(5)), axis=0))
    assert max(plain, circle, rotations) < 0.8
    plain, circle, rotations = np.rad2deg(np.median(mean_errors(np.pi / 2, np.deg2rad(5)), axis=0))
    assert rotations < 0.8
    assert min(plain, circle) > 5
