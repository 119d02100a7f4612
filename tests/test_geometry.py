"""Laws of the rigid transforms and of angles on the circle."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from course_lib.geometry import (
    circular_mean,
    optical_pose,
    pose_matrix,
    rotation_angle,
    rotation_exp,
    rotation_log,
    rotation_mean,
    state_from_matrix,
    state_from_optical_pose,
    wrap_angle,
)


def random_states(n, rng):
    states = rng.uniform(-10, 10, (n, 6))
    states[:, 3:] = rng.uniform(-np.pi, np.pi, (n, 3))
    return states


def test_pose_matrix_is_yaw_pitch_roll_in_that_order(rng):
    states = random_states(50, rng)
    expected = Rotation.from_euler("ZYX", states[:, [5, 4, 3]]).as_matrix()
    assert np.allclose(pose_matrix(states)[:, :3, :3], expected, atol=1e-14)
    assert np.array_equal(pose_matrix(states)[:, :3, 3], states[:, :3])


def test_state_and_matrix_are_inverse(rng):
    matrices = pose_matrix(random_states(1000, rng))
    assert np.allclose(pose_matrix(state_from_matrix(matrices)), matrices, atol=1e-12)


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2, np.pi / 2 - 1e-10, -np.pi / 2 + 1e-7])
def test_the_pose_survives_gimbal_lock(pitch, rng):
    states = random_states(200, rng)
    states[:, 4] = pitch
    matrices = pose_matrix(states)
    assert np.allclose(pose_matrix(state_from_matrix(matrices)), matrices, atol=1e-8)


def test_the_camera_looks_along_body_x_with_rows_running_down():
    level = optical_pose([1.0, 2.0, 3.0, 0, 0, 0])
    assert np.array_equal(level[:3, 2], [1, 0, 0])
    assert np.array_equal(level[:3, 1], [0, 0, -1])
    assert np.array_equal(level[:3, 0], [0, -1, 0])


def test_optical_pose_round_trip(rng):
    poses = optical_pose(random_states(100, rng))
    assert np.allclose(optical_pose(state_from_optical_pose(poses)), poses, atol=1e-12)


@pytest.mark.parametrize(
    ("function", "wrong", "said"),
    [
        *((pose_matrix, (states,), "shape") for states in (np.zeros(5), 3.0)),
        (pose_matrix, ([np.nan] * 6,), "finite"),
        (state_from_matrix, (np.diag([1.0, 1.0, -1.0, 1.0]),), "rotation"),
        (state_from_matrix, (np.diag([1.0, 1.0, 1.0, 7.0]),), "last row"),
        *((circular_mean, ([0.1, 0.2, 0.3], w), "weights") for w in ([1, 1], [1, -1, 1], [0, 0, 0], [1, np.nan, 1])),
    ],
)
def test_what_is_no_state_no_rotation_and_no_weight_is_refused(function, wrong, said):
    with pytest.raises(ValueError, match=said):
        function(*wrong)


@example(np.pi)
@given(st.floats(-1e4, 1e4))
def test_wrapped_angles_lie_in_range_and_mean_the_same_direction(angle):
    wrapped = wrap_angle(angle)
    assert -np.pi <= wrapped < np.pi
    assert wrap_angle(-1e-20) > -np.pi
    assert np.isclose(np.exp(1j * wrapped), np.exp(1j * angle), atol=1e-9)


def test_circular_mean_crosses_the_wrap_and_opposite_angles_have_none():
    assert np.isclose(abs(circular_mean(np.deg2rad([179.0, -179.0]))), np.pi)
    assert np.isclose(circular_mean(np.deg2rad([170.0, -160.0]), [2, 1]), np.deg2rad(179.96), atol=2e-3)
    assert np.isnan(circular_mean([0.0, np.pi]))


def test_rotation_exp_is_the_exponential_of_the_cross_product_matrix_and_log_undoes_it(rng):
    vectors = rng.uniform(-1.5, 1.5, (20, 3))
    vectors[0], vectors[1] = 0, [1e-9, 0, 0]
    skew = np.cross(vectors[:, None, :], np.eye(3)).swapaxes(-1, -2)
    assert np.allclose(rotation_exp(vectors), expm(skew), atol=1e-13)
    assert np.allclose(rotation_log(rotation_exp(vectors)), vectors, atol=1e-12)
    assert np.allclose(rotation_angle(rotation_exp(vectors)), np.linalg.norm(vectors, axis=1), atol=1e-12)


def test_functions_broadcast_over_leading_axes(rng):
    vectors = rng.uniform(-1, 1, (4, 5, 3))
    rotations = rotation_exp(vectors)
    states = random_states(20, rng).reshape(4, 5, 6)
    assert np.array_equal(pose_matrix(states)[1, 2], pose_matrix(states[1, 2]))
    assert state_from_matrix(pose_matrix(states)).shape == states.shape
    assert rotations.shape == (4, 5, 3, 3)
    assert np.array_equal(rotations[2, 3], rotation_exp(vectors[2, 3]))
    assert np.allclose(rotation_log(rotations), vectors)
    assert rotation_angle(rotations).shape == (4, 5)
    assert np.ndim(rotation_angle(rotations[0, 0])) == 0


def test_rotation_mean_lies_nearer_to_the_heavier(rng):
    """Of turns by 0 and a about one axis with weights 2 and 1 the chordal mean is at atan2(sin a, 2 + cos a)."""
    pair = rotation_exp(np.array([[0.0, 0, 0], [0, 0, 0.9]]))
    expected = rotation_exp(np.array([0, 0, np.arctan2(np.sin(0.9), 2 + np.cos(0.9))]))
    assert np.allclose(rotation_mean(pair, [2.0, 1.0]), expected, atol=1e-12)
