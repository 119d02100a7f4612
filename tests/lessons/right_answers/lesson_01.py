"""Right answers to lesson 01 by other ways than its solutions."""

import itertools
import math

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import BODY_FROM_OPTICAL, optical_pose, pose_matrix, state_from_matrix

B = BODY_FROM_OPTICAL


def rotation(state):
    return pose_matrix(state)[:3, :3]


def by_arcsin(matrix):
    R = matrix[:3, :3] @ B.T
    return [*matrix[:3, 3], math.atan2(R[2, 1], R[2, 2]), -math.asin(R[2, 0]), math.atan2(R[1, 0], R[0, 0])]


def axis_by_axis(before, after):
    """The step by dot products with the first camera's axes; the turn by its matrix."""
    R, S = rotation(before), rotation(after)
    turn = R.T @ S
    step = [np.dot(R[:, k], after[:3] - before[:3]) for k in range(3)]
    return [*step, math.atan2(turn[2, 1], turn[2, 2]), -math.asin(turn[2, 0]), math.atan2(turn[1, 0], turn[0, 0])]


def tried_one_by_one(angles, rotations, new, firsts=(True, False), signs=(1, -1)):
    """Every reading by matrices of our own, the first that fits."""

    def matrix(row, axes, sign, first):
        turns = [pose_matrix(np.deg2rad(s * a) * np.eye(6)[3 + k]) for k, s, a in zip(axes, sign, row, strict=True)]
        return np.linalg.multi_dot(turns[::-1] if first else turns)

    every = itertools.product(itertools.permutations(range(3)), itertools.product(signs, repeat=3), firsts)
    for reading in every:
        if np.allclose([matrix(row, *reading)[:3, :3] for row in angles], rotations, atol=1e-6):
            return state_from_matrix(np.array([matrix(row, *reading) for row in new]))[:, 3:]
    return None


RIGHT = [
    ("01.1", lambda p, s: (optical_pose(s) @ np.column_stack([p, np.ones(len(p))]).T)[:3].T),
    ("01.1", lambda p, s: [list(rotation(s) @ B @ q + s[:3]) for q in p]),
    ("01.1", lambda p, s: [(pose_matrix(s) @ [q[2], -q[0], -q[1], 1.0])[:3] for q in p]),
    ("01.1", lambda p, s: np.float32(p @ (rotation(s) @ B).T + s[:3])),
    ("01.2", by_arcsin),
    ("01.2", lambda m: np.r_[m[:3, 3], Rotation.from_matrix(m[:3, :3] @ B.T).as_euler("ZYX")[::-1]]),
    ("01.3", lambda a, b: state_from_matrix(np.linalg.solve(pose_matrix(a), pose_matrix(b)))),
    ("01.3", axis_by_axis),
    ("01.4", tried_one_by_one),
    ("01.4", lambda a, R, new: tried_one_by_one(a, R, new, firsts=(False, True), signs=(-1, 1)).tolist()),
]
