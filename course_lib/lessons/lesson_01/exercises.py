"""Exercises of lesson 01: points to the world, a state from an optical pose, a motion, another program's angles."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import BODY_FROM_OPTICAL, optical_pose, pose_matrix, state_from_matrix, wrap_angle
from course_lib.lessons.kit.exercises import Exercise


def random_state(rng: np.random.Generator) -> np.ndarray:
    """A state whose angles are all clear of zero, on either side, so that a mistake in any of them shows."""
    angles = rng.uniform(0.2, [1.2, 1.2, 3.0]) * rng.choice([-1, 1], 3)
    return np.concatenate([rng.uniform([0, -2, 0.5], [30, 2, 2]), angles])


# 01.1: from the optical frame to the world


def to_world(points, state):
    """World coordinates (K, 3) [m] of points (K, 3) given in the optical frame of a camera at `state`."""
    # Optical to body to world; rows, so every matrix is transposed.
    matrix = pose_matrix(state)
    body = points @ BODY_FROM_OPTICAL.T
    return body @ matrix[:3, :3].T + matrix[:3, 3]


def points_and_state(rng: np.random.Generator) -> tuple:
    return rng.uniform([-2, -1, 1], [2, 1, 8], (rng.integers(4, 8), 3)), random_state(rng)


def a_level_camera(rng: np.random.Generator) -> tuple:
    """The paper's wagon, facing the way it came from: only x, y and yaw are not zero."""
    return points_and_state(rng)[0], np.array([10.0, -0.4, 1.2, 0.0, 0.0, np.deg2rad(179.5)])


def one_point(rng: np.random.Generator) -> tuple:
    points, state = points_and_state(rng)
    return points[:1], state


# 01.2: the state of an optical pose


def state_of(matrix):
    """State (6,) [m, rad] of a camera-to-world matrix (4, 4) in the optical convention."""
    # Undo the optical frame on the right, then read the angles.
    R = matrix[:3, :3] @ BODY_FROM_OPTICAL.T
    roll = np.arctan2(R[2, 1], R[2, 2])
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    yaw = np.arctan2(R[1, 0], R[0, 0])
    return np.array([*matrix[:3, 3], roll, pitch, yaw])


def an_optical_pose(rng: np.random.Generator) -> tuple:
    return (optical_pose(random_state(rng)),)


def facing_back(rng: np.random.Generator) -> tuple:
    """Just across the wrap: yaw -179.5 degrees, with roll and pitch on either side of zero."""
    return (optical_pose(np.array([3.0, 1.0, 1.2, 0.3, -0.4, np.deg2rad(-179.5)])),)


def hardly_turned(rng: np.random.Generator) -> tuple:
    """Nearly the task's own example. Without any turn B B is a pitch of 90 degrees, where two ways to read differ."""
    return (optical_pose(np.array([3.0, 4.0, 1.0, 0.02, -0.01, 0.03])),)


# 01.3: the motion between two poses


def motion(before, after):
    """State (6,) [m, rad] of the pose `after`, seen from the pose `before`."""
    # Out of the second frame into the world, then back into the first.
    return state_from_matrix(np.linalg.inv(pose_matrix(before)) @ pose_matrix(after))


def two_states(rng: np.random.Generator) -> tuple:
    """A tilted pose and the next one, a step and a turn of any direction later."""
    before = random_state(rng)
    step = rng.uniform(0.2, [0.8, 0.8, 0.8, 0.5, 0.5, 0.5]) * rng.choice([-1, 1], 6)
    return before, state_from_matrix(pose_matrix(before) @ pose_matrix(step))


def over_the_seam(rng: np.random.Generator) -> tuple:
    """A level wagon whose yaw goes from 179 to -179 degrees."""
    before = np.array([5.0, 0.3, 1.0, 0.0, 0.0, np.deg2rad(179)])
    return before, before + np.array([-0.1, 0.02, 0, 0, 0, np.deg2rad(-358)])


