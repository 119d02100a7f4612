"""Small motions of a camera, `(..., 6)`: along its own axes in metres, then a turn about them (axis times angle)."""

from __future__ import annotations

import numpy as np

from course_lib.geometry import rotation_exp, rotation_log


def moved(poses: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Camera-to-world poses `(..., 4, 4)` after motions `(..., 6)` in their own frames: t' = t + R v, R' = R Exp(w)."""
    poses, motions = np.broadcast_arrays(poses, _matrices(motions))
    return poses @ motions


def motion_between(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The motion `(..., 6)` from pose `before` to pose `after`, in the frame of `before`: `moved` undone."""
    turned = np.swapaxes(before[..., :3, :3], -1, -2)
    along = np.einsum("...ij,...j->...i", turned, after[..., :3, 3] - before[..., :3, 3])
    return np.concatenate([along, rotation_log(turned @ after[..., :3, :3])], axis=-1)


def lengths(motions: np.ndarray) -> np.ndarray:
    """How far in metres and how much of a turn in radians, `(..., 2)`."""
    motions = np.asarray(motions)
    return np.stack([np.linalg.norm(motions[..., :3], axis=-1), np.linalg.norm(motions[..., 3:], axis=-1)], axis=-1)


def _matrices(motions: np.ndarray) -> np.ndarray:
    motions = np.asarray(motions, dtype=np.float64)
    matrices = np.zeros((*motions.shape[:-1], 4, 4))
    matrices[..., :3, :3] = rotation_exp(motions[..., 3:])
    matrices[..., :3, 3] = motions[..., :3]
    matrices[..., 3, 3] = 1.0
    return matrices
