"""Compute with rigid transforms, roll-pitch-yaw angles and means on the circle, which both methods share.

A state is `(..., 6)` float64 `[x, y, z, roll, pitch, yaw]`: the pose of the body (x forward, y left, z up) in the world
(z up), metres and radians, with R = Rz(yaw) Ry(pitch) Rx(roll). That is the state vector of eq. (1) of paper 1
(Hatakeyama, Kanai, Date), whose phi, theta, psi are roll, pitch and yaw; a particle set, eq. (2), is an array `(N, 6)`.

Near pitch = +-90 degrees roll and yaw turn about the same axis (gimbal lock). A state still names one pose there, but
neighbouring poses may have angles that are far apart. To perturb or average all three angles, work on rotations, with
`rotation_exp`, `rotation_log` and `rotation_mean`.
"""

import numpy as np
from scipy.spatial.transform import Rotation

# Turns vectors of the camera's optical frame (x right, y down, z forward) into the body's (x forward, y left, z up).
BODY_FROM_OPTICAL = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])

# Below this cosine of the pitch, float64 does not separate roll from yaw, and roll is set to zero.
_GIMBAL_LOCK_COSINE = 1e-9


def as_states(states: np.ndarray, name: str = "states") -> np.ndarray:
    """Return states `(..., 6)` as float64. Raises `ValueError` for another last axis or values that are not finite."""
    array = np.asarray(states, dtype=np.float64)
    if array.ndim == 0 or array.shape[-1] != 6:
        raise ValueError(f"{name} must have shape (..., 6) [x, y, z, roll, pitch, yaw]; got {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite; got NaN or infinity in {np.argwhere(~np.isfinite(array))[0]}")
    return array


def pose_matrix(states: np.ndarray) -> np.ndarray:
    """Return the body-to-world matrices of states.

    X = [x, y, z, phi, theta, psi],    P = {X_1, ..., X_N}
    T = [[R, t], [0, 1]],    R = Rz(psi) Ry(theta) Rx(phi),    t = [x, y, z]

    The order of the rotations is REP 103's.

    Parameters
    ----------
    states : array `(..., 6)`
        x, y, z in metres, then roll, pitch, yaw in radians. A particle set has shape `(N, 6)`.

    Returns
    -------
    array `(..., 4, 4)`
        A point p of the body, `(3,)`, is at R p + t in the world.

    Raises
    ------
    ValueError
        If the last axis does not have six values, or if a value is not finite.

    Source: paper 1, eqs (1), (2).
    """
    states = as_states(states)
    cosine, sine = np.cos(states[..., 3:]), np.sin(states[..., 3:])
    (c_roll, c_pitch, c_yaw), (s_roll, s_pitch, s_yaw) = np.moveaxis(cosine, -1, 0), np.moveaxis(sine, -1, 0)
    matrices = np.zeros((*states.shape[:-1], 4, 4))
    matrices[..., 0, 0] = c_yaw * c_pitch
    matrices[..., 0, 1] = c_yaw * s_pitch * s_roll - s_yaw * c_roll
    matrices[..., 0, 2] = c_yaw * s_pitch * c_roll + s_yaw * s_roll
    matrices[..., 1, 0] = s_yaw * c_pitch
    matrices[..., 1, 1] = s_yaw * s_pitch * s_roll + c_yaw * c_roll
    matrices[..., 1, 2] = s_yaw * s_pitch * c_roll - c_yaw * s_roll
    matrices[..., 2, 0] = -s_pitch
    matrices[..., 2, 1] = c_pitch * s_roll
    matrices[..., 2, 2] = c_pitch * c_roll
    matrices[..., :3, 3] = states[..., :3]
    matrices[..., 3, 3] = 1.0
    return matrices