def at_rest(rng: np.random.Generator) -> tuple:
    state = random_state(rng)
    return state, state.copy()


def subtracted(before, after):
    """A mistake: the numbers are subtracted."""
    return np.concatenate([(after - before)[:3], wrap_angle(after - before)[3:]])


def step_along(axes_of, before, after):
    """A mistake: the step along the axes of another pose."""
    return np.concatenate([pose_matrix(axes_of)[:3, :3].T @ (after - before)[:3], motion(before, after)[3:]])


def inverse_behind(before, after):
    """A mistake: the inverse on the wrong side, so that the turn is told in the world."""
    return state_from_matrix(pose_matrix(after) @ np.linalg.inv(pose_matrix(before)))


# 01.4: which rules does another program follow?


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


def of_a_program(rng: np.random.Generator, axes: str, signs: tuple) -> tuple:
    """Angles that a program writes by these rules (scipy's names of axes), their rotations, and new angles."""
    turns = np.column_stack([rng.uniform(-3, 3, 7), rng.uniform(-1.2, 1.2, (7, 2))])
    rotations = Rotation.from_euler("ZYX", turns)
    written = rotations.as_euler(axes, degrees=True) * signs
    return written[:4], rotations.as_matrix()[:4], written[4:]


def some_program(rng: np.random.Generator) -> tuple:
    axes = "".join(rng.permutation(list(rng.choice(["XYZ", "xyz"]))))
    return of_a_program(rng, axes, rng.choice([1, -1], 3))


def this_course(rng: np.random.Generator) -> tuple:
    return of_a_program(rng, "xyz", (1, 1, 1))


def an_airplane(rng: np.random.Generator) -> tuple:
    """Heading, pitch, roll of a body whose y points to the right and z down."""
    return of_a_program(rng, "ZYX", (-1, -1, 1))


def a_level_first_pose(rng: np.random.Generator) -> tuple:
    """An airplane whose first pose is all zeros, as many recordings begin: that one alone fits every reading."""
    angles, rotations, new = an_airplane(rng)
    angles[0], rotations[0] = 0.0, np.eye(3)
    return angles, rotations, new


