"""The body's axes, and how far a small change of the angles turns the camera."""

import numpy as np

from course_lib.geometry import pose_matrix, rotation_log

AXES = ("forward", "left", "up")  # of the body, in the order of a pose matrix's columns


def turn_per_degree(pitch: float) -> tuple[float, float]:
    """Least and greatest turn of the camera for a small change of (roll, pitch, yaw) of length one; pitch in radians.

    The columns of the Jacobian are the turns, in the body's frame, that a small change of each angle makes; its
    singular values are the extremes. By hand: sqrt(1 - |sin pitch|) and sqrt(1 + |sin pitch|).
    """
    base, step = np.array([0, 0, 0, 0.1, pitch, 0.2]), np.deg2rad(0.01)
    before, *after = pose_matrix(base + step * np.eye(6)[[0, 3, 4, 5]] * [0, 0, 0, 1, 1, 1])[:, :3, :3]
    greatest, _, least = np.linalg.svd(rotation_log(before.T @ np.array(after)) / step, compute_uv=False)
    return least, greatest
