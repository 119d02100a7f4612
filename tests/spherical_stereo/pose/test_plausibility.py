"""The residuals' measure: right when the covariances are, whatever the fit weighed with, and large for wrong pairs."""

import numpy as np
import pytest
from scipy.stats import chi2

from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, Residuals, fit_rigid_2d, residual_statistics

POSE = Pose2D(1.0, -2.0, 0.6)
SOURCE = np.array([[1.0, 0.5], [3.0, -1.0], [-2.0, 1.5], [0.5, 4.0], [-1.0, -3.0]])
LONG = np.array([np.diag([0.01 + 0.02 * r, 0.004]) for r in np.hypot(*SOURCE.T)])  # far points are less certain
TURN = np.array([[0.8, -0.6], [0.6, 0.8]])
NOISE = TURN @ LONG @ TURN.T


def measured(rng):
    return SOURCE + np.array([rng.multivariate_normal([0, 0], one) for one in NOISE])


@pytest.mark.parametrize("weighted", [False, True])
def test_over_repeated_noise_chi_square_and_rms_are_what_is_expected(rng, weighted):
    target, covariances = POSE.apply(SOURCE), NOISE if weighted else None
    squares, expected, chi = [], [], []
    for _ in range(400):
        source = measured(rng)
        pose = fit_rigid_2d(source, target, covariances=covariances)
        found = residual_statistics(pose, source, target, NOISE, covariances)
        squares.append(((pose.apply(source) - target) ** 2).sum(axis=1).mean())
        expected.append(found.expected_rms**2)
        chi.append(found.chi_square)
    assert np.mean(squares) == pytest.approx(np.mean(expected), rel=0.1)
    assert np.mean(chi) == pytest.approx(7, rel=0.08)
    assert np.mean(np.array(chi) > chi2.isf(0.1, 7)) == pytest.approx(0.1, abs=0.05)


def test_exact_points_leave_nothing_and_two_pairs_leave_one_number():
    exact = residual_statistics(POSE, SOURCE, POSE.apply(SOURCE), NOISE)
    assert exact.chi_square == pytest.approx(0, abs=1e-12)
    assert exact.expected_rms > 0.1
    source, target = SOURCE[:2], np.add(POSE.apply(SOURCE[:2]), [[0.0, 0.0], [0.3, 0.0]])
    two = residual_statistics(fit_rigid_2d(source, target), source, target, 0.01 * np.tile(np.eye(2), (2, 1, 1)))
    apart = np.linalg.norm(np.diff(target, axis=0)) - np.linalg.norm(np.diff(source, axis=0))
    assert two.degrees_of_freedom == 1
    assert two.chi_square == pytest.approx(apart**2 / 0.02, rel=0.05)


@pytest.mark.parametrize(("n", "limit"), [(1, 24.4), (7, 54.7), (17, 91.8)])
def test_the_limit_is_two_and_a_quarter_times_the_quantile_of_a_thousandth(n, limit):
    assert Residuals(0.1, limit + 0.5, n).contradict_the_pose
    assert not Residuals(0.1, limit - 0.5, n).contradict_the_pose
    assert Residuals(0.1, 4.0 * n, n).normalized == pytest.approx(2)


def test_right_pairs_pass_and_one_wrong_pair_of_five_does_not(rng):
    target, wrong = POSE.apply(SOURCE), POSE.apply(SOURCE[[1, 0, 2, 3, 4]])
    passed = caught = 0
    for _ in range(100):
        source = measured(rng)
        right = residual_statistics(fit_rigid_2d(source, target), source, target, NOISE)
        passed += not right.contradict_the_pose
        caught += residual_statistics(fit_rigid_2d(source, wrong), source, wrong, NOISE).contradict_the_pose
    assert (passed, caught) == (100, 100)
