"""Exercises of lesson 01: points to the world, a state from an optical pose, a motion, another program's angles."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import BODY_FROM_OPTICAL, optical_pose, pose_matrix, state_from_matrix, wrap_angle
from courseware.lessons.kit.exercise import Exercise


def random_state(rng: np.random.Generator) -> np.ndarray:
    """Return a state whose angles are clear of zero, on either side, so that a mistake in any of them shows."""
    angles = rng.uniform(0.2, [1.2, 1.2, 3.0]) * rng.choice([-1, 1], 3)
    return np.concatenate([rng.uniform([0, -2, 0.5], [30, 2, 2]), angles])


def to_world(points, state):
    """World coordinates (K, 3) [m] of points (K, 3) given in the optical frame of a camera at `state`."""
    # Optical to body to world; rows, so every matrix is transposed.
    matrix = pose_matrix(state)
    body = points @ BODY_FROM_OPTICAL.T
    return body @ matrix[:3, :3].T + matrix[:3, 3]


def points_and_state(rng: np.random.Generator, n: int = 6) -> tuple:
    return rng.uniform([-2, -1, 1], [2, 1, 8], (n, 3)), random_state(rng)


def state_of(matrix):
    """State (6,) [m, rad] of a camera-to-world matrix (4, 4) in the optical convention."""
    # Undo the optical frame on the right, then read the angles.
    R = matrix[:3, :3] @ BODY_FROM_OPTICAL.T
    roll = np.arctan2(R[2, 1], R[2, 2])
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    yaw = np.arctan2(R[1, 0], R[0, 0])
    return np.array([*matrix[:3, 3], roll, pitch, yaw])


def motion(before, after):
    """State (6,) [m, rad] of the pose `after`, seen from the pose `before`."""
    # Out of the second frame into the world, then back into the first.
    return state_from_matrix(np.linalg.inv(pose_matrix(before)) @ pose_matrix(after))


def two_states(rng: np.random.Generator) -> tuple:
    """Return a tilted pose and the next one, a step and a turn of any direction later."""
    before = random_state(rng)
    step = rng.uniform(0.2, [0.8, 0.8, 0.8, 0.5, 0.5, 0.5]) * rng.choice([-1, 1], 6)
    return before, state_from_matrix(pose_matrix(before) @ pose_matrix(step))


def subtracted(before, after):
    """Return, for mistakes, the difference of the numbers, with its angles from -pi to pi."""
    return np.r_[(after - before)[:3], wrap_angle(after - before)[3:]]


def decode(angles, rotations, new):
    """Roll, pitch, yaw (M, 3) [rad] of `new` angles (M, 3), by the reading under which `angles` give `rotations`."""
    # Try all 96 readings; the one that makes the given matrices is right for the new angles, too.
    from itertools import permutations, product

    from scipy.spatial.transform import Rotation

    def matrices(rows, axes, signs):
        # In capitals, scipy multiplies the turns in the order of the columns, else in the reverse order.
        return Rotation.from_euler(axes, rows * signs, degrees=True).as_matrix()

    def misfit(reading):
        return np.abs(matrices(angles, *reading) - rotations).max()

    orders = ["".join(order) for names in ("XYZ", "xyz") for order in permutations(names)]
    axes, signs = min(product(orders, product((1, -1), repeat=3)), key=misfit)
    return Rotation.from_matrix(matrices(new, axes, signs)).as_euler("ZYX")[:, ::-1]


def a_program(rng: np.random.Generator, axes: str = "", signs=None, first_turn: float = 1.0) -> tuple:
    """Return angles that a program writes by these rules (default: any), their rotations, and new angles."""
    axes = axes or "".join(rng.permutation(list(rng.choice(["XYZ", "xyz"]))))  # as in scipy
    turns = np.column_stack([rng.uniform(-3, 3, 7), rng.uniform(-1.2, 1.2, (7, 2))])
    turns[0] *= first_turn
    rotations = Rotation.from_euler("ZYX", turns)
    written = rotations.as_euler(axes, degrees=True) * (rng.choice([1, -1], 3) if signs is None else signs)
    return written[:4], rotations.as_matrix()[:4], written[4:]


# fmt: off
EXERCISES = [
    Exercise("01.1", to_world, points_and_state, "warm-up", cases={
        "a level camera that faces back": lambda rng: (points_and_state(rng)[0], np.array([10, -0.4, 1.2, 0, 0, 3.13])),
        "one point": lambda rng: points_and_state(rng, 1),
    }),
    Exercise("01.2", state_of, lambda rng: (optical_pose(random_state(rng)),), cases={
        "yaw just across the wrap": lambda rng: (optical_pose(np.array([3.0, 1.0, 1.2, 0.3, -0.4, -3.13])),),
        # Without any turn B B is a pitch of 90 degrees, where two ways to read differ.
        "hardly turned": lambda rng: (optical_pose(np.array([3.0, 4.0, 1.0, 0.02, -0.01, 0.03])),),
    }),
    Exercise("01.3", motion, two_states, cases={
        "yaw over the wrap": lambda rng: tuple(np.array([[5, 0, 1, 0, 0, 3.1], [4.9, 0, 1, 0, 0, -3.1]])),
        "at rest": lambda rng: (random_state(rng),) * 2,
    }),
    Exercise("01.4", decode, a_program, "challenge", cases={
        "this course": lambda rng: a_program(rng, "xyz", (1, 1, 1)),
        "an airplane": lambda rng: a_program(rng, "ZYX", (-1, -1, 1)),
        # Many recordings begin with a pose of zeros. That one alone fits every reading.
        "a level first pose": lambda rng: a_program(rng, "ZYX", (-1, -1, 1), first_turn=0.0),
    }),
]
