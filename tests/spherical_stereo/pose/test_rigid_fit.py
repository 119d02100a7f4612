"""The rigid fit: agrees with scikit-image, turns with its points, names what has no answer, and measures residuals."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import chi2
from skimage.transform import EuclideanTransform

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.pose import rigid_fit
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, fit_covariance, fit_rigid_2d, residual_statistics

TRIANGLE = np.array([[0.0, 0.0], [3.0, 0.0], [1.0, 2.0]])

angles = st.floats(-np.pi, np.pi - 1e-9)
points = st.integers(2, 12).flatmap(lambda n: arrays(np.float64, (n, 2), elements=st.floats(-5, 5)))


def noisy(source, pose, sigma, seed=0):
    return pose.apply(source) + sigma * np.random.default_rng(seed).standard_normal(source.shape)


@given(points, angles, st.integers(0, 10_000))
def test_noisy_points_give_the_pose_that_scikit_image_gives(source, theta, seed):
    assume(source.var(axis=0).sum() > 1.0)
    target = noisy(source, Pose2D(1.0, -2.0, theta), 0.05, seed)
    reference = EuclideanTransform.from_estimate(source, target)
    fitted = fit_rigid_2d(source, target)
    assert fitted[:2] == pytest.approx(reference.translation, abs=1e-9)
    assert wrap_angle(fitted.theta - reference.rotation) == pytest.approx(0, abs=1e-9)


@given(angles, st.integers(0, 10_000))
def test_turning_body_and_covariances_together_keeps_the_weighted_position(turn, seed):
    rng = np.random.default_rng(seed)
    source = rng.uniform(-3, 3, (6, 2))
    target = noisy(source, Pose2D(1.0, 2.0, 0.3), 0.1, seed)
    factors = rng.standard_normal((6, 2, 2)) * 0.2
    covariances = factors @ np.swapaxes(factors, 1, 2) + 0.01 * np.eye(2)
    rotation = rigid_fit.rotation_2d(turn)
    before = fit_rigid_2d(source, target, covariances=covariances)
    after = fit_rigid_2d(source @ rotation.T, target, covariances=rotation @ covariances @ rotation.T)
    assert after[:2] == pytest.approx(before[:2], abs=1e-8)
    assert wrap_angle(after.theta - before.theta + turn) == pytest.approx(0, abs=1e-8)


def test_a_pair_of_weight_zero_counts_as_if_it_were_not_there():
    target = noisy(TRIANGLE, Pose2D(2.0, 1.0, 0.7), 0.2)
    noise = np.array([0.01 * np.eye(2), np.diag([0.04, 0.01]), 0.02 * np.eye(2)])
    pose = fit_rigid_2d(TRIANGLE, target)
    more = [np.vstack([points, [50.0, 9.0]]) for points in (TRIANGLE, target)]
    assert fit_rigid_2d(*more, weights=[1, 1, 1, 0]) == pytest.approx(pose, abs=1e-12)
    covariance = fit_covariance(pose, *more, weights=[1, 1, 1, 0], noise=np.vstack([noise, [np.eye(2)]]))
    assert covariance == pytest.approx(fit_covariance(pose, TRIANGLE, target, noise=noise), abs=1e-12)


def test_without_covariances_the_residuals_say_how_uncertain_the_pose_is():
    rng, pose = np.random.default_rng(7), Pose2D(0.3, 0.4, -1.0)
    points, claimed, errors = rng.uniform(-3, 3, (10, 2)), [], []
    for _ in range(500):
        target = pose.apply(points) + 0.1 * rng.standard_normal((10, 2))
        fitted = fit_rigid_2d(points, target)
        claimed.append(fit_covariance(fitted, points, target))
        errors.append(np.array(fitted) - pose)
    ratio = np.mean(np.square(errors), axis=0) / np.mean(claimed, axis=0).diagonal()
    assert ratio == pytest.approx([1, 1, 1], rel=0.2)


ONE_PLACE = np.tile([2.0, 1.0], (3, 1))


@pytest.mark.parametrize(
    ("source", "target", "reason", "says"),
    [
        (np.zeros((0, 2)), np.zeros((0, 2)), Reason.TOO_FEW_PAIRS, "at least two pairs of points; got 0"),
        (np.zeros((1, 2)), np.zeros((1, 2)), Reason.TOO_FEW_PAIRS, "at least two pairs of points; got 1"),
        (ONE_PLACE, TRIANGLE, Reason.COINCIDENT, "3 source points"),
        (TRIANGLE, ONE_PLACE, Reason.COINCIDENT, "3 target points"),
        *((TRIANGLE * [1, -1], Pose2D(-9, 4, turn).apply(TRIANGLE), Reason.MIRRORED, "mirror") for turn in range(6)),
    ],
)
def test_points_without_a_pose_have_a_reason(source, target, reason, says):
    with pytest.raises(rigid_fit.RigidFitError, match=says) as caught:
        fit_rigid_2d(source, target)
    assert caught.value.reason == reason


def test_of_a_mirror_image_the_error_says_what_the_best_rotation_and_the_best_reflection_leave_over():
    """The best rotation is found by trying every heading."""
    source = TRIANGLE - TRIANGLE.mean(axis=0)
    target = source * [1, -1]
    tried = [
        np.sqrt(((Pose2D(0, 0, one).apply(source) - target) ** 2).sum(axis=1).mean()) for one in np.arange(0, 7, 1e-3)
    ]
    says = rf"reflection the residual is 0\.000 m, with a rotation {min(tried):.3f} m"
    with pytest.raises(rigid_fit.RigidFitError, match=says):
        fit_rigid_2d(source, target)


@given(st.integers(2, 8), angles, st.integers(0, 1000))
def test_points_on_a_line_are_no_mirror_image(n, theta, seed):
    line = np.stack([np.linspace(0, 4, n), np.zeros(n)], axis=1)
    pose = Pose2D(1.0, 1.0, theta)
    fitted = fit_rigid_2d(line + 0.05 * np.random.default_rng(seed).standard_normal(line.shape), pose.apply(line))
    assert fitted[:2] == pytest.approx(pose[:2], abs=0.25)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"target": TRIANGLE[:2]}, "shape"),
        ({"weights": [1, 1]}, "weights must have"),
        ({"weights": [1, -1, 1]}, "not be negative"),
        ({"source": np.full((3, 2), np.inf)}, "source must have finite values"),
        ({"covariances": np.full((3, 2, 2), np.nan)}, r"one finite \(2, 2\) matrix a pair"),
        ({"covariances": np.eye(2)}, r"one finite \(2, 2\) matrix a pair"),
        ({"covariances": [np.zeros((2, 2))] * 3}, "positive eigenvalues"),
        ({"covariances": [[[1, 0.5], [0, 1]]] * 3}, "symmetric"),
    ],
)
def test_arguments_that_do_not_fit_are_named(changes, says):
    with pytest.raises(rigid_fit.RigidFitError, match=says):
        fit_rigid_2d(**{"source": TRIANGLE, "target": TRIANGLE, **changes})


POSE = Pose2D(1.0, -2.0, 0.6)
SOURCE = np.array([[1.0, 0.5], [3.0, -1.0], [-2.0, 1.5], [0.5, 4.0], [-1.0, -3.0]])
LONG = np.array([np.diag([0.01 + 0.02 * r, 0.004]) for r in np.hypot(*SOURCE.T)])  # far points are less certain
TURN = np.array([[0.8, -0.6], [0.6, 0.8]])
NOISE = TURN @ LONG @ TURN.T


def measured(rng):
    return SOURCE + np.array([rng.multivariate_normal([0, 0], one) for one in NOISE])


@pytest.mark.parametrize("weighted", [False, True])
def test_over_repeated_noise_residuals_and_errors_are_what_is_expected_and_a_wrong_pair_shows(rng, weighted):
    target, wrong, covariances = POSE.apply(SOURCE), POSE.apply(SOURCE[[1, 0, 2, 3, 4]]), NOISE if weighted else None
    squares, expected, chi, errors = [], [], [], []
    for _ in range(400):
        source = measured(rng)
        pose = fit_rigid_2d(source, target, covariances=covariances)
        found = residual_statistics(pose, source, target, NOISE, covariances)
        squares.append(((pose.apply(source) - target) ** 2).sum(axis=1).mean())
        expected.append(found.expected_rms**2)
        chi.append(found.chi_square)
        assert not found.contradict_the_pose
        assert residual_statistics(fit_rigid_2d(source, wrong), source, wrong, NOISE).contradict_the_pose
        error = np.array(pose) - POSE
        claim = fit_covariance(pose, source, target, covariances=covariances, noise=NOISE)
        errors.append(error @ np.linalg.solve(claim, error))
    assert np.mean(squares) == pytest.approx(np.mean(expected), rel=0.1)
    assert np.mean(chi) == pytest.approx(7, rel=0.08)
    assert np.mean(np.array(chi) > chi2.isf(0.1, 7)) == pytest.approx(0.1, abs=0.05)
    # Squared errors in units of the claimed covariance have mean 3, one for each component.
    assert np.mean(errors) == pytest.approx(3.0, rel=0.2)


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
    above, below = (rigid_fit.Residuals(0.1, chi_square, n) for chi_square in (limit + 0.5, limit - 0.5))
    assert (above.contradict_the_pose, below.contradict_the_pose) == (True, False)
    assert below.normalized == pytest.approx(np.sqrt((limit - 0.5) / n))
