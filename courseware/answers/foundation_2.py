"""Exercises of F2: a door on its hinge, a mean of rotations, the end of a screw motion."""

import numpy as np

from course_lib.geometry import circular_mean, pose_matrix, rotation_exp, rotation_log, rotation_mean, state_from_matrix
from courseware.lessons.kit.exercise import Exercise


def open_door(points, hinge, axis, angle):
    """Points (n, 3) [m] after a turn by `angle` [rad] about the line through `hinge` (3,) along `axis` (3,)."""
    # Count from the hinge, turn, and count from the origin again.
    R = rotation_exp(angle * axis / np.linalg.norm(axis))
    return hinge + (points - hinge) @ R.T


def a_door(rng: np.random.Generator, hinge=None, length=None, angle=None) -> tuple:
    axis = rng.standard_normal(3)
    axis *= (rng.uniform(0.3, 3) if length is None else length) / np.linalg.norm(axis)
    hinge = rng.uniform(-2, 2, 3) if hinge is None else hinge
    angle = rng.choice([-1, 1]) * rng.uniform(0.3, 3) if angle is None else angle
    return rng.uniform(-2, 2, (5, 3)), hinge, axis, angle


def rodrigues(k, angle, sine=None, third=None, first=1, square=lambda K: K @ K):
    """Return, for mistakes, eq. (F2.1) with other factors of its three terms."""
    K = np.cross(np.eye(3), k)
    sine, third = np.sin(angle) if sine is None else sine, 1 - np.cos(angle) if third is None else third
    return first * np.eye(3) + sine * K + third * square(K)


def mean_rotation(rotations, weights):
    """Mean M (3, 3) of rotations (n, 3, 3): the weighted sum of Log(M^T R_i) is zero; weights (n,) are positive."""
    # Average in the tangent space of a guess, go there, and repeat.
    M = rotations[0]
    for _ in range(50):
        M = M @ rotation_exp(weights @ rotation_log(M.T @ rotations) / weights.sum())
    return M


def a_cloud(rng: np.random.Generator, middle=None, spread: float = 0.35, n: int = 6) -> tuple:
    """Return rotations about a middle (default: any), a weight for each, not of sum one."""
    middle = rotation_exp(rng.uniform(-2, 2, 3)) if middle is None else middle
    return middle @ rotation_exp(spread * rng.standard_normal((n, 3))), rng.uniform(0.2, 3.0, n)


def mean_of_angles(rotations, weights, mean=circular_mean):
    """Return, for mistakes, the rotation of the means of roll, pitch and yaw."""
    matrices = np.zeros((len(rotations), 4, 4)) + np.eye(4)
    matrices[:, :3, :3] = rotations
    return pose_matrix(np.r_[0, 0, 0, mean(state_from_matrix(matrices)[:, 3:], weights)])[:3, :3]


def screw_end(v, omega):
    """Place (3,) [m] after one second with velocity `v` (3,) [m/s] and turn rate `omega` (3,) [rad/s], own axes."""
    # The integral of Exp(s omega) v over s from 0 to 1, by Rodrigues' formula.
    theta = np.linalg.norm(omega)
    once, twice = np.cross(omega, v), np.cross(omega, np.cross(omega, v))
    if theta < 1e-3:
        return v + once / 2 + twice / 6
    return v + (1 - np.cos(theta)) / theta**2 * once + (theta - np.sin(theta)) / theta**3 * twice


def a_screw(rng: np.random.Generator) -> tuple:
    return rng.uniform(-2, 2, 3), rng.uniform(-1.5, 1.5, 3)


# fmt: off
EXERCISES = [
    Exercise("F2.1", open_door, a_door, "warm-up", cases={
        "a hinge in the origin": lambda rng: a_door(rng, hinge=np.zeros(3)),
        "an axis of length one": lambda rng: a_door(rng, length=1.0),
        "a door that stays shut": lambda rng: a_door(rng, angle=0.0),
    }),
    Exercise("F2.2", mean_rotation, a_cloud, tolerance=1e-4, cases={
        "about half a turn": lambda rng: a_cloud(rng, rotation_exp(np.array([0.0, 0.0, np.pi]))),
        "looking straight down": lambda rng: a_cloud(rng, rotation_exp(np.array([0.0, np.pi / 2, 0.0]))),
        "a single rotation": lambda rng: a_cloud(rng, n=1),
        "equal weights": lambda rng: (a_cloud(rng)[0], np.full(6, 0.5)),
    }, functions={
        rotation_mean: "That is the rotation nearest to the mean matrix. There the weighted Logs do not cancel.",
    }),
    Exercise("F2.3", screw_end, a_screw, "challenge", cases={
        "no turn": lambda rng: (rng.uniform(0.5, 2, 3), np.zeros(3)),
        "a turn about the direction of travel": lambda rng: (np.array([1.5, 0, 0]), np.array([0.7, 0, 0])),
        "a full circle": lambda rng: (np.array([1.0, 0.5, 0.3]), np.array([0, 0, 2 * np.pi])),
    }),
]
