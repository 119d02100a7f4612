"""Motions in a camera's own frame, and which of many poses are distinct."""

import numpy as np
import pytest

from course_lib.beyond.six_dof.poses import distinct, local, retract
from course_lib.geometry import optical_pose
from tests.rendering.shapes import random_states


def test_a_camera_moves_along_its_own_axes_and_back(rng):
    facing_left = optical_pose(np.array([1.0, 2.0, 3.0, 0.0, 0.0, np.pi / 2]))
    ahead = retract(facing_left, np.array([0.0, 0.0, 0.5, 0.0, 0.0, 0.0]))  # forward is the optical z
    assert ahead[:3, 3] == pytest.approx([1.0, 2.5, 3.0])
    turned = retract(facing_left, np.array([0.0, 0.0, 0.0, 0.0, 0.1, 0.0]))  # about the optical y, which points down
    assert turned[:3, :3] == pytest.approx(optical_pose(np.array([0, 0, 0, 0, 0, np.pi / 2 - 0.1]))[:3, :3])
    poses = optical_pose(random_states(50, rng))
    motions = 0.5 * rng.standard_normal((50, 6))
    assert local(poses, retract(poses, motions)) == pytest.approx(motions, abs=1e-9)


def test_of_poses_alike_the_best_stands_for_all():
    motions = np.zeros((5, 6))
    motions[:, 0] = [0.0, 0.01, 0.5, 0.505, 0.0]
    motions[4, 5] = 0.5
    poses, scores = retract(np.eye(4), motions), np.array([0.5, 0.9, 0.8, 0.7, 0.6])
    assert distinct(poses, scores, 9, np.array([0.02, 0.02])).tolist() == [1, 2, 4]
    assert distinct(poses, scores, 2, np.array([0.02, 0.02])).tolist() == [1, 2]
