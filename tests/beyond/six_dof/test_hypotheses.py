"""Of many poses the best that differ."""

import numpy as np

from course_lib.beyond.six_dof.poses import distinct, retract


def test_of_poses_alike_the_best_stands_for_all():
    motions = np.zeros((5, 6))
    motions[:, 0] = [0.0, 0.01, 0.5, 0.505, 0.0]
    motions[4, 5] = 0.5
    poses = retract(np.eye(4), motions)
    scores = np.array([0.5, 0.9, 0.8, 0.7, 0.6])
    assert distinct(poses, scores, 9, np.array([0.02, 0.02])).tolist() == [1, 2, 4]
    assert distinct(poses, scores, 2, np.array([0.02, 0.02])).tolist() == [1, 2]
