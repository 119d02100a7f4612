"""Right answers to lesson 01 by other ways than its solutions."""

import itertools
import math

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import BODY_FROM_OPTICAL as B
from course_lib.geometry import optical_pose, pose_matrix


def rotation(state):
    return pose_matrix(state)[:3, :3]


def angles_of(R):
    return [math.atan2(R[2, 1], R[2, 2]), -math.asin(R[2, 0]), math.atan2(R[1, 0], R[0, 0])]


def tried_one_by_one(angles, rotations, new, firsts=(True, False), signs=(1, -1)):
    """Every reading by matrices of our own, the first that fits."""

    def matrix(row, axes, sign, first):
        turns = [rotation(np.deg2rad(s * a) * np.eye(6)[3 + k]) for k, s, a in zip(axes, sign, row, strict=True)]
        return np.linalg.multi_dot(turns[::-1] if first else turns)

    for reading in itertools.product(itertools.permutations(range(3)), itertools.product(signs, repeat=3), firsts):
        if np.allclose([matrix(row, *reading) for row in angles], rotations, atol=1e-6):
            return np.array([angles_of(matrix(row, *reading)) for row in new])
    return None


RIGHT = [
    ("01.1", lambda p, s: (optical_pose(s) @ np.column_stack([p, np.ones(len(p))]).T)[:3].T),
    ("01.2", lambda m: np.r_[m[:3, 3], Rotation.from_matrix(m[:3, :3] @ B.T).as_euler("ZYX")[::-1]]),
    ("01.3", lambda a, b: [*((b - a)[:3] @ rotation(a)), *angles_of(rotation(a).T @ rotation(b))]),
    ("01.4", tried_one_by_one),
]