def state_from_matrix(matrices: np.ndarray) -> np.ndarray:
    """Return the states of body-to-world matrices: the inverse of `pose_matrix`.

    roll = atan2(R21, R22),    pitch = atan2(-R20, hypot(R00, R10)),    yaw = atan2(R10, R00)

    The pitch lies within +-90 degrees. At +-90 degrees (gimbal lock) roll is 0 and yaw holds the whole turn, so the
    state still names the same pose.

    Parameters
    ----------
    matrices : array `(..., 4, 4)`
        [[R, t], [0, 1]], translations in metres.

    Returns
    -------
    array `(..., 6)`
        x, y, z in metres, then roll, pitch, yaw in radians.

    Raises
    ------
    ValueError
        If the shape is wrong, a value is not finite, R is not a rotation, or the last row is not 0 0 0 1.
    """
    matrices = np.asarray(matrices, dtype=np.float64)
    if matrices.ndim < 2 or matrices.shape[-2:] != (4, 4):
        raise ValueError(f"matrices must have shape (..., 4, 4); got {matrices.shape}")
    if not np.isfinite(matrices).all():
        raise ValueError("matrices must be finite; got NaN or infinity")
    rotation = matrices[..., :3, :3]
    if not is_rotation(rotation).all():
        raise ValueError("the upper left 3 x 3 of every matrix must be a rotation (orthonormal, determinant +1)")
    if not np.allclose(matrices[..., 3, :], [0, 0, 0, 1]):
        raise ValueError("the last row of every matrix must be 0 0 0 1")
    states = np.empty((*matrices.shape[:-2], 6))
    cos_pitch = np.hypot(rotation[..., 0, 0], rotation[..., 1, 0])
    locked = cos_pitch < _GIMBAL_LOCK_COSINE
    states[..., :3] = matrices[..., :3, 3]
    states[..., 3] = np.where(locked, 0.0, np.arctan2(rotation[..., 2, 1], rotation[..., 2, 2]))
    states[..., 4] = np.arctan2(-rotation[..., 2, 0], cos_pitch)
    states[..., 5] = np.where(
        locked,
        np.arctan2(-rotation[..., 0, 1], rotation[..., 1, 1]),
        np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0]),
    )
    return states


def is_rotation(matrices: np.ndarray, tolerance: float = 1e-4) -> np.ndarray:
    """Return whether each matrix R `(..., 3, 3)` is a rotation: R' R = I to `tolerance`, determinant > 0; `(...)`."""
    matrices = np.asarray(matrices, dtype=np.float64)
    gram = np.swapaxes(matrices, -1, -2) @ matrices
    orthonormal = np.abs(gram - np.eye(3)).max(axis=(-1, -2)) <= tolerance
    return orthonormal & (np.linalg.det(matrices) > 0)


def wrap_angle(a: np.ndarray | float) -> np.ndarray | float:
    """Return angles in [-pi, pi): (a + pi) mod 2 pi - pi.

    Parameters
    ----------
    a : number or array `(...)`
        Radians. NaN and infinity become NaN.

    Returns
    -------
    number or array `(...)`
        Radians. An angle that lies in the range keeps every bit.
    """
    a = np.asarray(a, dtype=np.float64)
    # Adding and subtracting pi would round an angle that lies in the range already.
    wrapped = np.where((a >= -np.pi) & (a < np.pi), a, (a + np.pi) % (2 * np.pi) - np.pi)
    # The remainder of a tiny negative number rounds up to the modulus itself, which would read +pi.
    wrapped = np.where(wrapped >= np.pi, -np.pi, wrapped)
    return float(wrapped) if wrapped.ndim == 0 else wrapped


