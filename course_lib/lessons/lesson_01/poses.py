"""Poses as numbers: the matrix of a state as text, and how far a turn moves what is seen."""

import numpy as np

from course_lib.geometry import pose_matrix, rotation_log

AXES = ("forward", "left", "up")  # of the body, in the order of a pose matrix's columns


def turn_per_degree(pitch: float, step: float = np.deg2rad(0.01)) -> tuple[float, float]:
    """Least and greatest turn of the camera for a small change of (roll, pitch, yaw) of length one.

    The columns of the Jacobian are the turns, in the body's frame, that a small change of each angle makes; its
    singular values are the extremes. By hand: sqrt(1 - |sin pitch|) and sqrt(1 + |sin pitch|).
    """
    base = np.array([0, 0, 0, 0.1, pitch, 0.2])
    rotations = pose_matrix(base + step * np.eye(6)[3:])[:, :3, :3]
    before = pose_matrix(base)[:3, :3]
    jacobian = rotation_log(before.T @ rotations).T / step
    values = np.linalg.svd(jacobian, compute_uv=False)
    return float(values[-1]), float(values[0])


def matrix_text(matrix: np.ndarray) -> str:
    """A pose matrix in columns: the body's axes and its position, in the world frame."""
    heads = "".join(f"{name:>10}" for name in (*AXES, "position"))
    rows = ["".join(f"{value + 0.0:10.2f}" for value in row) for row in np.round(matrix, 2)]
    return "\n".join(
        [f"pose matrix{heads}", *(f"{name:11}{row}" for name, row in zip(("x", "y", "z", ""), rows, strict=True))]
    )
