"""Camera poses and small motions between them: `retract`, `local`, and which of many poses are distinct.

A motion `(..., 6)` is a translation along the camera's own axes in metres, then a rotation vector about these axes
(axis times angle, radians). It lives in the tangent space of the pose, which has no gimbal lock.
"""

import numpy as np

from course_lib.geometry import rotation_exp, rotation_log


def retract(poses: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Return camera-to-world poses `(..., 4, 4)` after motions `(..., 6)`: t' = t + R v, R' = R Exp(w)."""
    motions = np.asarray(motions, dtype=np.float64)
    matrices = np.zeros((*motions.shape[:-1], 4, 4))
    matrices[..., :3, :3] = rotation_exp(motions[..., 3:])
    matrices[..., :3, 3] = motions[..., :3]
    matrices[..., 3, 3] = 1.0
    poses, matrices = np.broadcast_arrays(poses, matrices)
    return poses @ matrices


def local(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return the motion `(..., 6)` from pose `before` to pose `after`: the inverse of `retract`."""
    turned = np.swapaxes(before[..., :3, :3], -1, -2)
    along = np.einsum("...ij,...j->...i", turned, after[..., :3, 3] - before[..., :3, 3])
    return np.concatenate([along, rotation_log(turned @ after[..., :3, :3])], axis=-1)


def lengths(motions: np.ndarray) -> np.ndarray:
    """Return the length of the translation in metres and the angle of the rotation in radians, `(..., 2)`."""
    motions = np.asarray(motions)
    return np.stack([np.linalg.norm(motions[..., :3], axis=-1), np.linalg.norm(motions[..., 3:], axis=-1)], axis=-1)


def distinct(poses: np.ndarray, scores: np.ndarray, count: int, apart: np.ndarray) -> np.ndarray:
    """Return the indices of the best poses that differ, best first, at most `count`.

    poses: `(N, 4, 4)`. scores: `(N,)`. apart: `(2,)` metres and radians; two poses differ if they are at least as far
    apart in one of the two.
    """
    kept: list[int] = []
    for index in np.argsort(-scores, kind="stable"):
        differences = lengths(local(poses[index], poses[kept]))
        if (differences >= apart).any(axis=-1).all():
            kept.append(int(index))
        if len(kept) == count:
            break
    return np.array(kept)
