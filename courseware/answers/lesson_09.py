"""Exercises of lesson 09: how many particles, the mean of rotations, an honest covariance, a robust fit in 2D."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import rotation_exp, rotation_log
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.values import agree, as_numbers


def particles_for(n, d, d_new):
    """Number of particles that lie as densely in d_new dimensions as n do in d."""
    # n ** (1 / d) along an edge, and as many along each of d_new edges.
    return (n ** (1 / d)) ** d_new


def mean_rotation(rotations, w):
    """The rotation R (3, 3) with sum_i w_i Log(R' R_i) = 0."""
    # Where am I pulled, seen from here? Go there; look again.
    R = rotations[0]
    for _ in range(20):
        R = R @ rotation_exp(w @ rotation_log(R.T @ rotations))
    return R


def weighted_rotations(rng):
    """Two to seven rotations about a base that looks anywhere, often straight down or backwards."""
    n = int(rng.integers(2, 8))
    pitch = rng.choice([rng.uniform(-1.4, 1.4), np.pi / 2 - 0.05, -np.pi / 2 + 0.05])
    yaw = rng.choice([rng.uniform(-3, 3), np.pi - 0.02])
    base = Rotation.from_euler("ZYX", [yaw, pitch, rng.uniform(-1, 1)])
    apart = rng.standard_normal((n, 3))
    apart *= rng.uniform(0.4, 1.0, (n, 1)) / np.linalg.norm(apart, axis=1, keepdims=True)
    w = rng.uniform(0.2, 1.0, n) * np.where(np.arange(n), 1, 3)
    return (base * Rotation.from_rotvec(apart)).as_matrix(), w / w.sum()


def unbalanced(given, R):
    """Return what is wrong with a mean rotation: its shape, its columns, or the vectors to all others seen from it."""
    if agree(R, mean_rotation(*given), 1e-6):
        return None
    if (R := as_numbers(R)) is None or R.shape != (3, 3):
        return "The result must be a matrix of shape (3, 3)."
    if not np.allclose(R.T @ R, np.eye(3), atol=1e-6):
        return "Your matrix is no rotation: its columns must have length 1 and stand at right angles."
    return "Seen from your R the vectors do not balance: which rotation is turned back, and on which side do you step?"


def honesty(errors, covariances):
    """Mean normalized squared error, and share of single errors within three sigma."""
    # Image by image; solve instead of inverting; sigma is a square root.
    squared, within = [], []
    for e, C in zip(errors, covariances, strict=True):
        squared.append(e @ np.linalg.solve(C, e) / len(e))
        within.append(np.abs(e) <= 3 * np.sqrt(np.diag(C)))
    return np.mean(squared), np.mean(within)


def errors_and_covariances(rng):
    """Correlated errors of two to six components in unlike units; some lie beyond three sigma, above and below."""
    t, d = int(rng.integers(5, 12)), int(rng.integers(2, 7))
    roots, units = rng.standard_normal((t, d, d)) + np.eye(d), np.geomspace(0.01, 2.0, d)
    covariances = roots @ np.swapaxes(roots, 1, 2) * units[:, None] * units
    errors = np.einsum("tij,tj->ti", roots, rng.standard_normal((t, d))) * units
    far = rng.permutation(t)[:3]
    for column in (rng.integers(d, size=3), 0):
        errors[far, column] = np.sqrt(covariances[far, 0, 0]) * [4, -4, -5]
    return errors, covariances


def fit_motion(points, normals, offsets, scale):
    """[t_x, t_y, theta] that brings points (n, 2) onto their walls n . x = c, robustly."""
    # Move, residuals, derivatives, weights, solve; again.
    motion = np.zeros(3)
    for _ in range(40):
        c, s = np.cos(motion[2]), np.sin(motion[2])
        R, dR = np.array([[c, -s], [s, c]]), np.array([[-s, -c], [c, -s]])
        r = np.sum(normals * (points @ R.T + motion[:2]), axis=1) - offsets
        J = np.column_stack([normals, np.sum(normals * (points @ dR.T), axis=1)])
        w = 1 / (1 + (r / scale) ** 2) ** 2
        motion = motion - np.linalg.solve(J.T @ (w[:, None] * J), J.T @ (w * r))
    return motion


def walls_at(angles, offsets, rng, shift, turn, before=0.0):
    """Points (n, 2), one on each wall or so far before it, as seen after a shift and a turn; the normals (n, 2)."""
    normals = np.column_stack([np.cos(angles), np.sin(angles)])
    along = rng.uniform(-1.2, 1.5, (len(angles), 1)) * normals[:, ::-1] * [-1, 1]
    c, s = np.cos(turn), np.sin(turn)
    return ((offsets - before)[:, None] * normals + along - shift) @ np.array([[c, -s], [s, c]]), normals


def points_on_walls(rng):
    """Points on three or four walls of a room, seen from nearly the right place, and a person before one of them."""
    walls, scale = int(rng.integers(3, 5)), float(rng.choice([0.15, 0.2, 0.25]))
    which = np.repeat(np.arange(walls), int(rng.integers(8, 14)))
    angles = rng.uniform(-np.pi, np.pi) + np.pi / 2 * np.arange(walls) + rng.normal(0, 0.05, walls)
    away, before = rng.uniform(1.5, 4.0, walls)[which], rng.normal(0, 0.004, len(which))
    person = rng.permutation(len(which))[: len(which) // 6]
    before[person] += rng.uniform(0.25, 0.7, len(person))
    turn = rng.choice([-1, 1]) * np.deg2rad(rng.uniform(1.5, 3.0))
    return *walls_at(angles[which], away, rng, rng.uniform(-0.06, 0.06, 2), turn, before), away, scale


def a_large_turn(rng):
    """Fifteen degrees and four decimetres, nobody in the way: the first steps' shifts turn with the later steps."""
    angles, offsets = np.repeat(np.deg2rad([10.0, 100.0, 190.0]), 8), np.full(24, 3.0)
    return *walls_at(angles, offsets, rng, [0.3, -0.25], np.deg2rad(15)), offsets, 1.5


# fmt: off
EXERCISES = [
    Exercise("09.1", particles_for, lambda rng: tuple(rng.integers([20, 1, 1], [1000, 7, 7]).tolist()), "warm-up", {
        "fewer dimensions": lambda rng: (200, 3, 2),
        "the same dimension": lambda rng: (int(rng.integers(20, 1000)), 4, 4),
    }, example=((200, 3, 6), 40000)),
    Exercise("09.2", mean_rotation, weighted_rotations, verify=unbalanced, cases={
        "one rotation": lambda rng: (Rotation.from_rotvec([[0.3, -2.0, 1.0]]).as_matrix(), np.ones(1)),
        "equal rotations": lambda rng: (Rotation.from_rotvec([[0.1, 0.4, 2.5]] * 4).as_matrix(), np.arange(1, 5) / 10),
    }),
    Exercise("09.3", honesty, errors_and_covariances, cases={
        "one component": lambda rng: (rng.normal(0, 2, (6, 1)), rng.uniform(0.2, 1.0, (6, 1, 1))),
    }),
    Exercise("09.4", fit_motion, points_on_walls, "challenge", tolerance=1e-4, cases={
        "two walls and a person": lambda rng: (np.array([[2.1, 0.5], [2.1, -0.5], [1, 0], [0.5, 1], [-0.5, 1]]),
                                               np.repeat(np.eye(2), [3, 2], axis=0), np.array([2.0, 2, 2, 1, 1]), 0.1),
        "a large turn": a_large_turn,
    }),
]
