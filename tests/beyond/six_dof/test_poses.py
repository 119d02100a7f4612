"""Motions in a camera's own frame, and which of many poses are distinct."""

import numpy as np
import pytest

from course_lib.beyond.six_dof.poses import distinct, local, motion_between, optical_increment, retract
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


def test_an_increment_is_along_and_about_the_body_s_axes():
    """From facing left: a step ahead is along the world's y; a step to the left goes back along its x."""
    before = np.array([1.0, 2.0, 0.5, 0.0, 0.0, np.pi / 2])
    after = np.array([0.9, 2.5, 0.7, 0.0, 0.0, np.pi / 2 + 0.3])
    assert motion_between(before, after) == pytest.approx([0.5, 0.1, 0.2, 0.0, 0.0, 0.3])
    increment = motion_between(before, after)
    assert retract(optical_pose(before), optical_increment(increment)) == pytest.approx(optical_pose(after))
    level = np.zeros(6)
    assert motion_between(level, np.array([0, 0, 0, 0.2, 0, 0])) == pytest.approx([0, 0, 0, 0.2, 0, 0])
    assert motion_between(level, np.array([0, 0, 0, 0, 0.2, 0])) == pytest.approx([0, 0, 0, 0, 0.2, 0])
    assert optical_increment([1.0, 0, 0, 0, 0, 0.5]) == pytest.approx([0, 0, 1.0, 0, -0.5, 0])


@pytest.mark.parametrize(
    ("increment", "message"),
    [
        (np.eye(4), r"shape \(4, 4\)"),
        (np.zeros(3), r"shape \(3,\)"),
        (np.zeros((1, 6)), r"shape \(1, 6\)"),
        (np.array([0.1, np.nan, 0, 0, 0, 0]), "finite"),
        (np.array([48.0, 0, 0, 0, 0, 0]), "48 m.*units"),
        (np.array([0.1, 0, 0, 0, 0, 20.0]), "20 rad"),
    ],
)
def test_a_wrong_increment_is_refused_with_shape_and_unit(increment, message):
    with pytest.raises(ValueError, match=message):
        optical_increment(increment)