# fmt: off
EXERCISES = [
    Exercise("01.1", to_world, points_and_state, "warm-up", cases=[a_level_camera, one_point], mistakes="""
        points @ BODY_FROM_OPTICAL.T => points
        You treat right, down, forward as if they were forward, left, up: first turn into the body frame.
        BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL
        Your turn from optical to body runs backwards. For rows of points its matrix must be transposed.
        [:3, :3].T => [:3, :3]
        [:3, :3].T => [:3, :3] and also BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL
        body @ matrix[:3, :3].T => points @ optical_pose(state)[:3, :3]
        Your rotation turns the wrong way. Points are rows here: each matrix on their right is transposed.
        + matrix[:3, 3] =>
        The points are turned, but still counted from the camera: its position is missing.
        body @ matrix[:3, :3].T + matrix[:3, 3] => (body + matrix[:3, 3]) @ matrix[:3, :3].T
        body @ matrix[:3, :3].T + matrix[:3, 3] => (points + matrix[:3, 3]) @ optical_pose(state)[:3, :3].T
        You move first and turn then, so the position is turned, too. Turn first, then move.
        matrix[:3, :3].T => Rotation.from_euler("XYZ", state[3:]).as_matrix().T
        Your turns come in another order. Rz Ry Rx: roll acts first, so it stands on the right.
        body @ matrix[:3, :3].T + matrix[:3, 3] => (points - matrix[:3, 3]) @ matrix[:3, :3] @ BODY_FROM_OPTICAL
        body @ matrix[:3, :3].T + matrix[:3, 3] => (body - matrix[:3, 3]) @ matrix[:3, :3]
        You go from the world into the camera: `pose_matrix` leads from the body to the world already, no inverse.
        body @ matrix[:3, :3].T => points @ matrix[:3, :3].T @ BODY_FROM_OPTICAL.T
        Your R acts before B. What acts first stands next to the point: R B p.
        pose_matrix(state) => pose_matrix(state * [1, 1, 1, 0, 0, 1])
        You use yaw alone. The camera may be tilted and rolled as well.
        pose_matrix(state) => pose_matrix(state[[0, 1, 2, 5, 4, 3]])
        pose_matrix(state) => pose_matrix(np.concatenate([state[:3], np.deg2rad(state[3:])]))
        A state's last three numbers are roll, pitch, yaw, in this order and in radians already.
        return body @ matrix[:3, :3].T + matrix[:3, 3] => return body
        That is the body frame. One more step leads to the world: the camera's pose.
        points @ BODY_FROM_OPTICAL.T => points[:, [2, 0, 1]]
        points @ BODY_FROM_OPTICAL.T => points @ BODY_FROM_OPTICAL.T * [1, -1, 1]
        points @ BODY_FROM_OPTICAL.T => points @ BODY_FROM_OPTICAL.T * [1, 1, -1]
        The axes are right, but not their signs: right is *minus* left, and down is *minus* up.
    """),
    Exercise("01.2", state_of, an_optical_pose, cases=[facing_back, hardly_turned], mistakes="""
        @ BODY_FROM_OPTICAL.T =>
        You read the angles of the optical frame. The state is that of the body: undo B first.
        matrix[:3, :3] @ BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL.T @ matrix[:3, :3]
        matrix[:3, :3] @ BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL @ matrix[:3, :3]
        ... => return state_from_matrix(np.vstack([BODY_FROM_OPTICAL.T @ matrix[:3], matrix[3]]))
        BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL
        The block is R B: undo B on its right, with its transpose. Yours is on the left, or applies B once more.
        *matrix[:3, 3], => *BODY_FROM_OPTICAL @ matrix[:3, 3],
        *matrix[:3, 3], => *-matrix[:3, :3].T @ matrix[:3, 3],
        *matrix[:3, 3], => 0, 0, 0,
        The position is the last column of the matrix as it is, in the world already: no B, no inverse.
        ... => return state_of(np.linalg.inv(matrix))
        You inverted the matrix. It is camera-to-world already: its last column is the position.
        roll, pitch, yaw]) => 0, pitch, yaw])
        roll, pitch, yaw]) => 0, 0, yaw])
        Right for a wagon: in yours an angle is always 0. A camera in a hand rolls and is tilted, too.
        roll, pitch, yaw]) => *Rotation.from_matrix(R).as_euler("zyx")[::-1]])
        The course's order is scipy's "ZYX", with capitals. Small letters turn about axes that stay put.
        roll, pitch, yaw]) => yaw, pitch, roll])
        [*matrix[:3, 3], roll, pitch, yaw] => [roll, pitch, yaw, *matrix[:3, 3]]
        The six numbers are right, but in another order: x, y, z, roll, pitch, yaw.
        BODY_FROM_OPTICAL.T => BODY_FROM_OPTICAL.T; R = R.T
        Your R is transposed: its angles are those of the way back, from world to body.
        np.hypot(R[0, 0], R[1, 0]) => R[0, 0]
        np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0])) => np.arctan(-R[2, 0])
        -R20 is the *sine* of the pitch: take its arcsin, or divide by its cosine, the root of R00^2 + R10^2.
        R[2, 1], R[2, 2] => R[2, 2], R[2, 1] and also R[1, 0], R[0, 0] => R[0, 0], R[1, 0]
        np.arctan2 takes the sine part first: R21 before R22, and R10 before R00.
        roll, pitch, yaw]) => roll, pitch, yaw % (2 * np.pi)])
        roll, pitch, yaw]) => *np.mod([roll, pitch, yaw], 2 * np.pi)])
        roll, pitch, yaw]) => *np.rad2deg([roll, pitch, yaw])])
        A state's angles are in radians, from -pi to pi: yours are in degrees, or run from 0 to 2 pi.
    """),
    Exercise("01.3", motion, two_states, cases=[over_the_seam, at_rest], mistakes="""
        ... => return after - before
        ... => return subtracted(before, after)
        You subtract the numbers. The camera's own forward is not the world's x, and turns do not subtract.
        ... => return np.r_[motion(before, after)[:3], subtracted(before, after)[3:]]
        ... => return np.r_[motion(before, after)[:3], (after - before)[3:]]
        The step is right. The angles of two turns cannot be subtracted: multiply matrices, then read angles.
        ... => return np.r_[step_along(before * [0, 0, 0, 0, 0, 1], before, after)[:3], subtracted(before, after)[3:]]
        ... => return step_along(before * [0, 0, 0, 0, 0, 1], before, after)
        Right for a wagon: you turn by yaw alone. A camera that is tilted or rolled needs the whole of R.
        ... => return step_along(np.zeros(6), before, after)
        The turn is right. Your step counts along the world's axes: turn it into the first camera's frame.
        ... => return inverse_behind(before, after)
        ... => return inverse_behind(after, before)
        The inverse is on the wrong side: what is in the world must go into the first camera's frame *last*.
        np.linalg.inv(pose_matrix(before)) => pose_matrix(before)
        You go from body to world twice. One of the two has to be undone.
        ... => return np.r_[motion(before, after)[:3], inverse_behind(before, after)[3:]]
        The step is right. Your turn is told in the world: put the undone rotation on the left of the other.
        ... => return np.r_[pose_matrix(before)[:3, :3] @ (after - before)[:3], motion(before, after)[3:]]
        ... => return step_along(after, before, after)
        The turn is right. The step goes from the world into the *first* body frame: R of `before`, transposed.
        ... => return motion(before, after) * [1, 1, 1, 180 / np.pi, 180 / np.pi, 180 / np.pi]
        Your angles are in degrees; a state holds radians.
        pose_matrix => optical_pose
        That is the motion in the *optical* frame: right, down, forward. The task asks for the body frame.
    """),
    Exercise("01.4", decode, some_program, "challenge", cases=[
        this_course, an_airplane, a_level_first_pose,
    ], mistakes="""
        ... => return np.deg2rad(new)
        ... => return np.deg2rad(new)[:, ::-1]
        You read the columns without a look at the given matrices. What do these say about orders and signs?
        ("XYZ", "xyz") => ("XYZ",)
        ("XYZ", "xyz") => ("xyz",)
        You multiply the turns in one way only. The first column may act first, or the last: try both.
        product((1, -1), repeat=3)) => [(1, 1, 1)])
        You never try a negative sign: an airplane's pitch is positive upward.
        product((1, -1), repeat=3)) => [(1, 1, 1), (-1, -1, -1)])
        You give all three columns one sign. Each column may have its own: 8 mixtures.
        key=misfit) => key=misfit); return np.deg2rad(new * signs)[:, np.argsort(list(axes.lower()))]
        You sort columns and mend signs. But turns in another order have other angles: go through matrices.
        ... => return decode(angles, rotations.transpose(0, 2, 1), new)
        You compare with the transposed matrices: those turn the other way.
        ... => return decode(angles[:1], rotations[:1], new)
        You compare the first pose alone. Where its angles are 0 every reading fits: compare all of them.
        "ZYX" => "zyx"
        At the end, scipy's small letters turn about axes that stay put. The course's order is "ZYX".
        [:, ::-1] =>
        The reading is right, but yours returns yaw, pitch, roll. The task asks for roll, pitch, yaw.
        permutations(names) => [names]
        You take it that the columns turn about forward, left, up in this order. There are six orders.
    """),
]
