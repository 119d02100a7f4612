"""Compute with camera poses and small motions between them: `retract`, `local`, and which poses are distinct.

A motion `(..., 6)` is a translation along the camera's own axes in metres, then a rotation vector about these axes
(axis times angle, radians). It lives in the tangent space of the pose, which has no gimbal lock.
"""

import numpy as np

from course_lib.geometry import BODY_FROM_OPTICAL, as_states, pose_matrix, rotation_exp, rotation_log

MAX_INCREMENT = np.array([2.0, np.pi])  # metres, radians between two frames: a longer one is in other units (chosen)


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


def motion_between(state_a: np.ndarray, state_b: np.ndarray) -> np.ndarray:
    """Return the motion `(..., 6)` from state a to state b, as an odometer gives it to `AnnealedLocalizer.step`.

    (R_a' (t_b - t_a), log R_a' R_b), along and about the *body's* axes at a (x forward, y left, z up), metres and
    radians. state_a, state_b: `(..., 6)`. Raises `ValueError` for another shape, or values that are not finite.
    """
    return local(pose_matrix(as_states(state_a, "state_a")), pose_matrix(as_states(state_b, "state_b")))


def optical_increment(increment: np.ndarray) -> np.ndarray:
    """Check an increment `(6,)` along and about the body's axes, and return it along and about the optical axes.

    Raises `ValueError` for another shape, values that are not finite, or more than `MAX_INCREMENT`.
    """
    array = np.asarray(increment, dtype=np.float64)
    cure = "motion_between(state_a, state_b) gives one from two states"
    if array.shape != (6,):
        raise ValueError(
            f"increment must have shape (6,): x forward, y left, z up in metres, then a rotation vector in radians; "
            f"got shape {array.shape}. {cure}"
        )
    if not np.isfinite(array).all():
        raise ValueError(f"increment must be finite; got {array.tolist()}. Without an odometer's value give None")
    if (lengths(array) > MAX_INCREMENT).any():
        metres, radians = lengths(array)
        raise ValueError(
            f"increment must be at most {MAX_INCREMENT[0]:g} m and pi radians between two frames; got {metres:g} m and "
            f"{radians:g} rad. Check its units, metres and radians; {cure}"
        )
    return (array.reshape(2, 3) @ BODY_FROM_OPTICAL).ravel()


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
