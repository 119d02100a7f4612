"""Exercises of lesson 01: points to the world, a state from an optical pose, a motion, another program's angles."""

import itertools

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import BODY_FROM_OPTICAL, optical_pose, pose_matrix, state_from_matrix, wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 01.1: from the optical frame to the world


def to_world(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    """World coordinates (K, 3) [m] of points (K, 3) in the optical frame of a camera at `state`."""
    return _moved(points @ BODY_FROM_OPTICAL.T, pose_matrix(state))


def _moved(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def _random_state(rng: np.random.Generator) -> np.ndarray:
    """A state whose angles are all clear of zero, on either side: a mistake in any of them shows."""
    angles = rng.uniform(0.2, [1.2, 1.2, 3.0]) * rng.choice([-1, 1], 3)
    return np.concatenate([rng.uniform([0, -2, 0.5], [30, 2, 2]), angles])


def _points_and_state(rng: np.random.Generator) -> tuple:
    points = rng.uniform([-2, -1, 1], [2, 1, 8], size=(rng.integers(4, 8), 3))
    return points, _random_state(rng)


def _level_camera(rng: np.random.Generator) -> tuple:
    """The paper's wagon, facing the way it came from: only x, y and yaw are not zero."""
    return _points_and_state(rng)[0], np.array([10.0, -0.4, 1.2, 0.0, 0.0, np.deg2rad(179.5)])


def _one_point(rng: np.random.Generator) -> tuple:
    return rng.uniform([-2, -1, 1], [2, 1, 8], size=(1, 3)), _random_state(rng)


def _turns_in_other_order(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    roll, pitch, yaw = (pose_matrix(np.eye(6)[3 + k] * state[3 + k])[:3, :3] for k in range(3))
    return points @ (roll @ pitch @ yaw @ BODY_FROM_OPTICAL).T + state[:3]


def _into_the_camera(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    return _moved(points, np.linalg.inv(optical_pose(state)))


def _into_the_body(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    return _moved(points @ BODY_FROM_OPTICAL.T, np.linalg.inv(pose_matrix(state)))


def _position_first(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    return (points @ BODY_FROM_OPTICAL.T + state[:3]) @ pose_matrix(state)[:3, :3].T


def _yaw_alone(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    return to_world(points, state * [1, 1, 1, 0, 0, 1])


def _taken_as_degrees(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    return to_world(points, np.concatenate([state[:3], np.deg2rad(state[3:])]))


# 01.2: the state of an optical pose


def state_of(matrix: np.ndarray) -> np.ndarray:
    """State (6,) [m, rad] of a camera-to-world matrix (4, 4) in the optical convention."""
    body = matrix.copy()
    body[:3, :3] = matrix[:3, :3] @ BODY_FROM_OPTICAL.T
    return state_from_matrix(body)


def _optical(rng: np.random.Generator) -> tuple:
    return (optical_pose(_random_state(rng)),)


def _facing_back(rng: np.random.Generator) -> tuple:
    """Just across the wrap: yaw -179.5 degrees, with roll and pitch on either side of zero."""
    return (optical_pose(np.array([3.0, 1.0, 1.2, 0.3, -0.4, np.deg2rad(-179.5)])),)


def _hardly_turned(rng: np.random.Generator) -> tuple:
    """Nearly the task's own example. Without any turn B B is a pitch of 90 degrees, where two ways to read differ."""
    return (optical_pose(np.array([3.0, 4.0, 1.0, 0.02, -0.01, 0.03])),)


def _other_order(matrix: np.ndarray) -> np.ndarray:
    """What scipy's "zyx" reads, small letters: turns about axes that stay put."""
    angles = Rotation.from_matrix(matrix[:3, :3] @ BODY_FROM_OPTICAL.T).as_euler("zyx")
    return np.concatenate([matrix[:3, 3], angles[::-1]])


def _with_rotation(matrix: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    changed = matrix.copy()
    changed[:3, :3] = rotation
    return state_from_matrix(changed)


def _half_circle(matrix: np.ndarray) -> np.ndarray:
    rotation = matrix[:3, :3] @ BODY_FROM_OPTICAL.T
    roll, yaw = np.arctan(rotation[2, 1] / rotation[2, 2]), np.arctan(rotation[1, 0] / rotation[0, 0])
    return np.array([*matrix[:3, 3], roll, state_of(matrix)[4], yaw])


def _left_undone(matrix: np.ndarray) -> np.ndarray:
    return _with_rotation(matrix, BODY_FROM_OPTICAL.T @ matrix[:3, :3])[3:]


def _pitch(matrix: np.ndarray, pitch: float) -> np.ndarray:
    return np.concatenate([state_of(matrix)[:4], [pitch], state_of(matrix)[5:]])


def _pitch_by_one_entry(matrix: np.ndarray) -> np.ndarray:
    rotation = matrix[:3, :3] @ BODY_FROM_OPTICAL.T
    return _pitch(matrix, np.arctan2(-rotation[2, 0], rotation[0, 0]))


def _sine_second(matrix: np.ndarray) -> np.ndarray:
    state = state_of(matrix)
    roll, yaw = wrap_angle(np.pi / 2 - state[[3, 5]])
    return np.array([*state[:3], roll, state[4], yaw])


# 01.3: the motion between two poses


def motion(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """State (6,) of the pose `after`, in the body frame of the pose `before`: what the camera itself did in between."""
    return state_from_matrix(np.linalg.inv(pose_matrix(before)) @ pose_matrix(after))


def _two_states(rng: np.random.Generator) -> tuple:
    """A tilted pose and the next one, a step and a turn of any direction later."""
    before = _random_state(rng)
    step = rng.uniform(0.2, [0.8, 0.8, 0.8, 0.5, 0.5, 0.5]) * rng.choice([-1, 1], 6)
    return before, state_from_matrix(pose_matrix(before) @ pose_matrix(step))


def _over_the_seam(rng: np.random.Generator) -> tuple:
    """A level wagon whose yaw goes from 179 to -179 degrees."""
    before = np.array([5.0, 0.3, 1.0, 0.0, 0.0, np.deg2rad(179)])
    return before, before + np.array([-0.1, 0.02, 0, 0, 0, np.deg2rad(-358)])


def _at_rest(rng: np.random.Generator) -> tuple:
    state = _random_state(rng)
    return state, state.copy()


def _joined(position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, position
    return state_from_matrix(matrix)


def _rotations(before: np.ndarray, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return pose_matrix(before)[:3, :3], pose_matrix(after)[:3, :3]


def _numbers_subtracted(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    return np.concatenate([(after - before)[:3], wrap_angle(after - before)[3:]])


def _angles_subtracted(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    return np.concatenate([motion(before, after)[:3], wrap_angle(after - before)[3:]])


def _step_in_the_world(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    return np.concatenate([(after - before)[:3], motion(before, after)[3:]])


def _by_yaw_alone(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Right for a wagon, that neither rolls nor pitches."""
    step = pose_matrix(before * [0, 0, 0, 0, 0, 1])[:3, :3].T @ (after - before)[:3]
    return np.concatenate([step, wrap_angle(after - before)[3:]])


def _step_by_yaw_alone(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    return np.concatenate([_by_yaw_alone(before, after)[:3], motion(before, after)[3:]])


def _optical_motion(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    return state_from_matrix(np.linalg.inv(optical_pose(before)) @ optical_pose(after))


def _turn_on_the_wrong_side(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    r, s = _rotations(before, after)
    return _joined(r.T @ (after - before)[:3], s @ r.T)


def _step_turned_on(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    r, s = _rotations(before, after)
    return _joined(r @ (after - before)[:3], r.T @ s)


def _step_seen_from_the_second(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    r, s = _rotations(before, after)
    return _joined(s.T @ (after - before)[:3], r.T @ s)


# 01.4, the challenge: which rules does another program follow?

Reading = tuple[tuple[int, ...], tuple[int, ...], bool]
"""Body axis (0 forward, 1 left, 2 up) of each column, sign of each column, and whether the last column acts first."""


def readings() -> list[Reading]:
    """All 96 ways to read three columns of angles."""
    orders, signs = itertools.permutations(range(3)), list(itertools.product((1, -1), repeat=3))
    return [(axes, sign, last) for axes in orders for sign in signs for last in (True, False)]


def rotations_of(angles_deg: np.ndarray, reading: Reading) -> np.ndarray:
    """Rotation matrices `(K, 3, 3)` of angles `(K, 3)` [degrees], read in one way."""
    axes, signs, last_acts_first = reading
    name = "".join("xyz"[axis] for axis in axes)
    # scipy: capitals turn about the body's own axes, so that the last one acts first.
    return Rotation.from_euler(name.upper() if last_acts_first else name, angles_deg * signs, degrees=True).as_matrix()


def decode(angles: np.ndarray, rotations: np.ndarray, new: np.ndarray) -> np.ndarray:
    """Roll, pitch, yaw `(M, 3)` [rad] of `new` angles of a program whose `angles` have known `rotations`."""
    return _best_of(readings(), angles, rotations, new)


def _best_of(candidates: list[Reading], angles: np.ndarray, rotations: np.ndarray, new: np.ndarray) -> np.ndarray:
    best = min(candidates, key=lambda reading: np.abs(rotations_of(angles, reading) - rotations).max())
    return _angles(rotations_of(new, best))


def _angles(rotations: np.ndarray) -> np.ndarray:
    return Rotation.from_matrix(rotations).as_euler("ZYX")[:, ::-1]


def _of_a_program(rng: np.random.Generator, reading: Reading) -> tuple:
    axes, signs, last_acts_first = reading
    name = "".join("xyz"[axis] for axis in axes)
    body = np.column_stack([rng.uniform(-1.2, 1.2, (7, 2)), rng.uniform(-3, 3, 7)])
    rotations = Rotation.from_euler("ZYX", body[:, ::-1])
    written = rotations.as_euler(name.upper() if last_acts_first else name, degrees=True) * signs
    return written[:4], rotations.as_matrix()[:4], written[4:]


def _some_program(rng: np.random.Generator) -> tuple:
    return _of_a_program(rng, readings()[rng.integers(96)])


def _this_course(rng: np.random.Generator) -> tuple:
    return _of_a_program(rng, ((0, 1, 2), (1, 1, 1), False))


def _an_airplane(rng: np.random.Generator) -> tuple:
    """Heading, pitch, roll of a body whose y points to the right and z down."""
    return _of_a_program(rng, ((2, 1, 0), (-1, -1, 1), True))


def _starts_level(rng: np.random.Generator) -> tuple:
    """An airplane whose first pose is all zeros, as many recordings begin: that one alone fits every reading."""
    angles, rotations, new = _an_airplane(rng)
    angles[0], rotations[0] = 0.0, np.eye(3)
    return angles, rotations, new


def _only_sorted(angles: np.ndarray, rotations: np.ndarray, new: np.ndarray) -> np.ndarray:
    best = min(readings(), key=lambda reading: np.abs(rotations_of(angles, reading) - rotations).max())
    return np.deg2rad(new * best[1])[:, np.argsort(best[0])]


EXERCISES = [
    Exercise(
        number="01.1",
        level="warm-up",
        solution=to_world,
        inputs=_points_and_state,
        cases=(_level_camera, _one_point),
        mistakes=(
            Mistake(
                lambda points, state: _moved(points, pose_matrix(state)),
                "You treat right, down, forward as if they were forward, left, up: first turn into the body frame.",
            ),
            Mistake(
                lambda points, state: _moved(points @ BODY_FROM_OPTICAL, pose_matrix(state)),
                "Your turn from optical to body runs backwards. For rows of points its matrix must be transposed.",
            ),
            Mistake(
                lambda points, state: points @ BODY_FROM_OPTICAL.T @ pose_matrix(state)[:3, :3] + state[:3],
                "Your rotation turns the wrong way. Points are rows here: `points @ R.T`, not `points @ R`.",
            ),
            Mistake(
                lambda points, state: to_world(points, state) - state[:3],
                "The points are turned, but still counted from the camera: its position is missing.",
            ),
            Mistake(
                _position_first, "You move first and turn then, so the position is turned, too. Turn first, then move."
            ),
            Mistake(
                _turns_in_other_order,
                "Your turns come in another order. Rz Ry Rx: roll acts first, so it stands on the right.",
            ),
            Mistake(
                _into_the_camera, "You go from the world into the camera. The task goes the other way: no inverse."
            ),
            Mistake(
                _into_the_body,
                "Your second step goes the wrong way: `pose_matrix` leads from the body to the world already.",
            ),
            Mistake(_yaw_alone, "You use yaw alone. The camera may be tilted and rolled as well."),
            Mistake(_taken_as_degrees, "The state's angles are in radians already."),
            Mistake(
                lambda points, state: points @ BODY_FROM_OPTICAL.T,
                "That is the body frame. One more step leads to the world: the camera's pose.",
            ),
            Mistake(
                lambda points, state: points @ BODY_FROM_OPTICAL @ pose_matrix(state)[:3, :3] + state[:3],
                "Both of your turns run backwards. For rows of points each matrix is transposed: `points @ M.T`.",
            ),
            Mistake(
                lambda points, state: to_world(points, state) - 2 * state[:3],
                "Turned rightly; then the position is added, not taken away.",
            ),
            Mistake(
                lambda points, state: _moved(points[:, [2, 0, 1]], pose_matrix(state)),
                "You reorder X, Y, Z and keep their signs. But right is *minus* left, and down is *minus* up.",
            ),
            Mistake(
                lambda points, state: points @ (BODY_FROM_OPTICAL @ pose_matrix(state)[:3, :3]).T + state[:3],
                "Your R acts before B. What acts first stands next to the point: R B p.",
            ),
            Mistake(
                lambda points, state: to_world(points, state[[0, 1, 2, 5, 4, 3]]),
                "You take the angles for yaw, pitch, roll. A state holds roll, pitch, yaw.",
            ),
            Mistake(
                lambda points, state: points @ optical_pose(state)[:3, :3] + state[:3],
                "Your rotation turns the wrong way. Points are rows here: each matrix on their right is transposed.",
            ),
            Mistake(
                lambda points, state: to_world(points * [-1, 1, 1], state),
                "Forward and up are right. But y counts to the *left* and X to the right.",
            ),
            Mistake(
                lambda points, state: to_world(points * [1, -1, 1], state),
                "Forward and left are right. But z counts *up* and Y down.",
            ),
        ),
    ),
    Exercise(
        number="01.2",
        solution=state_of,
        inputs=_optical,
        cases=(_facing_back, _hardly_turned),
        mistakes=(
            Mistake(
                state_from_matrix,
                "You read the angles of the optical frame. The state is that of the body: undo B first.",
            ),
            Mistake(
                lambda matrix: _with_rotation(matrix, BODY_FROM_OPTICAL.T @ matrix[:3, :3]),
                "You undo B on the left, where the world is. The optical frame is on the right of R B.",
            ),
            Mistake(
                lambda matrix: _with_rotation(matrix, BODY_FROM_OPTICAL @ matrix[:3, :3]),
                "You multiply by B on the left. The block is R B: undo B on the right, with its transpose.",
            ),
            Mistake(
                lambda matrix: _with_rotation(matrix, matrix[:3, :3] @ BODY_FROM_OPTICAL),
                "You apply B once more instead of undoing it: its inverse is its transpose.",
            ),
            Mistake(
                lambda matrix: state_of(np.linalg.inv(matrix)),
                "You inverted the matrix. It is camera-to-world already: its last column is the position.",
            ),
            Mistake(
                lambda matrix: state_of(matrix) * [1, 1, 1, 0, 1, 1],
                "Your roll is always 0. A camera in a hand rolls: which entries of R hold sin(roll)?",
            ),
            Mistake(
                _other_order,
                'That is scipy\'s "zyx", about axes that stay put. The course\'s order is "ZYX", with capitals.',
            ),
            Mistake(
                _half_circle,
                "Your angles stay within 90 degrees: arctan cannot tell opposite arrows apart, arctan2 can.",
            ),
            Mistake(
                lambda matrix: state_of(matrix) * [1, 1, 1, 1, -1, 1],
                "Your pitch has the wrong sign: R20 is minus sin(pitch).",
            ),
            Mistake(
                lambda matrix: np.concatenate([matrix[:3, 3], np.rad2deg(state_of(matrix)[3:])]),
                "Your angles are in degrees; a state holds radians.",
            ),
            Mistake(
                lambda matrix: state_of(matrix)[[0, 1, 2, 5, 4, 3]],
                "Your angles come as yaw, pitch, roll; the state has roll, pitch, yaw.",
            ),
            Mistake(
                lambda matrix: state_of(matrix) * [0, 0, 0, 1, 1, 1],
                "The angles are right; the position is in the last column of the matrix.",
            ),
            Mistake(
                lambda matrix: state_of(matrix)[[3, 4, 5, 0, 1, 2]],
                "The six numbers are right, but the position comes first.",
            ),
            Mistake(
                lambda matrix: _with_rotation(matrix, (matrix[:3, :3] @ BODY_FROM_OPTICAL.T).T),
                "Your R is transposed: its angles are those of the way back, from world to body.",
            ),
            Mistake(
                lambda matrix: np.concatenate([BODY_FROM_OPTICAL.T @ matrix[:3, 3], _left_undone(matrix)]),
                "Undoing B on the left turns the position, too, which was right. Mend the 3 x 3 block, on its right.",
            ),
            Mistake(
                lambda matrix: np.concatenate([BODY_FROM_OPTICAL @ matrix[:3, 3], state_of(matrix)[3:]]),
                "The angles are right. The position is in the world already: it needs no B.",
            ),
            Mistake(
                _pitch_by_one_entry,
                "Your pitch divides by R00 alone, and R00 holds cos(yaw) as well: take the root of R00^2 + R10^2.",
            ),
            Mistake(
                lambda matrix: _pitch(matrix, np.arctan(np.sin(state_of(matrix)[4]))),
                "-R20 is the *sine* of the pitch. arcsin undoes it; arctan wants a quotient.",
            ),
            Mistake(
                _sine_second,
                "np.arctan2 takes the sine part first: R21 before R22, and R10 before R00.",
            ),
            Mistake(
                lambda matrix: np.concatenate([-matrix[:3, :3].T @ matrix[:3, 3], state_of(matrix)[3:]]),
                "The angles are right. -R^T t is for world-to-camera matrices; here the last column is the position.",
            ),
            Mistake(
                lambda matrix: state_of(matrix) * [1, 1, 1, 0, 0, 1],
                "Right for a wagon: your roll and pitch are always 0. A camera in a hand is tilted, too.",
            ),
            Mistake(
                lambda matrix: np.concatenate([matrix[:3, 3], state_of(matrix)[3:] % (2 * np.pi)]),
                "Your angles run from 0 to 2 pi; the course keeps them between -pi and pi.",
            ),
            Mistake(
                lambda matrix: np.concatenate([state_of(matrix)[:5], state_of(matrix)[5:] % (2 * np.pi)]),
                "Your yaw runs from 0 to 2 pi; the course keeps every angle between -pi and pi.",
            ),
        ),
    ),
    Exercise(
        number="01.3",
        solution=motion,
        inputs=_two_states,
        cases=(_over_the_seam, _at_rest),
        mistakes=(
            Mistake(
                lambda before, after: after - before,
                "You subtract the numbers. The camera's own forward is not the world's x, and angles wrap.",
            ),
            Mistake(
                _numbers_subtracted,
                "You subtract the numbers: that is a step along the world's axes. How far *forward* did the camera go?",
            ),
            Mistake(
                _angles_subtracted,
                "The step is right. The angles of two turns cannot be subtracted: multiply matrices, then read angles.",
            ),
            Mistake(
                _by_yaw_alone,
                "Right for a wagon: you turn by yaw alone. A camera that is tilted or rolled needs the whole of R.",
            ),
            Mistake(
                _step_in_the_world,
                "The turn is right. Your step counts along the world's axes: turn it into the first camera's frame.",
            ),
            Mistake(
                lambda before, after: motion(after, before),
                "That is the way back: the first pose, seen from the second.",
            ),
            Mistake(
                lambda before, after: state_from_matrix(pose_matrix(after) @ np.linalg.inv(pose_matrix(before))),
                "The inverse is on the wrong side: what is in the world must go into the first camera's frame *last*.",
            ),
            Mistake(
                lambda before, after: state_from_matrix(pose_matrix(before) @ pose_matrix(after)),
                "You go from body to world twice. One of the two has to be undone.",
            ),
            Mistake(
                _turn_on_the_wrong_side,
                "The step is right. Your turn is told in the world: put the undone rotation on the left of the other.",
            ),
            Mistake(
                _step_turned_on,
                "The turn is right. R leads from body to world; your step has to go from world to body.",
            ),
            Mistake(
                _step_seen_from_the_second,
                "The turn is right. Your step is told in the frame of the second pose; the task asks for the first.",
            ),
            Mistake(
                lambda before, after: motion(before, after) * [1, 1, 1, *[180 / np.pi] * 3],
                "Your angles are in degrees; a state holds radians.",
            ),
            Mistake(
                _step_by_yaw_alone,
                "The turn is right. You turn the step by yaw alone: a tilted camera needs the whole of R.",
            ),
            Mistake(
                _optical_motion,
                "That is the motion in the *optical* frame: right, down, forward. The task asks for the body frame.",
            ),
        ),
    ),
    Exercise(
        number="01.4",
        level="challenge",
        solution=decode,
        inputs=_some_program,
        cases=(_this_course, _an_airplane, _starts_level),
        mistakes=(
            Mistake(
                lambda angles, rotations, new: np.deg2rad(new),
                "You read the columns as this course does. What do the given matrices say about that?",
            ),
            Mistake(
                lambda angles, rotations, new: np.rad2deg(decode(angles, rotations, new)),
                "The reading is right. Return radians; only the other program writes degrees.",
            ),
            Mistake(
                lambda angles, rotations, new: _best_of([r for r in readings() if r[2]], angles, rotations, new),
                "You never try that the *first* column acts first. Each order of axes can be multiplied in two ways.",
            ),
            Mistake(
                lambda angles, rotations, new: _best_of([r for r in readings() if not r[2]], angles, rotations, new),
                "You never try that the *last* column acts first. Each order of axes can be multiplied in two ways.",
            ),
            Mistake(
                lambda angles, rotations, new: _best_of(
                    [r for r in readings() if r[1] == (1, 1, 1)], angles, rotations, new
                ),
                "You never try a negative sign: an airplane's pitch is positive upward.",
            ),
            Mistake(
                lambda angles, rotations, new: _best_of(
                    [r for r in readings() if len(set(r[1])) == 1], angles, rotations, new
                ),
                "You give all three columns one sign. Each column may have its own: 8 mixtures.",
            ),
            Mistake(
                _only_sorted,
                "You sort columns and mend signs. But turns in another order have other angles: go through matrices.",
            ),
            Mistake(
                lambda angles, rotations, new: decode(angles, rotations.transpose(0, 2, 1), new),
                "You compare with the transposed matrices: those turn the other way.",
            ),
            Mistake(
                lambda angles, rotations, new: decode(angles[:1], rotations[:1], new),
                "You compare the first pose alone. Where its angles are 0 every reading fits: compare all of them.",
            ),
            Mistake(
                lambda angles, rotations, new: decode(angles, rotations, new)[:, ::-1],
                "The reading is right, but yours returns yaw, pitch, roll. The task asks for roll, pitch, yaw.",
            ),
            Mistake(
                lambda angles, rotations, new: _best_of(
                    [r for r in readings() if r[0] == (0, 1, 2)], angles, rotations, new
                ),
                "You take it that the columns turn about forward, left, up in this order. There are six orders.",
            ),
        ),
    ),
]
