"""A pose from directions alone: exact on exact directions, as good as SciPy's, and silent where they tell nothing."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import least_squares

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.semantic_map.association import Observation
from courseware.experiments import bearing_only
from courseware.experiments.bearing_only import ALONE, FITS, PAPER, bearing_table, compared, fit_bearings

TRUE = np.array([2.0, 1.5, 2.8])
ROOM = np.array([[0.3, 0.4], [5.0, 0.5], [4.2, 4.6], [0.5, 3.9], [2.6, 5.2], [5.4, 2.5]])


def directions(pose, landmarks):
    return wrap_angle(np.arctan2(*(landmarks - pose[:2]).T[::-1]) - pose[2])


def gap(found, true):
    return np.abs([*np.subtract(found[:2], true[:2]), wrap_angle(found[2] - true[2])]).max()


@pytest.mark.parametrize("n", [3, 4, 6])
def test_exact_directions_give_the_pose_exactly(n):
    rng = np.random.default_rng(10_000 + n)
    for _ in range(20):
        pose = np.array([*rng.uniform(2, 3.5, 2), rng.uniform(-np.pi, np.pi)])
        found = fit_bearings(directions(pose, ROOM[:n]), ROOM[:n])
        assert gap(found, pose) < 1e-6


def test_of_exact_directions_one_of_the_starts_is_the_pose():
    starts = bearing_only._starts(directions(TRUE, ROOM), ROOM)
    assert min(gap(start, TRUE) for start in starts) < 1e-9


@pytest.mark.parametrize("n", [4, 6])
def test_noisy_directions_give_the_pose_that_scipy_finds_from_the_truth(n):
    rng = np.random.default_rng(10_000 + n)
    for _ in range(20):
        noisy = directions(TRUE, ROOM[:n]) + rng.normal(0, 0.02, n)
        oracle = least_squares(lambda pose, b=noisy: wrap_angle(directions(pose, ROOM[:n]) - b), TRUE, xtol=1e-12)
        assert gap(fit_bearings(noisy, ROOM[:n]), oracle.x) < 1e-5


def test_turning_the_camera_turns_the_heading_and_moving_the_map_moves_the_place():
    measured = directions(TRUE, ROOM) + np.linspace(-0.02, 0.02, len(ROOM))
    x, y, theta = fit_bearings(measured, ROOM)
    assert gap(fit_bearings(measured - 1.0, ROOM), (x, y, theta + 1.0)) < 1e-6
    assert gap(fit_bearings(measured, ROOM + np.array([7, -3])), (x + 7, y - 3, theta)) < 1e-6


def test_a_residual_of_the_wrong_sign_does_not_find_the_pose(monkeypatch):
    noisy = directions(TRUE, ROOM) + 0.03 * np.array([1, -1, 1, 1, -1, 1])
    best, right = fit_bearings(noisy, ROOM), bearing_only._residuals

    def wrong(*arguments):
        residuals, jacobian = right(*arguments)
        return -residuals, jacobian

    monkeypatch.setattr(bearing_only, "_residuals", wrong)
    assert gap(fit_bearings(noisy, ROOM), best) > 1e-3


@pytest.mark.parametrize("n", [0, 1, 2])
def test_fewer_than_three_directions_give_no_pose(n):
    assert fit_bearings(directions(TRUE, ROOM[:n]), ROOM[:n]) is None


@pytest.mark.parametrize("n", [3, 5])
def test_landmarks_on_a_circle_with_the_camera_give_no_pose(n):
    """All the circle sees the same angles. Farther from it the same landmarks do tell the pose."""
    angles = np.linspace(0.3, 4.0, n)
    circle = np.array([3.0, 3.0]) + 2.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    on_it = np.array([3.0 + 2.0 * np.cos(5.2), 3.0 + 2.0 * np.sin(5.2), 0.4])
    assert fit_bearings(directions(on_it, circle), circle) is None
    inside = np.array([3.4, 2.5, 0.4])
    assert gap(fit_bearings(directions(inside, circle), circle), inside) < 1e-6


def test_landmarks_on_a_line_with_the_camera_give_no_pose():
    line = np.array([[1.0, 1.0], [2.0, 1.0], [4.0, 1.0], [6.0, 1.0]])
    pose = np.array([0.0, 1.0, 0.3])
    assert fit_bearings(directions(pose, line), line) is None


def pose_of_a_unit(unit, farther=1.0, shown=(0, 1, 2, 3, 4, 5), pairs=((0, 0), (1, 1))):
    """What a camera at `TRUE` sees of `ROOM`: right directions, and distances too long by a factor."""
    heading = np.array([[np.cos(TRUE[2]), -np.sin(TRUE[2])], [np.sin(TRUE[2]), np.cos(TRUE[2])]])
    points = farther * (ROOM - TRUE[:2]) @ heading
    observations = [Observation("sofa", *point, 20.0, 60.0, 0.01 * np.eye(2)) for point in points]
    return unit, SimpleNamespace(observations=observations, used_pairs=pairs), shown, TRUE, ROOM


def test_wrong_distances_spoil_the_papers_fit_and_leave_directions_alone():
    found = compared([pose_of_a_unit(k, 1.0 + 0.1 * (k % 2)) for k in range(6)])
    assert list(found) == ["as_found", "true", "3_true", "5_true"]
    paper, alone = found["true"][PAPER], found["true"][ALONE]
    assert paper["ninety_percent_m"] > 0.05 > 1e-6 > alone["ninety_percent_m"]
    assert paper["median_change_m"] > 0 == alone["median_change_m"]
    assert found["true"]["units"] == 6


def test_a_fit_without_a_pose_counts_as_infinitely_wrong():
    found = compared([pose_of_a_unit(k) for k in range(6)])["as_found"]
    assert (found[PAPER]["no_pose_percent"], found[ALONE]["no_pose_percent"]) == (0.0, 100.0)
    assert found[ALONE]["median_m"] is found[PAPER]["median_change_m"] is None
    assert found[PAPER]["median_m"] < 1e-9


def test_pairs_of_no_object_are_not_true_ones():
    found = compared([pose_of_a_unit(k, shown=(0, -1, 2, 3, -1, -1)) for k in range(6)])
    assert list(found) == ["as_found", "true", "3_true"]
    assert found["true"][ALONE]["median_m"] < 1e-6


def test_the_table_has_a_row_for_every_fit_and_set_of_pairs():
    text = bearing_table(compared([pose_of_a_unit(k, 1.1) for k in range(6)]))
    assert "6 poses, intervals (95 %) over 6 units" in text
    for fit in FITS:
        assert text.count(f"  {fit} ") == 4
