"""How particles move between two frames (paper 1, A-1), in three motions that differ in the axes of sigma.

    WORLD_AXES     eq. (5) as printed: along the world's x, y, z, and on roll, pitch, yaw
    BODY_AXES      along the body's forward, left and up, and on roll, pitch, yaw: the filter's own choice
    TANGENT_SPACE  along and about all three axes of the body: six degrees of freedom, any attitude

As printed, sigma = (0.15, 0.04, ...) says that the camera may move fast along the *world's* x. This is right in a
corridor that runs along x, but wrong if the same corridor is drawn at another angle. The other two know no direction of
the world: if you turn map and recording about z, the estimates turn with them.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.particle_filter import weighted_mean_pose, weighted_mean_state
from course_lib.geometry import as_states, pose_matrix, rotation_exp, rotation_log, state_from_matrix, wrap_angle


def scatter_angles(state: np.ndarray, deviations: np.ndarray) -> np.ndarray:
    """Return the particles `(N, 6)` about a state: position, roll, pitch and yaw plus deviations. Undoes deviations."""
    particles = as_states(state, "state") + as_states(deviations, "deviations")
    particles[..., 3:] = wrap_angle(particles[..., 3:])
    return particles


class Motion(NamedTuple):
    """A part of the filter that can be exchanged; its functions are pure, and all three agree about the angles."""

    propagate: Callable[[np.ndarray, np.ndarray, np.random.Generator], np.ndarray]
    """(particles `(N, 6)`, sigma `(6,)` a frame, generator) -> moved particles `(N, 6)`, a new array."""
    mean: Callable[[np.ndarray, np.ndarray], np.ndarray]  # (particles `(N, 6)`, weights `(N,)`) -> state `(6,)`.
    deviations: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """(particles `(N, 6)`, state `(6,)`) -> `(N, 6)`, metres along the world's axes, then radians."""
    scatter: Callable[[np.ndarray, np.ndarray], np.ndarray] = scatter_angles
    """(state `(6,)`, deviations `(N, 6)`) -> the particles `(N, 6)` that have these deviations."""


def checked_covariance(covariance: np.ndarray) -> np.ndarray:
    """Return a covariance `(6, 6)` as float64. Raises `ValueError` if it is none, or if its angles are in degrees."""
    array = np.array(covariance, dtype=np.float64)
    if array.shape != (6, 6) or not np.isfinite(array).all():
        raise ValueError(f"a covariance must be a finite matrix (6, 6) of x, y, z, roll, pitch, yaw; got {array.shape}")
    variances, largest = np.diag(array), np.abs(array).max()
    if not np.allclose(array, array.T, atol=1e-9 * largest) or np.linalg.eigvalsh(array)[0] < -1e-9 * largest:
        raise ValueError("a covariance must be symmetric, without negative eigenvalues: square metres, square radians")
    if variances[3:].max() > np.pi**2:
        raise ValueError(f"the variances of angles must be square radians; got {variances[3:].tolist()}, over pi^2")
    return array


def checked_sigma(sigma: np.ndarray) -> np.ndarray:
    """Return standard deviations `(6,)` as a new float64 array. Raises `ValueError` if they are none."""
    array = np.array(sigma, dtype=np.float64)
    if array.shape != (6,):
        raise ValueError(
            f"sigma needs six standard deviations [x, y, z (metres), roll, pitch, yaw (radians)]; got {array.shape}"
        )
    if not np.isfinite(array).all() or (array < 0).any():
        raise ValueError(f"sigma must be finite and not negative (0 keeps a component fixed); got {array.tolist()}")
    return array


