"""What lesson 16 says about the fit, its errors, wrong pairs and sets of points without a pose holds."""

import numpy as np
import pytest

from course_lib.lessons.kit.exercises import find_exercise, judge
from course_lib.lessons.kit.room_observations import room_scenes
from course_lib.lessons.lesson_16.exercises import pose_sigmas
from course_lib.lessons.lesson_16.fits import (
    CORNER,
    LINE,
    MIRRORED,
    ONE_PLACE,
    ROOM,
    TWO,
    expected_sigmas,
    landmarks_of,
    matched_points,
    mirrored_by_plain_svd,
    noisy_fits,
    pose_error,
    residual_over_heading,
    ring_of_landmarks,
    scene_of,
    weighted_fits,
)
from course_lib.lessons.lesson_16.panel import fit_panel
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d


def rms(points, pose) -> float:
    return float(np.sqrt(((pose.apply(points.source) - points.target) ** 2).sum(axis=1).mean()))


def test_right_pairs_of_exact_boxes_give_poses_within_decimetres():
    errors = np.array(
        [pose_error(fit_rigid_2d(p.source, p.target), p.pose) for p in map(matched_points, room_scenes())]
    )
    assert errors[:, 0].mean() < 0.15
    assert errors[:, 0].max() < 0.3
    assert errors[:, 1].max() < 2


def test_the_curve_of_the_residual_is_lowest_at_the_fit_and_as_low():
    points = matched_points()
    pose = fit_rigid_2d(points.source, points.target)
    headings = np.linspace(-np.pi, np.pi, 3601)
    curve = residual_over_heading(points.source, points.target, headings)
    assert headings[curve.argmin()] == pytest.approx(pose.theta, abs=0.002)
    assert curve.min() == pytest.approx(rms(points, pose), rel=1e-3)


@pytest.mark.parametrize("n", [2, 5, 16])
def test_noise_becomes_the_errors_that_the_closed_forms_say(n):
    pose = Pose2D(1.0, 2.0, 0.5)
    errors = noisy_fits(ring_of_landmarks(n), pose, 0.1, 600, np.random.default_rng(n))
    heading, place = expected_sigmas(ring_of_landmarks(n), pose, 0.1)
    assert errors[:, 2].std() == pytest.approx(heading, rel=0.15)
    assert np.sqrt((errors[:, :2] ** 2).sum(axis=1).mean()) == pytest.approx(place, rel=0.15)


def test_four_times_as_many_objects_halve_the_heading_error():
    pose = Pose2D(0, 0, 0)
    few, many = (expected_sigmas(ring_of_landmarks(n), pose, 0.1)[0] for n in (4, 16))
    assert few / many == pytest.approx(2)


def test_without_the_sign_half_of_the_lines_become_mirrors_and_no_room():
    rng = np.random.default_rng(0)
    assert mirrored_by_plain_svd(landmarks_of(ROOM), 0.05, 200, rng) == 0
    assert 140 < mirrored_by_plain_svd(landmarks_of(LINE), 0.05, 400, rng) < 260


def test_a_swap_among_many_leaves_the_heading_and_a_ring_of_three_does_not():
    points = matched_points()
    i, j, k = (points.landmarks.index(sofa) for sofa in (0, 1, 2))
    swapped, ring = points.target.copy(), points.target.copy()
    swapped[[i, j]] = points.target[[j, i]]
    ring[[i, j, k]] = points.target[[j, k, i]]
    assert pose_error(fit_rigid_2d(points.source, swapped), points.pose)[1] < 0.5
    assert pose_error(fit_rigid_2d(points.source, ring), points.pose)[1] > 10


@pytest.mark.parametrize("seed", range(5))
def test_a_swap_of_exact_points_does_not_move_the_pose_at_all_as_long_as_they_are_not_the_whole(seed):
    points = scene_of(ROOM, 70 * seed, 0.0, 0, 1, 0.0, 0.0)
    rng = np.random.default_rng(seed)
    i, j = rng.choice(6, 2, replace=False)
    swapped = points.target.copy()
    swapped[[i, j]] = points.target[[j, i]]
    assert pose_error(fit_rigid_2d(points.source, swapped), points.pose) == pytest.approx((0, 0), abs=1e-6)
    alone = fit_rigid_2d(points.source[[i, j]], points.target[[j, i]])
    assert pose_error(alone, points.pose)[1] == pytest.approx(180, abs=1e-6)


