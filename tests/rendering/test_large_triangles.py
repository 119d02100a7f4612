"""Large triangles are cut without a gap, and what is seen of them is right to a millimetre."""

import numpy as np
import pytest
import trimesh

from course_lib.geometry import optical_pose, pose_matrix, state_from_matrix
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.large_triangles import LONGEST, LargeTrianglesError, cut_large_triangles
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

QUAD = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def edges(vertices, faces):
    corners = vertices[faces]
    return np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)


@pytest.mark.parametrize("size", [20.0, 33.0, 500.0])
def test_the_pieces_are_small_and_cover_the_same_without_a_gap(size, rng):
    vertices, faces = size * rng.normal(size=(40, 3)), trimesh.creation.icosphere(subdivisions=1).faces[:, ::-1]
    vertices = size * trimesh.creation.icosphere(subdivisions=1).vertices + rng.normal(size=(42, 3))
    cut, pieces = cut_large_triangles(vertices, faces)
    assert edges(cut, pieces).max() <= LONGEST
    before, after = (trimesh.Trimesh(v, f, process=False) for v, f in ((vertices, faces), (cut, pieces)))
    assert after.area == pytest.approx(before.area)
    assert after.volume == pytest.approx(before.volume)
    assert after.is_watertight
    assert after.is_winding_consistent


def test_what_is_not_large_comes_back_as_it_is():
    vertices, faces = cut_large_triangles(QUAD, FACES)
    assert vertices is QUAD
    assert faces is FACES


def test_what_is_absurdly_large_is_left_and_what_is_too_much_is_an_error():
    assert len(cut_large_triangles(QUAD * 1e6, FACES)[1]) == 2
    with pytest.raises(LargeTrianglesError, match="5,000,000 pieces"):
        cut_large_triangles(QUAD * 4900, np.tile(FACES, (40, 1)))


@pytest.mark.parametrize("backend", ["raster", "vtk", "ray"])
@pytest.mark.parametrize("tilt", [0.0, 0.3])
def test_depths_of_a_plane_of_kilometres_are_right_to_a_millimetre(backend, tilt, rng):
    camera = DepthCamera.sr4000().resized(44, 36)
    states = rng.uniform([-2, -2, 0.5, -0.3, -0.3, -3], [2, 2, 2, 0.3, 0.3, 3], (20, 6))
    turned = np.eye(4)
    turned[[0, 0, 2, 2], [0, 2, 0, 2]] = [np.cos(tilt), np.sin(tilt), -np.sin(tilt), np.cos(tilt)]
    poses = optical_pose(states)
    height = (camera.rays() @ poses[:, None, :3, :3].transpose(0, 1, 3, 2))[..., 2]
    with np.errstate(divide="ignore"):
        exact = -poses[:, None, None, 2, 3] / height
    seen = (exact > camera.near) & (exact < 0.99 * camera.farthest)
    vertices = (QUAD * 3000 + [120.123, 450.456, 0]) @ turned[:3, :3].T
    with DepthRenderer(SceneMap(vertices, FACES), camera, backend=backend) as renderer:
        depth = renderer.render(state_from_matrix(turned @ pose_matrix(states)))
    assert seen.sum() > 1000
    error = np.abs(depth[seen] - exact[seen])
    assert np.median(error) < 0.0002
    assert np.quantile(error, 0.99 if backend == "vtk" else 0.999) < 0.001  # OpenGL divides in single precision