def propagate(particles: np.ndarray, sigma: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return particles moved by system noise (A-1): the model knows of the motion only how large it may be.

    X_t = X_{t-1} + V_t,    V_t ~ N(0, sigma^2)

    particles: `(N, 6)`. sigma: `(6,)` standard deviations, metres and radians, a frame; 0 keeps a component fixed.
    Angles come back in [-pi, pi). Raises `ValueError` for a bad sigma or particles.
    Source: paper 1, eq. (5).
    """
    particles, sigma = as_states(particles, "particles"), checked_sigma(sigma)
    moved = particles + sigma * rng.standard_normal(particles.shape)
    moved[..., 3:] = wrap_angle(moved[..., 3:])
    return moved


def propagate_body(particles: np.ndarray, sigma: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return particles moved by the same noise, its first two parts along each particle's own heading.

    (x, y)' = (x, y) + Rz(yaw) (v_forward, v_left),    z' = z + v_up,    angles' = angles + w

    The axes stay level, for a body that a floor carries: with 0 in sigma z, roll and pitch stay exactly as they were.
    Yaw is the one before its own noise. Arguments and errors as in `propagate`; sigma is [forward, left, up, roll,
    pitch, yaw]. A camera that is carried sideways needs the larger number in second place.
    """
    particles = as_states(particles, "particles")
    moved = propagate(particles, sigma, rng)
    forward, left = np.moveaxis((moved - particles)[..., :2], -1, 0)
    cosine, sine = np.cos(particles[..., 5]), np.sin(particles[..., 5])
    moved[..., 0] = particles[..., 0] + cosine * forward - sine * left
    moved[..., 1] = particles[..., 1] + sine * forward + cosine * left
    return moved


def propagate_tangent(particles: np.ndarray, sigma: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return particles moved by noise along and about the body's own axes, for all six degrees of freedom.

    t' = t + R v,  R' = R Exp(w),  (v, w) ~ N(0, sigma^2)

    Noise on roll, pitch and yaw turns a camera near pitch = +-90 degrees (gimbal lock) by other amounts, about other
    axes, than sigma says; this does not. Arguments and errors as in `propagate`; sigma is [forward, left, up, about x,
    about y, about z of the body], so a single 0 there keeps no single component of the state fixed.
    """
    particles, sigma = as_states(particles, "particles"), checked_sigma(sigma)
    noise = sigma * rng.standard_normal(particles.shape)
    matrices = pose_matrix(particles)
    rotations = matrices[..., :3, :3].copy()
    matrices[..., :3, 3] += np.einsum("...ij,...j->...i", rotations, noise[..., :3])
    matrices[..., :3, :3] = rotations @ rotation_exp(noise[..., 3:])
    return state_from_matrix(matrices)


def angle_deviations(particles: np.ndarray, state: np.ndarray) -> np.ndarray:
    """Return particles minus state `(N, 6)`, the differences of roll, pitch and yaw the short way round."""
    deviations = as_states(particles, "particles") - as_states(state, "state")
    deviations[..., 3:] = wrap_angle(deviations[..., 3:])
    return deviations


def scatter_rotations(state: np.ndarray, deviations: np.ndarray) -> np.ndarray:
    """Return the particles `(N, 6)` about a state, turned by rotation vectors about the body's axes: R Exp(w)."""
    matrices = np.tile(pose_matrix(state), (len(deviations), 1, 1))
    matrices[:, :3, 3] += deviations[:, :3]
    matrices[:, :3, :3] = matrices[:, :3, :3] @ rotation_exp(deviations[:, 3:])
    return state_from_matrix(matrices)


def rotation_deviations(particles: np.ndarray, state: np.ndarray) -> np.ndarray:
    """Return particles minus state `(N, 6)`, turns as rotation vectors about the body's axes: Log(R^T R_i)."""
    deviations = as_states(particles, "particles") - as_states(state, "state")
    rotation = pose_matrix(state)[:3, :3]
    deviations[..., 3:] = rotation_log(rotation.T @ pose_matrix(particles)[..., :3, :3])
    return deviations


WORLD_AXES = Motion(propagate, weighted_mean_state, angle_deviations)
BODY_AXES = Motion(propagate_body, weighted_mean_state, angle_deviations)
TANGENT_SPACE = Motion(propagate_tangent, weighted_mean_pose, rotation_deviations, scatter_rotations)
