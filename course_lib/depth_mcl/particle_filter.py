"""The particle filter's steps that know nothing of images or motion (paper 1, sections 3.1, 3.4): the start and A-3.

Particles are an array `(N, 6)` of states [x, y, z, roll, pitch, yaw], eqs (1) and (2). Every function is pure: arrays
and a `numpy.random.Generator` in, arrays out. All resampling schemes share one signature.
"""

from typing import Literal, get_args

import numpy as np

from course_lib.geometry import as_states, circular_mean, pose_matrix, rotation_mean, state_from_matrix

Scheme = Literal["systematic", "stratified", "multinomial", "residual"]


def initial_particles(state0: np.ndarray, n: int) -> np.ndarray:
    """Return the particle set `(n, 6)` at the start: every particle has the given initial state.

    X_0 = [x_0, y_0, z_0, phi_0, theta_0, psi_0],    P_0 = {X_0, ..., X_0}

    Raises `ValueError` for a state of a wrong shape or not finite, or n below 1.
    Source: paper 1, eqs (3), (4).
    """
    state0 = as_states(state0, "state0")
    if state0.shape != (6,):
        raise ValueError(f"state0 must be one state (6,); got {state0.shape}")
    if int(n) != n or n < 1:
        raise ValueError(f"the number of particles must be a whole number, at least 1; got {n!r}")
    return np.tile(state0, (int(n), 1))


def weighted_mean_state(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return the estimate `(6,)`: the weighted sum of the particles, its angles on the circle.

    x~_t = sum_i w~_(i) p_t^i

    particles: `(N, 6)`. w: `(N,)`, summing to one. As printed, the sum of angles fails at the wrap: half the weight at
    179 and half at -179 degrees would give 0, not 180. So angles are averaged by `circular_mean`, one by one, which is
    a rotation's mean only while pitch stays away from +-90 degrees. Raises `ValueError` for shapes that do not fit.
    Source: paper 1, eq. (12).
    """
    particles, w = _checked_pair(particles, w)
    return np.concatenate([w @ particles[:, :3], circular_mean(particles[:, 3:], w)])


def weighted_mean_pose(particles: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return the same with the mean taken on rotation matrices: independent of axes and of gimbal lock."""
    particles, w = _checked_pair(particles, w)
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_mean(pose_matrix(particles)[:, :3, :3], w)
    matrix[:3, 3] = w @ particles[:, :3]
    return state_from_matrix(matrix)


def effective_sample_size(w: np.ndarray) -> float:
    """Return how many equally weighted particles the weights `(N,)` are worth: 1 / sum w~^2, from 1 to N.

    Raises `ValueError` for weights that are not finite, negative or all zero.
    """
    w = np.asarray(w, dtype=np.float64)
    if not np.isfinite(w).all() or (w < 0).any() or not w.any():
        raise ValueError("weights must be finite numbers, none negative, not all zero")
    return float(1.0 / np.sum(w**2))


def resample(
    w: np.ndarray, rng: np.random.Generator, scheme: Scheme = "systematic", n: int | None = None
) -> np.ndarray:
    """Return indices `(n,)` of the particles that live on: heavy ones are copied, light ones vanish (A-3).

    Every scheme is unbiased: particle i is drawn n w~_i times in the mean. They differ in how far single draws stray.
        systematic   one random offset, then n equal steps through the cumulative weights
        stratified   one random point in each of n equal strata
        multinomial  n independent draws
        residual     floor(n w~_i) copies for certain, the rest by multinomial draws from n w~_i - floor(n w~_i)
    w: `(N,)` not negative, with a positive sum. n: how many live on (None: N, as in the paper). Indices ascend.
    Raises `ValueError` for bad weights or an unknown scheme. Source: paper 1, section 3.4, which names no scheme:
    「パーティクルの重みに応じて、パーティクルの複製と消滅を行い」 (particles are copied and removed by their weights).
    """
    w = np.asarray(w, dtype=np.float64)
    if w.ndim != 1 or len(w) == 0 or not np.isfinite(w).all() or (w < 0).any() or w.sum() <= 0:
        raise ValueError("weights must be a non-empty array (N,) of finite numbers, none negative, not all zero")
    w, n = w / w.sum(), len(w) if n is None else n
    if scheme == "systematic":
        return _pick(w, (np.arange(n) + rng.random()) / n)
    if scheme == "stratified":
        return _pick(w, (np.arange(n) + rng.random(n)) / n)
    if scheme == "multinomial":
        return _pick(w, np.sort(rng.random(n)))
    if scheme == "residual":
        copies = np.floor(n * w).astype(int)
        n_rest = n - copies.sum()
        if n_rest > 0:
            rest = n * w - copies
            copies += np.bincount(_pick(rest / rest.sum(), np.sort(rng.random(n_rest))), minlength=len(w))
        return np.repeat(np.arange(len(w)), copies)
    raise ValueError(f"scheme must be one of {', '.join(get_args(Scheme))}; got {scheme!r}")


def _pick(w: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return for each point in [0, 1) the particle whose share of the cumulative weights it falls into."""
    cumulative = np.minimum(np.cumsum(w), 1.0)
    # The last sum may round to below one, and the last point, (N - 1 + u) / N, up to one. Both would name a particle
    # that is not there. A particle without weight at the end must not be drawn in its place.
    cumulative[np.flatnonzero(w)[-1] :] = 1.0
    return np.searchsorted(cumulative, np.minimum(points, np.nextafter(1.0, 0.0)), side="right")


def _checked_pair(particles: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    particles, w = as_states(particles, "particles"), np.asarray(w, dtype=np.float64)
    if particles.ndim != 2 or w.shape != (len(particles),):
        raise ValueError(f"particles must be (N, 6) and weights (N,); got {particles.shape} and {w.shape}")
    if not np.isfinite(w).all() or (w < 0).any() or abs(w.sum() - 1) > 1e-6:
        raise ValueError(f"weights must be finite, not negative, and sum to one; their sum is {w.sum():g}")
    return particles, w
