"""Exercises of lesson 01: points to the world, a state from an optical pose, a motion, another program's angles."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import BODY_FROM_OPTICAL, optical_pose, pose_matrix, state_from_matrix, wrap_angle
from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        points @ BODY_FROM_OPTICAL.T => points
        You treat right, down, forward as if they were forward, left, up. First turn into the body frame.
        BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL
        Your turn from optical to body runs backwards. For rows of points its matrix must be transposed.
        [:3, :3].T => [:3, :3]
        Your rotation turns the wrong way. Points are rows here, so you must transpose each matrix on their right.
        + matrix[:3, 3] =>
        The points are turned, but you still count from the camera. Its position is missing.
        body @ matrix[:3, :3].T + matrix[:3, 3] => (body + matrix[:3, 3]) @ matrix[:3, :3].T
        You move first and turn then, so you turn the position, too. Turn first, then move.
        body @ matrix[:3, :3].T + matrix[:3, 3] => (points - matrix[:3, 3]) @ matrix[:3, :3] @ BODY_FROM_OPTICAL
        body @ matrix[:3, :3].T + matrix[:3, 3] => (body - matrix[:3, 3]) @ matrix[:3, :3]
        You go from the world into the camera. `pose_matrix` leads from the body to the world, so invert nothing.
        body @ matrix[:3, :3].T => points @ matrix[:3, :3].T @ BODY_FROM_OPTICAL.T
        Your R acts before B. The matrix that acts first stands next to the point: R B p.
        pose_matrix(state) => pose_matrix(state * [1, 1, 1, 0, 0, 1])
        You use yaw alone. The camera may be tilted and rolled as well.
        points @ BODY_FROM_OPTICAL.T => points[:, [2, 0, 1]]
        The axes are right, but not their signs: right is *minus* left, and down is *minus* up.
    """),
    Exercise("01.2", state_of, lambda rng: (optical_pose(random_state(rng)),), cases={
        "yaw just across the wrap": lambda rng: (optical_pose(np.array([3.0, 1.0, 1.2, 0.3, -0.4, -3.13])),),
        # Without any turn B B is a pitch of 90 degrees, where two ways to read differ.
        "hardly turned": lambda rng: (optical_pose(np.array([3.0, 4.0, 1.0, 0.02, -0.01, 0.03])),),
    }, mistakes="""
        @ BODY_FROM_OPTICAL.T =>
        You read the angles of the optical frame, but the state is about the body. Undo B first.
        matrix[:3, :3] @ BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL.T @ matrix[:3, :3]
        BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL
        The block is R B. Undo B on its right, with its transpose. Yours is on the left, or applies B once more.
        *matrix[:3, 3], => *BODY_FROM_OPTICAL @ matrix[:3, 3],
        *matrix[:3, 3], => *-matrix[:3, :3].T @ matrix[:3, 3],
        The position is the last column of the matrix, already in the world. It needs no B and no inverse.
        ... => return state_of(np.linalg.inv(matrix))
        You inverted the matrix, but it is camera-to-world already. Its last column is the position.
        roll, pitch, yaw]) => *Rotation.from_matrix(R).as_euler("zyx")[::-1]])
        The course's order is scipy's "ZYX", with capitals. Small letters turn about axes that stay put.
        roll, pitch, yaw]) => yaw, pitch, roll])
        The six numbers are right, but in another order: x, y, z, roll, pitch, yaw.
        BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL.T; R = R.T
        Your R is transposed, so you read the angles of the way back, from world to body.
        np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0])) => np.arctan(-R[2, 0])
        -R20 is the *sine* of the pitch. Take its arcsin, or divide by its cosine, the root of R00^2 + R10^2.
        roll, pitch, yaw]) => *np.mod([roll, pitch, yaw], 2 * np.pi)])
        roll, pitch, yaw]) => *np.rad2deg([roll, pitch, yaw])])
        A state's angles are in radians, from -pi to pi. Yours are in degrees, or run from 0 to 2 pi.
    """),
    Exercise("01.3", motion, two_states, cases={
        "yaw over the wrap": lambda rng: tuple(np.array([[5, 0, 1, 0, 0, 3.1], [4.9, 0, 1, 0, 0, -3.1]])),
        "at rest": lambda rng: (random_state(rng),) * 2,
    }, mistakes="""
        ... => return after - before
        ... => return subtracted(before, after)
        You subtract the numbers. The camera's own forward is not the world's x, and turns do not subtract.
        ... => return np.r_[motion(before, after)[:3], subtracted(before, after)[3:]]
        The step is right. You cannot subtract the angles of two turns: multiply matrices, then read angles.
        ... => return np.r_[motion(before * [1, 1, 1, 0, 0, 1], after)[:3], subtracted(before, after)[3:]]
        Yours is right for a wagon, because you turn by yaw alone. A tilted camera needs the whole of R.
        ... => return np.r_[(after - before)[:3], motion(before, after)[3:]]
        The turn is right. Your step counts along the world's axes. Turn it into the first camera's frame.
        ... => return state_from_matrix(pose_matrix(after) @ np.linalg.inv(pose_matrix(before)))
        The inverse is on the wrong side. The step into the first camera's frame comes *last*.
        np.linalg.inv(pose_matrix(before)) => pose_matrix(before)
        You go from body to world twice. You must undo one of the two.
        ... => return np.r_[pose_matrix(before)[:3, :3] @ (after - before)[:3], motion(before, after)[3:]]
        ... => return np.r_[-motion(after, before)[:3], motion(before, after)[3:]]
        The turn is right. The step goes from the world into the *first* body frame: R of `before`, transposed.
        pose_matrix => optical_pose
        That is the motion in the *optical* frame: right, down, forward. The task asks for the body frame.
    """),
    Exercise("01.4", decode, a_program, "challenge", cases={
        "this course": lambda rng: a_program(rng, "xyz", (1, 1, 1)),
        "an airplane": lambda rng: a_program(rng, "ZYX", (-1, -1, 1)),
        # Many recordings begin with a pose of zeros. That one alone fits every reading.
        "a level first pose": lambda rng: a_program(rng, "ZYX", (-1, -1, 1), first_turn=0.0),
    }, mistakes="""
        ... => return np.deg2rad(new)
        ... => return np.deg2rad(new)[:, ::-1]
        You read the columns without a look at the given matrices. What do these say about orders and signs?
        ("XYZ", "xyz") => ("XYZ",)
        ("XYZ", "xyz") => ("xyz",)
        You multiply the turns in one way only. The first column may act first, or the last, so try both.
        product((1, -1), repeat=3)) => [(1, 1, 1)])
        You never try a negative sign. An airplane's pitch is positive upward.
        key=misfit) => key=misfit); return np.deg2rad(new * signs)[:, np.argsort(list(axes.lower()))]
        You sort columns and mend signs. But turns in another order have other angles, so go through matrices.
        ... => return decode(angles, rotations.transpose(0, 2, 1), new)
        You compare with the transposed matrices, but those turn the other way.
        ... => return decode(angles[:1], rotations[:1], new)
        You compare the first pose alone. Where its angles are 0 every reading fits, so compare all of them.
        "ZYX" => "zyx"
        At the end, scipy's small letters turn about axes that stay put. The course's order is "ZYX".
        [:, ::-1] =>
        The reading is right, but yours returns yaw, pitch, roll. The task asks for roll, pitch, yaw.
        permutations(names) => [names]
        You take it that the columns turn about forward, left, up in this order. There are six orders.
    """),
]
