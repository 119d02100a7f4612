"""Two answers made one, each weighed by its covariance."""

import numpy as np
import pytest
from course_lib.experiments.joined_answer import joined, start_covariance

from course_lib.experiments.finale import LEVEL_SIGMA
from course_lib.geometry import wrap_angle

SEMANTIC = np.array([[0.0025, 0.0005, 0.0002], [0.0005, 0.0036, -0.0001], [0.0002, -0.0001, 0.0004]])


def some_covariance(rng):
    mixing = rng.standard_normal((6, 6))
    return mixing @ mixing.T + np.eye(6)


def test_the_start_knows_the_semantic_pose_and_how_a_robot_stands():
    known = start_covariance(SEMANTIC)
    for a, i in enumerate((0, 1, 5)):
        for b, j in enumerate((0, 1, 5)):
            assert known[i, j] == SEMANTIC[a, b]
    assert np.diag(known)[2:5] == pytest.approx([LEVEL_SIGMA[0] ** 2, LEVEL_SIGMA[1] ** 2, LEVEL_SIGMA[1] ** 2])
    assert np.count_nonzero(known) == 9 + 3


def test_information_adds_up(rng):
    """P^-1 = P_0^-1 + P_1^-1, and the state is the mean weighed by these."""
    a, b, x, y = some_covariance(rng), some_covariance(rng), rng.uniform(-1, 1, 6), rng.uniform(-1, 1, 6)
    state, covariance = joined(x, a, y, b)
    information = np.linalg.inv(a) + np.linalg.inv(b)
    assert covariance == pytest.approx(np.linalg.inv(information), rel=1e-6, abs=1e-9)
    assert state == pytest.approx(np.linalg.solve(information, np.linalg.solve(a, x) + np.linalg.solve(b, y)))


def test_angles_are_joined_across_the_half_turn():
    start, state = np.zeros(6), np.zeros(6)
    start[5], state[5] = np.pi - 0.1, -np.pi + 0.3
    found, _ = joined(start, np.eye(6), state, np.eye(6))
    assert found[5] == pytest.approx(wrap_angle(np.pi + 0.1))
    assert start[5] == np.pi - 0.1, "what is given stays as it is"


def test_a_direction_that_one_does_not_know_is_the_others():
    wall = np.diag([1e-6, 1e6, 1e6, 1e-8, 1e-8, 1e-8])
    found, _ = joined(np.zeros(6), start_covariance(SEMANTIC), np.array([0.05, 0.5, -0.4, 0.0, 0.0, 0.0]), wall)
    assert found[:3] == pytest.approx([0.05, 0.01, 0.0], abs=2e-3)
