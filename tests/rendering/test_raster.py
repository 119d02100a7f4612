"""The z-buffer in compiled loops, and the chunks: what is left out is out of sight, what is cut is the same surface."""

import numpy as np
import pytest
import trimesh

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import optical_pose, state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import MAX_EDGE, MeshChunks, cut_large_triangles
from course_lib.rendering.errors import SceneMapError
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap
from tests.rendering.shapes import OFF_CENTRE, SMALL, random_states, random_triangles

CAMERA = DepthCamera.from_fov(80, 60, 65, 52, near=0.2, far=9.0)


def triangles(rng, count=4000):
    """Triangles of all sizes and attitudes in a room of 8 m, some hidden by large ones."""
    centres = rng.uniform(-4, 4, (count, 1, 3))
    corners = centres + rng.normal(0, 1, (count, 3, 3)) * rng.choice([0.02, 0.1, 0.5, 1.5], (count, 1, 1))
    return SceneMap(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def share_that_differs(scene_map, camera, states):
    """Share of pixels by more than a millimetre; centres on an edge may fall to either side."""
    images = []
    for backend in ("raster", "ray"):
        with DepthRenderer(scene_map, camera, backend, exact=True) as renderer:
            images.append(renderer.render(states))
    with np.errstate(invalid="ignore"):
        difference = np.where(images[0] == images[1], 0.0, np.abs(images[0] - images[1]))
    return np.mean(~(difference < 1e-3))


@pytest.mark.parametrize("seed", range(3))
def test_among_triangles_of_every_size_rays_see_the_same(seed):
    rng = np.random.default_rng(seed)
    states = np.column_stack([rng.uniform(-3, 3, (30, 3)), rng.uniform(-np.pi, np.pi, (30, 3))])
    assert share_that_differs(triangles(rng), CAMERA, states) < 2e-4


def test_in_the_corridor_rays_see_the_same(corridor_folder, rng):
    run = read_sequence(corridor_folder / "wagon")
    states = state_from_optical_pose(run.camera_to_world[::30])
    states = states + rng.normal(0, [0.2, 0.2, 0.1, 0.2, 0.2, 0.5], states.shape)
    assert share_that_differs(SceneMap.load(corridor_folder / "map.ply"), run.camera(), states) < 2e-5


def test_a_small_thing_before_a_wall_and_one_behind_it():
    """The wall is many chunks, drawn after what stands before it; what stands behind is hidden, but for a hole."""
    y, z = np.meshgrid(np.linspace(-4, 3.75, 32), np.linspace(-4, 3.75, 32), indexing="ij")
    squares = np.stack([np.full(y.size, 3.0), y.ravel(), z.ravel()], axis=1)
    squares = squares[np.any(squares[:, 1:] != 0, axis=1)]  # the hole
    wall = np.concatenate([squares[:, None] + 0.25 * np.array([[0, 0, 0], [0, a, 1], [0, 1, 1 - a]]) for a in (0, 1)])
    small = 0.06 * np.array([[0, -1, -1], [0, 1, -1], [0, 0, 1]])
    places = np.array([[2.0, -0.5, 0.3], [5.0, 0.5, -0.3], [6.0, 0.25, 0.25]])
    corners = np.concatenate([wall, np.array([1, 1, 40])[:, None, None] * small + places[:, None]])
    scene_map = SceneMap(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    with DepthRenderer(scene_map, CAMERA, "raster") as renderer:
        image = renderer.render(np.zeros(6))[0]
    assert set(np.unique(image.round(3))) == {2.0, 3.0, 6.0}  # and not 5
    assert share_that_differs(scene_map, CAMERA, np.zeros((1, 6))) < 2e-4


def test_a_chunk_that_a_view_can_see_is_never_left_out_and_leaving_out_the_others_changes_no_pixel(rng, monkeypatch):
    scene = random_triangles(2000, rng, spread=20.0)
    chunks = MeshChunks(scene.vertices, scene.faces)
    poses = optical_pose(random_states(5, rng, spread=9.0))
    visible = np.empty(len(scene.faces), dtype=bool)
    visible[chunks.order] = np.repeat(chunks.visible(OFF_CENTRE, poses, scene.origin), np.diff(chunks.starts))
    for pose in poses:
        corners = (scene.vertices[scene.faces] - pose[:3, 3]) @ pose[:3, :3]
        u, v, z = OFF_CENTRE.project(corners)
        inside = (z > 0) & (z < OFF_CENTRE.far) & (np.abs(u - 30) < 30.5) & (np.abs(v - 23) < 23.5)
        assert visible[inside.any(axis=1)].all()
    assert 0 < visible.sum() < len(visible)
    scene, states = random_triangles(3000, rng, spread=20.0), random_states(16, rng, spread=9.0)
    with DepthRenderer(scene, SMALL, "vtk") as renderer:
        culled = [renderer.render(state) for state in states]
        monkeypatch.setattr(MeshChunks, "visible", lambda self, *_: np.ones(len(self.centers), dtype=bool))
        everything = [renderer.render(state) for state in states]
    assert np.array_equal(np.concatenate(culled), np.concatenate(everything))


@pytest.mark.parametrize("size", [20.0, 33.0, 500.0])
def test_the_pieces_of_large_triangles_cover_the_same_without_a_gap(size, rng):
    ball = trimesh.creation.icosphere(subdivisions=1)
    vertices = size * ball.vertices + rng.normal(size=(42, 3))
    cut, pieces = cut_large_triangles(vertices, ball.faces)
    before, after = (trimesh.Trimesh(v, f, process=False) for v, f in ((vertices, ball.faces), (cut, pieces)))
    assert after.edges_unique_length.max() <= MAX_EDGE
    assert after.area == pytest.approx(before.area)
    assert after.volume == pytest.approx(before.volume)
    assert after.is_watertight
    assert after.is_winding_consistent


def test_what_is_not_large_or_absurdly_large_is_left_and_what_is_too_much_is_an_error():
    quad, faces = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    assert cut_large_triangles(quad, faces)[1] is faces
    assert len(cut_large_triangles(quad * 1e6, faces)[1]) == 2
    with pytest.raises(SceneMapError, match="5,000,000 pieces"):
        cut_large_triangles(quad * 4900, np.tile(faces, (40, 1)))
