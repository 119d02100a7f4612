"""How far off a refined pose may be: direction by direction the image or the prediction, and what rivals leave open."""

import numpy as np
import pytest

from course_lib.beyond.six_dof.covariance import (
    carried,
    fused,
    is_near,
    pose_information,
    predicted_covariance,
    with_rivals,
)
from course_lib.beyond.six_dof.poses import local, retract
from course_lib.beyond.six_dof.prediction import Rival
from course_lib.depth_mcl.status import sigmas
from course_lib.geometry import optical_pose
from course_lib.rendering.renderer import DepthRenderer
from tests.rendering.shapes import SMALL, furnished_room, rough_wall, wall


def image_of(scene_map, pose):
    with DepthRenderer(scene_map, SMALL) as renderer:
        return renderer.render_poses(pose[None])[0]


def random_covariance(rng, scale):
    root = rng.standard_normal((6, 6)) * scale
    return root @ root.T + 1e-6 * np.eye(6)


def test_before_a_bare_wall_an_image_shows_three_directions_a_rough_map_no_more_and_a_furnished_room_all_six(rng):
    """Right, down and about forward are open; the map's roughness, which the camera does not see, tells nothing."""
    pose = optical_pose(np.zeros(6))
    image = image_of(wall(0.9, 5.0), pose)
    information = pose_information(image, image, SMALL)
    assert np.linalg.matrix_rank(information, hermitian=True) == 3
    assert np.diag(information)[[0, 1, 5]].max() < 1e-6 * np.diag(information)[[2, 3, 4]].min()
    measured = image + 0.01 * rng.standard_normal(SMALL.shape)
    known = []
    for _ in range(20):
        information = pose_information(measured, image_of(rough_wall(rng), pose), SMALL)
        known.append(np.diag(information)[[0, 1, 5]] > 0.01 * np.diag(information)[[2, 3, 3]])
    assert np.mean(known) < 0.15
    pose = optical_pose(np.array([-1.0, 0.3, -0.3, 0.05, 0.1, -0.4]))
    image = image_of(furnished_room(), pose)
    assert np.linalg.matrix_rank(pose_information(image, image, SMALL), hermitian=True) == 6
    assert not pose_information(np.full(SMALL.shape, np.nan), np.full(SMALL.shape, np.inf), SMALL).any()


def test_an_error_is_carried_along_as_poses_carry_it(rng):
    """To first order: errors x of T, each carried by the motion M, are those that the predicted covariance has."""
    pose = optical_pose(np.array([1.0, 2.0, 0.5, 0.4, -0.2, 2.0]))
    motion = np.array([0.4, -0.2, 0.6, 0.3, -0.5, 0.2])
    small = random_covariance(rng, 1e-4)
    errors = rng.multivariate_normal(np.zeros(6), small, 20_000)
    expected = np.cov(local(retract(pose, motion), retract(retract(pose, errors), motion)), rowvar=False)
    got = carried(small, motion)
    assert (np.abs(got - expected) < 0.05 * np.sqrt(np.outer(np.diag(expected), np.diag(expected)))).all()
    for _ in range(20):
        before, spread = random_covariance(rng, 0.1), rng.uniform(0.01, 0.3, 6)
        bound = predicted_covariance(before, np.zeros(6), np.diag(spread**2))
        turn = np.linalg.qr(rng.standard_normal((6, 6)))[0]
        shared = np.linalg.cholesky(before) @ turn @ np.diag(spread)  # fully dependent errors, any way
        together = before + np.diag(spread**2) + shared + shared.T
        assert np.linalg.eigvalsh(bound - together).min() > -1e-9
    noise = covariance = 0.01**2 * np.eye(6)
    for _ in range(9):
        covariance = predicted_covariance(covariance, np.zeros(6), noise)
    assert np.sqrt(np.diag(covariance)) == pytest.approx(np.full(6, 0.1), rel=1e-6)  # ten times, not the root of it


def test_along_each_direction_the_surer_is_believed():
    prior = np.diag(np.square([0.1, 0.1, 0.1, 0.2, 0.2, 0.2]))
    information = np.diag([1 / 0.01**2, 0.0, 1 / 0.3**2, 0.0, 1 / 0.02**2, 0.0])
    covariance, gain = fused(prior, information)
    assert np.sqrt(np.diag(covariance)) == pytest.approx([0.01, 0.1, 0.1, 0.2, 0.02, 0.2])
    assert np.diag(gain) == pytest.approx([1 - 0.01**2 / 0.1**2, 0, 0, 0, 1 - 0.02**2 / 0.2**2, 0])
    assert fused(covariance, information)[1] == pytest.approx(0.0, abs=1e-9), "the same image makes it no surer"
    assert is_near(np.array([0.25, 0, 0, 0, 0, 0]), prior)
    assert not is_near(np.array([0.0, 0.8, 0, 0, 0, 0]), prior)
    pose, small = optical_pose(np.zeros(6)), np.eye(6) * 1e-6
    there = np.array([0.4, 0, 0, 0, 0, 0])
    equal = with_rivals(small, pose, [Rival(retract(pose, there), 0.0)])
    assert sigmas(equal) == pytest.approx([0.4 / np.sqrt(2), 1e-3], rel=1e-3)
    hardly = with_rivals(small, pose, [Rival(retract(pose, there), -0.2)])
    assert sigmas(hardly) == pytest.approx([2.1e-3, 1e-3], rel=0.05)