def circular_mean(angles: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray | float:
    """Return the mean direction of angles along their first axis: atan2(sum w sin a, sum w cos a).

    Parameters
    ----------
    angles : array `(N, ...)`
        Radians.
    weights : array `(N,)`, optional
        Not negative, and not all zero. Without them all angles count alike.

    Returns
    -------
    number or array `(...)`
        Radians in [-pi, pi). NaN if the sums vanish, as for two opposite angles, which have no mean direction.

    Raises
    ------
    ValueError
        If there are no angles, an angle is not finite, or the weights do not fit.
    """
    angles = np.asarray(angles, dtype=np.float64)
    if angles.ndim == 0 or len(angles) == 0:
        raise ValueError(f"angles must have at least one element along the first axis; got shape {angles.shape}")
    if not np.isfinite(angles).all():
        raise ValueError(f"angles must be finite numbers of radians; {np.sum(~np.isfinite(angles))} are not")
    w = np.ones(len(angles)) if weights is None else np.asarray(weights, dtype=np.float64)
    if w.shape != angles.shape[:1] or not np.isfinite(w).all() or (w < 0).any() or w.sum() == 0:
        raise ValueError(f"weights must be {len(angles)} finite numbers, none negative, not all zero; got {w.shape}")
    w = w / w.sum()
    sine, cosine = np.tensordot(w, np.sin(angles), 1), np.tensordot(w, np.cos(angles), 1)
    mean = np.where(np.hypot(sine, cosine) < 1e-12, np.nan, wrap_angle(np.arctan2(sine, cosine)))
    return float(mean) if mean.ndim == 0 else mean


def rotation_exp(rotation_vector: np.ndarray) -> np.ndarray:
    """Return the rotation matrices `(..., 3, 3)` of rotation vectors `(..., 3)`: axis times angle, radians."""
    vectors = np.asarray(rotation_vector, dtype=np.float64)
    return Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(*vectors.shape, 3)


def rotation_log(rotation: np.ndarray) -> np.ndarray:
    """Return the rotation vectors `(..., 3)` of matrices `(..., 3, 3)`, angles up to pi: inverse of `rotation_exp`."""
    rotation = np.asarray(rotation, dtype=np.float64)
    return Rotation.from_matrix(rotation.reshape(-1, 3, 3)).as_rotvec().reshape(rotation.shape[:-1])


def rotation_angle(rotation: np.ndarray) -> np.ndarray:
    """Return the angle `(...)` in [0, pi] radians by which each rotation `(..., 3, 3)` turns."""
    return np.linalg.norm(rotation_log(rotation), axis=-1)


def rotation_mean(rotations: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
    """Return the chordal mean `(3, 3)` of rotations R `(N, 3, 3)`: the rotation nearest to sum w R, weights `(N,)`."""
    return Rotation.from_matrix(rotations).mean(weights).as_matrix()


def optical_pose(states: np.ndarray) -> np.ndarray:
    """Return camera-to-world matrices `(..., 4, 4)`, optical convention (x right, y down, z forward), of states."""
    matrices = pose_matrix(states)
    matrices[..., :3, :3] = matrices[..., :3, :3] @ BODY_FROM_OPTICAL
    return matrices


def state_from_optical_pose(matrices: np.ndarray) -> np.ndarray:
    """Return the states `(..., 6)` of camera-to-world matrices `(..., 4, 4)`: the inverse of `optical_pose`."""
    matrices = np.array(matrices, dtype=np.float64)
    if matrices.shape[-2:] == (4, 4):  # another shape is refused below
        matrices[..., :3, :3] = matrices[..., :3, :3] @ BODY_FROM_OPTICAL.T
    return state_from_matrix(matrices)


UP_AXES = {
    "x": (1, 0, 0), "-x": (-1, 0, 0), "y": (0, 1, 0), "-y": (0, -1, 0), "z": (0, 0, 1), "-z": (0, 0, -1),
}  # fmt: skip


def rotation_to_z_up(up: str) -> np.ndarray:
    """Return the shortest rotation `(4, 4)` that turns a world's up axis, such as "y" or "-z", into +z.

    Raises `ValueError` if `up` names no axis.
    """
    if up not in UP_AXES:
        raise ValueError(f"up must be one of {', '.join(UP_AXES)}; got {up!r}")
    matrix = np.eye(4)
    turn = np.cross(UP_AXES[up], [0.0, 0.0, np.pi / 2])
    matrix[:3, :3] = np.rint(Rotation.from_rotvec(turn).as_matrix()) if up != "-z" else np.diag([1.0, -1.0, -1.0])
    return matrix
