"""Exercises of lesson 01: points from the camera to the world, a state from an optical pose, a mean of headings."""

from __future__ import annotations

import numpy as np

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


def _turns_in_other_order(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    roll, pitch, yaw = (pose_matrix(np.eye(6)[3 + k] * state[3 + k])[:3, :3] for k in range(3))
    return points @ (roll @ pitch @ yaw @ BODY_FROM_OPTICAL).T + state[:3]


def _into_the_camera(points: np.ndarray, state: np.ndarray) -> np.ndarray:
    return _moved(points, np.linalg.inv(optical_pose(state)))


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


# 01.3: the weighted mean direction


def mean_heading(yaws: np.ndarray, w: np.ndarray) -> float:
    """Weighted mean direction [rad] of headings (N,) with weights (N,)."""
    return float(np.arctan2(np.sum(w * np.sin(yaws)), np.sum(w * np.cos(yaws))))


def _headings(rng: np.random.Generator) -> tuple:
    """Headings round some direction, mostly near the wrap, always on both sides of their mean."""
    n = int(rng.integers(4, 9))
    middle = rng.choice([np.pi, rng.uniform(-np.pi, np.pi)], p=[0.7, 0.3])
    yaws = middle + np.concatenate([[0.7, -0.6], rng.uniform(-0.9, 0.9, n - 2)])
    # Weights that sum to anything but one: dividing by their sum must make no difference, not dividing neither.
    return wrap_angle(yaws), rng.uniform(0.1, 2.0, n)


def _mean_of_numbers(yaws: np.ndarray, w: np.ndarray) -> float:
    return np.sum(w * yaws) / np.sum(w)


EXERCISES = [
    Exercise(
        number="01.1",
        reference=to_world,
        inputs=_points_and_state,
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
        ),
    ),
    Exercise(
        number="01.2",
        reference=state_of,
        inputs=_optical,
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
        ),
    ),
    Exercise(
        number="01.3",
        reference=mean_heading,
        inputs=_headings,
        mistakes=(
            Mistake(
                _mean_of_numbers,
                "That is the mean of the numbers. Near +-180 degrees it points the opposite way: add arrows.",
            ),
            Mistake(
                lambda yaws, w: np.arctan2(np.sum(np.sin(yaws)), np.sum(np.cos(yaws))),
                "All your headings count alike. Multiply each arrow by its weight.",
            ),
            Mistake(
                lambda yaws, w: np.arctan2(np.sum(w * np.cos(yaws)), np.sum(w * np.sin(yaws))),
                "np.arctan2 takes the sine part first, then the cosine part.",
            ),
            Mistake(
                lambda yaws, w: np.arctan(np.sum(w * np.sin(yaws)) / np.sum(w * np.cos(yaws))),
                "Your mean stays within 90 degrees: arctan cannot tell an arrow from its opposite. Use arctan2.",
            ),
            Mistake(
                lambda yaws, w: np.mod(mean_heading(yaws, w), 2 * np.pi),
                "The direction is right; the task wants it from -pi to pi, not from 0 to 2 pi.",
            ),
            Mistake(
                lambda yaws, w: np.rad2deg(mean_heading(yaws, w)), "Your mean is in degrees; the task wants radians."
            ),
            Mistake(
                lambda yaws, w: np.sum(w * np.mod(yaws, 2 * np.pi)) / np.sum(w),
                "From 0 to 2 pi the wrap only moves to 0 degrees. No range of numbers is safe: add arrows.",
            ),
            Mistake(
                lambda yaws, w: np.sum(w * yaws),
                "You sum weights times numbers, and the weights need not sum to one. Angles: add arrows instead.",
            ),
            Mistake(
                lambda yaws, w: np.arctan2(np.sin(np.sum(w * yaws)), np.cos(np.sum(w * yaws))),
                "You take sine and cosine of the summed numbers. Take them of each heading, then sum.",
            ),
            Mistake(
                lambda yaws, w: wrap_angle(_mean_of_numbers(yaws, w) + np.pi),
                "Adding 180 degrees to the mean of the numbers helps only by luck. Add arrows.",
            ),
            Mistake(
                lambda yaws, w: np.arctan2(np.sum(np.sin(w * yaws)), np.sum(np.cos(w * yaws))),
                "You weigh the headings themselves. A weight is the length of an arrow: w * sin(yaw), w * cos(yaw).",
            ),
            Mistake(
                lambda yaws, w: np.arctan2(np.sum(w * np.sin(yaws)), np.sum(np.cos(yaws))),
                "You weigh the sines, but not the cosines.",
            ),
            Mistake(
                lambda yaws, w: np.arctan2(np.sum(w * np.sin(yaws)) / w.sum(), np.sum(w * np.cos(yaws))),
                "You divide one of the two sums by the sum of the weights. Divide both, or none.",
            ),
            Mistake(
                lambda yaws, w: mean_heading(np.deg2rad(yaws), w),
                "The headings are in radians already; you convert them once more.",
            ),
            Mistake(
                lambda yaws, w: wrap_angle(yaws[0] + np.sum(w * wrap_angle(yaws - yaws[0])) / np.sum(w)),
                "Close: you move the wrap away, then average numbers. Add arrows instead: sines and cosines.",
            ),
        ),
    ),
]
