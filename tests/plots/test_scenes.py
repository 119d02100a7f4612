"""Objects of a scene: where their points lie, what they refuse."""

import numpy as np
import pytest
import trimesh

from course_lib.depth_mcl import DepthCamera, SceneMap
from course_lib.geometry import optical_pose, pose_matrix
from courseware.plots import scenes

STATE = np.array([2.0, -1.0, 1.2, 0.2, -0.3, 0.8])
CAMERA = DepthCamera.from_fov(40, 30, 60, 45, near=0.5, far=8.0)


@pytest.fixture(scope="module")
def room() -> SceneMap:
    """A box of 4 x 3 x 2.5 m, each side in 40 x 40 squares."""
    box = trimesh.creation.box(extents=(4, 3, 2.5)).apply_translation((0, 0, 1.25))
    for _ in range(5):
        box = box.subdivide()
    return SceneMap(box.vertices, box.faces)


def test_a_map_has_few_triangles_and_no_ceiling(room):
    mesh = scenes.map_mesh(room, faces=1000, below=2.0)
    assert 100 < mesh.n_cells <= 1000
    assert mesh.bounds[4:] == pytest.approx((0, 2.0), abs=1e-5)
    assert mesh.bounds[:4] == pytest.approx((-2, 2, -1.5, 1.5), abs=1e-3)
    assert scenes.map_mesh(room).bounds[5] == pytest.approx(2.5), "whole, it keeps its ceiling"


def test_a_frustum_reaches_the_corners_of_the_image(room):
    points = np.asarray(scenes.frustum(CAMERA, STATE, far=4.0).points, float)
    matrix = optical_pose(STATE)
    local = (points - matrix[:3, 3]) @ matrix[:3, :3]
    assert sorted(np.round(local[:, 2], 4)) == [0, *[0.5] * 4, *[4.0] * 4]
    corners = np.sort(CAMERA.project(local[5:])[:2])
    assert np.allclose(corners, [[-0.5, -0.5, 39.5, 39.5], [-0.5, -0.5, 29.5, 29.5]], atol=1e-3)


@pytest.mark.parametrize("axis", range(3))
def test_each_axis_has_its_colour_and_its_direction(axis):
    mesh = scenes.body_axes(STATE, 0.5)
    assert scenes.AXIS_COLOURS[axis].argmax() == axis, "red, green, blue"
    mine = np.asarray(mesh.points)[(mesh["colour"] == scenes.AXIS_COLOURS[axis]).all(axis=1)]
    local = (mine - STATE[:3]) @ pose_matrix(STATE)[:3, :3]
    assert 0.5 < local[:, axis].max() < 0.75
    assert np.abs(np.delete(local, axis, axis=1)).max() < 0.13
    assert (mesh.point_data.active_scalars == mesh["colour"]).all()


def test_an_ellipsoid_lies_where_its_covariance_says():
    root = np.random.default_rng(3).normal(size=(3, 3))
    covariance, mean = root @ root.T, np.array([1.0, 2.0, 3.0])
    offsets = np.asarray(scenes.ellipsoid(mean, covariance, sigmas=2).points, float) - mean
    squares = np.einsum("ni,ij,nj->n", offsets, np.linalg.inv(covariance), offsets)
    assert np.allclose(squares, 4.0, rtol=1e-3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda room: scenes.map_mesh(room, below=-1), "heights go from 0.00 to 2.50"),
        (lambda room: scenes.frustum(CAMERA, np.zeros(3)), r"shape \(\.\.\., 6\)"),
        (lambda room: scenes.ellipsoid(np.zeros(3), np.eye(6)), r"\[:3, :3\]"),
        (lambda room: scenes.ellipsoid(np.zeros(3), np.diag([1, 1, -1])), "no negative variance"),
        (lambda room: scenes.path(np.zeros((4, 6))), "states"),
        (lambda room: scenes.path(np.zeros((1, 3))), "N at least 2"),
    ],
)
def test_what_cannot_be_drawn_is_named(room, call, words):
    with pytest.raises(ValueError, match=words):
        call(room)
