"""The z-buffer in compiled loops: what it leaves out is out of sight, and ray casting sees the same."""

import numpy as np
import pytest

from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.chunks import MeshChunks
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.scene_map import SceneMap

CAMERA = DepthCamera.from_fov(80, 60, 65, 52, near=0.2, far=9.0)


def triangles(rng, count=4000):
    """Triangles of all sizes and attitudes in a room of 8 m, some hidden by large ones."""
    centres = rng.uniform(-4, 4, (count, 1, 3))
    corners = centres + rng.normal(0, 1, (count, 3, 3)) * rng.choice([0.02, 0.1, 0.5, 1.5], (count, 1, 1))
    return SceneMap(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def states_among_them(rng, count):
    return np.column_stack([rng.uniform(-3, 3, (count, 3)), rng.uniform(-np.pi, np.pi, (count, 3))])


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
    assert share_that_differs(triangles(rng), CAMERA, states_among_them(rng, 30)) < 2e-4


def test_in_the_corridor_rays_see_the_same(corridor_folder, rng):
    run = read_sequence(corridor_folder / "wagon")
    states = state_from_optical_pose(run.camera_to_world[::30])
    states = states + rng.normal(0, [0.2, 0.2, 0.1, 0.2, 0.2, 0.5], states.shape)
    assert share_that_differs(SceneMap.load(corridor_folder / "map.ply"), run.camera(), states) < 2e-5


@pytest.mark.parametrize("size", [(1, 1), (7, 5), (8, 8), (9, 17), (176, 144)])
@pytest.mark.parametrize("count", [1, 8, 9])
def test_images_and_batches_of_every_size_are_drawn_to_their_last_pixel(size, count, rng):
    wall = SceneMap([[2.0, -50, -50], [2, 50, -50], [2, 0, 99]], [[0, 1, 2]])
    with DepthRenderer(wall, CAMERA.resized(*size)) as renderer:
        images = renderer.render(np.zeros((count, 6)))
    assert images.shape == (count, size[1], size[0])
    assert images == pytest.approx(np.full(images.shape, 2.0), abs=1e-5)


def test_a_small_thing_before_a_wall_and_one_behind_it(rng):
    """The wall is many chunks, drawn after what stands before it; what stands behind is hidden, but for a hole."""
    y, z = np.meshgrid(np.linspace(-4, 4, 33), np.linspace(-4, 4, 33), indexing="ij")
    corner = np.stack([np.full(y.shape, 3.0), y, z], -1)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], 2).reshape(-1, 4, 3)
    hole = np.all(np.abs(quads.mean(axis=1)[:, 1:] - [0.125, 0.125]) < 0.1, axis=1)
    assert hole.sum() == 1
    wall = np.concatenate([quads[~hole][:, [0, 1, 2]], quads[~hole][:, [0, 2, 3]]])
    small = 0.06 * np.array([[0, -1, -1], [0, 1, -1], [0, 0, 1]])
    places = np.array([[2.0, -0.5, 0.3], [5.0, 0.5, -0.3], [6.0, 0.25, 0.25]])
    things = np.array([1, 1, 40])[:, None, None] * small + places[:, None]
    corners = np.concatenate([wall, things])
    scene_map = SceneMap(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    with DepthRenderer(scene_map, CAMERA) as renderer:
        image = renderer.render(np.zeros(6))[0]
    assert set(np.unique(image.round(3))) == {2.0, 3.0, 6.0}  # and not 5
    assert share_that_differs(scene_map, CAMERA, np.zeros((1, 6))) < 2e-4


def test_every_triangle_stands_in_one_chunk_with_its_own_corners(rng):
    scene_map = triangles(rng, 500)
    chunks = MeshChunks(scene_map.vertices, scene_map.faces)
    vertices, starts, faces = chunks.with_own_vertices(scene_map.faces, scene_map.vertices)
    chunk = np.repeat(np.arange(len(starts) - 1), np.diff(chunks.starts))
    again = vertices[faces + starts[chunk][:, None]]
    assert np.array_equal(again, scene_map.vertices[scene_map.faces[chunks.order]])
    assert (faces < np.diff(starts)[chunk][:, None]).all()
