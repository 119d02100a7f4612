"""Exercises of F2: a door on its hinge, a mean of rotations, the end of a screw motion."""

import numpy as np

from course_lib.geometry import circular_mean, pose_matrix, rotation_exp, rotation_log, rotation_mean, state_from_matrix
from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        angle * axis / np.linalg.norm(axis) => angle * axis
        rotation_exp(angle * axis / np.linalg.norm(axis)) => rodrigues(axis, angle)
        Yours is right only for an axis of length one. The angle alone says how far to turn.
        hinge + (points - hinge) @ R.T => points @ R.T
        You turn about a line through the origin. Which point of a door does not move?
        hinge + (points => (points
        You turn about the hinge, but you still count from it. Go back to the origin at the end.
        hinge + (points - hinge) => hinge + points
        You turn the points about the origin and then shift them. Count from the hinge before you turn.
        hinge + (points - hinge) @ R.T => (points - hinge) @ R.T - hinge
        hinge + (points - hinge) @ R.T => (points + hinge) @ R.T - hinge
        The two shifts must cancel: one subtracts the hinge, the other adds it. Which one comes first?
        @ R.T => @ R
        Your door opens the other way. The points are rows, so their matrix on the right is transposed.
        angle * axis / np.linalg.norm(axis) => np.array([0, 0, angle])
        You turn about the vertical, whatever the axis is.
        rotation_exp(angle * axis / np.linalg.norm(axis)) => rotation_exp(axis / np.linalg.norm(axis))
        You turn by one radian about the axis. Where does the angle come in?
        rotation_exp(angle * axis / np.linalg.norm(axis)) => rodrigues(axis / np.linalg.norm(axis), angle, angle, 0)
        You take the first two terms of the series alone. Then the points leave their circle: use the whole of Exp.
        rotation_exp(angle * axis / np.linalg.norm(axis)) => rodrigues(axis / np.linalg.norm(axis), angle, third=0)
        rotation_exp(angle * axis / np.linalg.norm(axis)) => rodrigues(axis / np.linalg.norm(axis), angle, first=0)
        rotation_exp(angle * axis / np.linalg.norm(axis)) => \
rodrigues(axis / np.linalg.norm(axis), angle, third=0) + (np.cos(angle) - 1) * np.eye(3)
        One of Rodrigues' three terms is missing. What lies along the axis stays, the rest follows cosine and sine.
        rotation_exp(angle * axis / np.linalg.norm(axis)) => \
rodrigues(axis / np.linalg.norm(axis), angle, third=np.cos(angle))
        At an angle of zero R must be I. Look at the factor of K^2.
        rotation_exp(angle * axis / np.linalg.norm(axis)) => \
rodrigues(axis / np.linalg.norm(axis), angle, square=np.square)
        `K**2` squares every entry. The matrix times itself is `K @ K`.
    """),
    Exercise("F2.2", mean_rotation, a_cloud, tolerance=1e-4, cases={
        "about half a turn": lambda rng: a_cloud(rng, rotation_exp(np.array([0.0, 0.0, np.pi]))),
        "looking straight down": lambda rng: a_cloud(rng, rotation_exp(np.array([0.0, np.pi / 2, 0.0]))),
        "a single rotation": lambda rng: a_cloud(rng, n=1),
        "equal weights": lambda rng: (a_cloud(rng)[0], np.full(6, 0.5)),
    }, mistakes="""
        range(50) => range(1)
        range(50) => range(2)
        A step or two are not enough. Average again from the place where you arrived, until nothing moves.
        ... => return mean_of_angles(rotations, weights)
        ... => return mean_of_angles(rotations, np.ones(len(weights)))
        ... => return mean_of_angles(rotations, weights, lambda a, w: w @ a / w.sum())
        You average roll, pitch and yaw. Look at your answer for a camera that looks straight down.
        ... => return rotation_exp(weights @ rotation_log(rotations) / weights.sum())
        ... => return rotation_exp(rotation_log(rotations).mean(axis=0))
        Your Log counts from no turn at all. Half a turn away from there it has its seam: count from inside the cloud.
        ... => return np.tensordot(weights, rotations, 1) / weights.sum()
        A mean of matrices is no rotation, because it shrinks. Average rotation vectors.
        weights @ rotation_log(M.T @ rotations) / weights.sum() => rotation_log(M.T @ rotations).mean(axis=0)
        ... => return rotation_mean(rotations)
        You do not use the weights.
        / weights.sum() =>
        / weights.sum() => / len(weights)
        The weights do not sum to one, so your steps are too long.
        M @ rotation_exp(weights @ rotation_log(M.T @ rotations) / weights.sum()) => \
rotation_exp(weights @ rotation_log(M.T @ rotations) / weights.sum()) @ M
        Log(M^T R) counts along the axes of M. A motion in own axes stands on the right of M.
        rotation_log(M.T @ rotations) => rotation_log(M @ rotations)
        The turn from M to R is M^T R. Yours multiplies M and R.
        ... => return rotations[np.argmax(weights)]
        ... => return rotations[0]
        That is one of the given rotations. All of them count.
    """, functions={
        rotation_mean: "That is the rotation nearest to the mean matrix. There the weighted Logs do not cancel.",
    }),
    Exercise("F2.3", screw_end, a_screw, "challenge", cases={
        "no turn": lambda rng: (rng.uniform(0.5, 2, 3), np.zeros(3)),
        "a turn about the direction of travel": lambda rng: (np.array([1.5, 0, 0]), np.array([0.7, 0, 0])),
        "a full circle": lambda rng: (np.array([1.0, 0.5, 0.3]), np.array([0, 0, 2 * np.pi])),
    }, mistakes="""
        ... => return v
        That is the end of the straight step. Here the direction changes on the way.
        ... => return rotation_exp(omega) @ v
        You turn first and walk afterwards. Both happen at the same time.
        ... => return rotation_exp(omega / 2) @ v
        That points the right way if the path is flat, but a chord is shorter than its arc.
        ... => return rotation_exp(omega / 2) @ v * np.sinc(np.linalg.norm(omega) / 2 / np.pi)
        That is right for a flat path alone. If v has a part along omega, this part does not bend.
        ... => return (v + rotation_exp(omega) @ v) / 2
        ... => return np.mean([rotation_exp(s * omega) @ v for s in np.linspace(0, 0.9, 10)], axis=0)
        You add up a few directions. On the way there is one for every moment: integrate.
        ... => return v + np.cross(omega, v) / 2
        The series does not end after its second term. Integrate cosine and sine instead.
        / theta**2 * once => / theta * once and also / theta**3 * twice => / theta**2 * twice
        / theta**2 * once => / theta * once
        / theta**3 * twice => / theta**2 * twice
        A power of theta is missing: one from k = omega / theta each time, and one more from the integral.
        + (theta - np.sin(theta)) / theta**3 * twice =>
        The double cross product is missing. It carries 1 - cosine, whose integral is theta - sine.
        (1 - np.cos(theta)) / theta**2 * once => np.sin(theta) / theta * once
        That is Rodrigues' formula itself, or half of it. Integrate sine over the way: (1 - cosine) / theta.
        np.cross(omega, v), => np.cross(v, omega),
        omega cross v points to the inside of the curve. Yours bends to the other side.
        if theta < 1e-3: => if False:
        Right while there is a turn. Without one yours is 0 / 0.
    """),
]
