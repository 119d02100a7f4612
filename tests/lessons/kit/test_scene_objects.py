"""Particles and depth images in a scene: where their points lie, what they refuse."""

import numpy as np
import pytest

from course_lib.geometry import optical_pose, pose_matrix
from courseware.lessons.kit.scene_objects import arrows, depth_surface
from tests.plots.test_scenes import CAMERA, STATE

DEPTH = np.full(CAMERA.shape, 3.0)


def test_arrows_point_along_x_with_their_fin_up():
    mesh = arrows(np.array([STATE, np.zeros(6)]), 0.4, weights=np.array([0.25, 0.75]))
    darts = np.asarray(mesh.points).reshape(2, 5, 3)
    heading = darts[0, 0] - darts[0, 3]
    assert np.allclose(heading / np.linalg.norm(heading), pose_matrix(STATE)[:3, 0], atol=1e-5)
    assert np.allclose(
        darts[1], 0.4 * np.array([[0.6, 0, 0], [-0.4, 0.3, 0], [-0.4, -0.3, 0], [-0.2, 0, 0], [-0.4, 0, 0.2]])
    )
    assert np.asarray(mesh["weight"]).reshape(2, 5).tolist() == [[0.25] * 5, [0.75] * 5]
    first, second = mesh.regular_faces.reshape(2, 3, 3)
    assert second.tolist() == (first + 5).tolist()
    assert np.allclose(mesh.cell_centers().points[3:, 1], [0.04, -0.04, 0.0]), "two halves, and a fin between them"


def test_a_depth_image_becomes_the_surface_that_it_shows():
    mesh, matrix = depth_surface(DEPTH, CAMERA, STATE), optical_pose(STATE)
    local = (np.asarray(mesh.points, float) - matrix[:3, 3]) @ matrix[:3, :3]
    assert np.allclose(local[:, 2], 3.0, atol=1e-5)
    assert np.allclose(np.sort(CAMERA.project(local)[0])[[0, -1]], [0, 39], atol=1e-3)
    assert mesh.n_cells == 2 * 39 * 29
    assert np.allclose(mesh["depth"], 3.0)


def test_a_surface_is_cut_at_edges_and_at_pixels_without_depth():
    depth = np.where(np.arange(40) < 20, 3.0, 5.0) * np.ones((30, 1))
    depth[0, 0], depth[-1, 0] = np.nan, np.inf
    mesh = depth_surface(depth, CAMERA, STATE)
    # Of the corner squares, the one cut by the diagonal loses both triangles, the other one.
    assert mesh.n_cells == 2 * 38 * 29 - 2 - 1
    assert set(np.asarray(mesh["depth"]).tolist()) == {3.0, 5.0}
    assert depth_surface(depth, CAMERA, STATE, jump=0.7).n_cells == 2 * 39 * 29 - 3
    assert depth_surface(depth, CAMERA, STATE, every=3).n_points < mesh.n_points / 8


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: arrows(np.full((1, 6), np.nan)), "finite"),
        (lambda: arrows(np.zeros((3, 6)), weights=np.ones(2)), r"weights must have shape \(3,\)"),
        (lambda: depth_surface(np.ones((3, 3)), CAMERA, STATE), r"shape \(30, 40\)"),
    ],
)
def test_what_cannot_be_drawn_is_named(call, words):
    with pytest.raises(ValueError, match=words):
        call()