@pytest.mark.parametrize(("arrangement", "reason"), [(ONE_PLACE, "coincident points"), (MIRRORED, "mirrored points")])
def test_the_panel_names_why_there_is_no_pose(arrangement, reason):
    points = scene_of(arrangement, 40, 0.0, 0, 1, 0.0, 0.0)
    with pytest.raises(RigidFitError) as error:
        fit_rigid_2d(points.source, points.target)
    assert error.value.reason == reason
    panel = fit_panel()
    summary = panel.draw(**(panel.defaults() | {"arrangement": arrangement, "noise": 0.0})).summary
    assert summary.startswith(f"no pose. {reason}")


def test_exact_points_in_a_line_a_corner_or_two_alone_give_the_pose():
    for arrangement in (ROOM, LINE, CORNER, TWO):
        points = scene_of(arrangement, -130, 0.0, 0, 1, 0.0, 0.0)
        assert pose_error(fit_rigid_2d(points.source, points.target), points.pose) == pytest.approx((0, 0), abs=1e-6)


def test_in_a_corner_noise_gives_any_heading():
    fits = [scene_of(CORNER, 40, 0.2, seed, 1, 0.0, 0.0) for seed in range(10)]
    turned = []
    for points in fits:
        try:
            turned.append(pose_error(fit_rigid_2d(points.source, points.target), points.pose)[1])
        except RigidFitError:
            turned.append(180.0)
    assert max(turned) > 20


def test_one_of_six_moved_by_three_metres_moves_the_pose_by_half_a_metre():
    panel = fit_panel()
    summary = panel.draw(**(panel.defaults() | {"forward": 3.0, "noise": 0.0})).summary
    assert summary.startswith("pose off by 0.50 m")


def by_svd(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    r = u @ np.diag([1, np.linalg.det(u @ vt)]) @ vt
    return [*(target.mean(axis=0) - r @ source.mean(axis=0)), np.arctan2(r[1, 0], r[0, 0])]


def scale_by_search(source, target):
    theta = by_svd(source, target)[2]
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    turned = a @ np.array([[np.cos(theta), np.sin(theta)], [-np.sin(theta), np.cos(theta)]])
    return np.linalg.lstsq(turned.reshape(-1, 1), b.reshape(-1), rcond=None)[0][0]


def odd_by_mean_residual(source, target):
    left = []
    for k in range(len(source)):
        kept = [i for i in range(len(source)) if i != k]
        pose = fit_rigid_2d(source[kept], target[kept])
        left.append(np.sqrt(np.mean(np.sum((pose.apply(source[kept]) - target[kept]) ** 2, axis=1))))
    return left.index(min(left))


@pytest.mark.parametrize(("number", "answer"), [("16.2", scale_by_search), ("16.3", odd_by_mean_residual)])
def test_another_way_to_the_right_values_passes(number, answer):
    assert all(judge(find_exercise(number), answer, seed).status == "right" for seed in range(8))


def test_with_noise_weights_help_and_covariances_help_more():
    errors = weighted_fits(2.0, 3, np.random.default_rng(5))
    alike, weights, covariances = (np.median(errors[way][:, 0]) for way in ("all alike", "weights", "covariances"))
    assert covariances < weights < alike
    exact = weighted_fits(0.0, 1, np.random.default_rng(5))
    assert np.median(exact["all alike"][:, 1]) < np.median(exact["weights"][:, 1])


def test_the_challenge_s_error_bars_are_those_of_simulated_fits():
    theta = np.pi / 2
    source = np.array([[2.0, 0.0], [0.0, 3.0], [-1.0, -1.0]])
    covariances = np.array([np.diag(v) for v in ([0.04, 0.0001], [0.0004, 0.16], [0.01, 0.01])]) / 16
    target, rng = Pose2D(0.0, 0.0, theta).apply(source), np.random.default_rng(6)
    noise = rng.standard_normal((3000, 3, 2)) * np.sqrt(np.diagonal(covariances, axis1=1, axis2=2))
    fits = np.array([fit_rigid_2d(source + off, target) for off in noise])
    assert fits.std(axis=0) == pytest.approx(pose_sigmas(source, theta, covariances), rel=0.06)


def test_a_wall_that_is_paired_so_that_both_sums_vanish_is_refused_by_name():
    wall = np.array([[-3.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [3.0, 0.0]])
    with pytest.raises(RigidFitError) as refused:
        fit_rigid_2d(wall, wall[[2, 0, 3, 1]])
    assert refused.value.reason == "undetermined rotation"
