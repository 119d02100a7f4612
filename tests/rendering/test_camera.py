"""Cameras: the projection, what they accept, what they refuse; eq. (7) in NumPy."""

import dataclasses

import numpy as np
import pytest

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.sensor import depth_image_from_points, subsample_depth
from tests.rendering.shapes import OFF_CENTRE, SMALL


def test_the_sr4000_has_the_papers_view_and_subsampling_picks_the_pixel_nearest_to_the_coarse_centre():
    camera = DepthCamera.sr4000()
    assert camera.shape == (144, 176)
    assert (round(camera.fx, 1), round(camera.fy, 1)) == (220.0, 231.2)
    assert (camera.cx, camera.cy) == (87.5, 71.5)
    coarse = camera.resized(20, 15)
    columns = np.tile(np.arange(176.0), (144, 1))
    picked = subsample_depth(columns, camera, coarse)
    centres = (np.arange(20) - coarse.cx) * camera.fx / coarse.fx + camera.cx
    assert picked.shape == (15, 20)
    assert np.abs(picked - centres).max() <= 0.5


def test_points_project_back_onto_their_pixels_and_resizing_keeps_the_image_edges(rng):
    depth = rng.uniform(0.5, 5, OFF_CENTRE.shape)
    u, v, z = OFF_CENTRE.project(OFF_CENTRE.points(depth))
    assert np.allclose(u, np.arange(61)[None, :])
    assert np.allclose(v, np.arange(47)[:, None])
    assert np.allclose(z, depth)
    for camera in (OFF_CENTRE, OFF_CENTRE.resized(30, 20)):
        left, right = ((pixel - camera.cx) / camera.fx for pixel in (-0.5, camera.width - 0.5))
        top, bottom = ((pixel - camera.cy) / camera.fy for pixel in (-0.5, camera.height - 0.5))
        edges = (-21.8 / 55, 39.2 / 55, -31.3 / 83, 15.7 / 83)
        assert (left, right, top, bottom) == pytest.approx(edges)


@pytest.mark.parametrize("k", [1, 2, 5])
def test_every_kth_row_and_column_keeps_its_ray(k):
    for camera in (SMALL, OFF_CENTRE):
        thinned = camera.every(k)
        assert thinned.rays() == pytest.approx(camera.rays()[::k, ::k])
        assert (thinned.near, thinned.far) == (camera.near, camera.far)


def test_the_projection_matrix_puts_pixel_centres_and_planes_where_opengl_looks_for_them():
    camera = OFF_CENTRE
    for u, v, z in ((0, 0, camera.near), (camera.width - 1, camera.height - 1, camera.far)):
        x, y = (u - camera.cx) * z / camera.fx, (v - camera.cy) * z / camera.fy
        clip = camera.projection_matrix() @ [x, -y, -z, 1]
        ndc = clip[:3] / clip[3]
        assert (ndc[0] + 1) / 2 * camera.width == pytest.approx(u + 0.5)
        assert (1 - ndc[1]) / 2 * camera.height == pytest.approx(v + 0.5)
        assert ndc[2] == pytest.approx(-1 if z == camera.near else 1)


def test_what_does_not_fit_the_image_size_or_is_no_k_is_named():
    matrix = np.array([[585.0, 0, 319.5], [0, 585, 239.5], [0, 0, 1]])
    assert DepthCamera.from_matrix(matrix, 640, 480).cx == 319.5
    for width, height in ((160, 120), (320, 240), (1280, 960), (2560, 1920)):
        with pytest.raises(ValueError, match="another image size"):
            DepthCamera.from_matrix(matrix, width, height)
    for no_k in (np.eye(4), np.full((3, 3), np.nan), [[500, 3, 80], [0, 500, 60], [0, 0, 1]]):
        with pytest.raises(ValueError, match="intrinsics"):
            DepthCamera.from_matrix(no_k, 160, 120)
    bad = [("width", 0), ("height", 2.5), ("fx", 0), ("fy", -1), ("near", 0), ("near", 20), ("far", np.inf)]
    for name, value in (*bad, ("cx", np.nan)):
        with pytest.raises(ValueError, match=name):
            dataclasses.replace(SMALL, **{name: value})
    with pytest.raises(ValueError, match="shape"):
        SMALL.points(np.ones((64, 48)))
    with pytest.raises(ValueError, match="shape"):
        subsample_depth(np.ones((3, 3)), SMALL, SMALL.resized(4, 3))


def test_of_several_points_on_a_pixel_the_nearest_counts_and_those_outside_the_planes_or_the_image_do_not():
    image = depth_image_from_points(np.array([[0.0, 0, 4], [0, 0, 2], [0, 0, 3]]), DepthCamera(3, 3, 10, 10, 1, 1))
    assert image[1, 1] == 2
    assert np.isnan(image).sum() == 8
    points = np.array([[0, 0, 0.05], [0, 0, 99.0], [50.0, 0, 1], [0, 0, -2]])
    assert np.isnan(depth_image_from_points(points, SMALL)).all()
