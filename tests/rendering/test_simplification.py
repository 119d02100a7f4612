"""Fewer triangles that look the same: within the tolerance, holes where they were, kept for the next process."""

import numpy as np
import pytest

from course_lib.depth_mcl import DepthCamera, DepthRenderer, SceneMap
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering import simplification


@pytest.fixture(autouse=True)
def a_cache_of_its_own(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    simplification.simplified.cache_clear()
    yield tmp_path / "cache"
    simplification.simplified.cache_clear()


def bumpy_wall(amplitude=0.002, seed=3, n=110):
    """A wall x = 2, 5.2 m wide, of about 2 n^2 triangles: random bumps (m), a step half a metre high, a square hole."""
    grid = np.linspace(-2.6, 2.6, n + 1)
    y, z = (values.ravel() for values in np.meshgrid(grid, grid, indexing="ij"))
    x = 2.0 + np.where(y > 1.0, 0.5, 0.0) + np.random.default_rng(seed).normal(scale=amplitude, size=y.size)
    i, j = (values.ravel() for values in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    in_hole = (np.abs(grid[i]) < 0.4) & (np.abs(grid[j]) < 0.4)
    a = (i * (n + 1) + j)[~in_hole]
    faces = np.concatenate([np.stack([a, a + 1, a + n + 2], axis=1), np.stack([a, a + n + 2, a + n + 1], axis=1)])
    return SceneMap(np.stack([x, y, z], axis=1), faces)


def test_vertices_stay_within_the_tolerance_images_agree_and_the_hole_is_where_it_was():
    scene_map, camera = bumpy_wall(), DepthCamera.from_fov(88, 72, 70.0, 60.0)
    states = np.array([[0, 0, 0, 0, 0, 0], [0.3, -0.2, 0.1, 0.05, -0.1, 0.2]])
    with DepthRenderer(scene_map, camera) as renderer, DepthRenderer(scene_map, camera, exact=True) as exact:
        fewer = renderer.map_to_draw()
        assert exact.map_to_draw() is scene_map
        assert len(fewer) < len(scene_map) / 4
        ours, whole = renderer.render(states), exact.render(states)
    hole = np.isinf(whole)
    assert 0.01 < hole.mean() < 0.2
    assert (np.isinf(ours) != hole).mean() < 0.003, "its edges run within a pixel of where they were"
    both = ~hole & np.isfinite(ours)
    assert np.percentile(np.abs(ours[both] - whole[both]), 98) < simplification.TOLERANCE
    used = scene_map.vertices[np.unique(scene_map.faces)]
    distances = simplification._distances(used - fewer.origin, simplification._welded(fewer))
    assert np.percentile(distances, 99) <= simplification.TOLERANCE
    assert np.percentile(distances, 99) > 0, "some moved"


def test_corners_written_for_each_triangle_are_one_and_what_is_small_or_rough_is_drawn_as_it_is(monkeypatch):
    wall = bumpy_wall()
    soup = SceneMap(wall.vertices[wall.faces].reshape(-1, 3), np.arange(3 * len(wall)).reshape(-1, 3))
    away = SceneMap(wall.vertices + np.array([4e5, 5.6e6, 100.0]), wall.faces)
    for other in (soup, away):
        assert len(simplification.simplified(other)) == pytest.approx(len(simplification.simplified(wall)), rel=0.05)
    small, rough = SceneMap(np.eye(3), np.array([[0, 1, 2]])), bumpy_wall(amplitude=0.3)
    assert simplification.simplified(small) is small
    monkeypatch.setattr(simplification, "TOLERANCE", 0.001)
    assert len(simplification.simplified(rough)) > 0.95 * len(rough)


def test_what_was_found_is_kept_for_the_next_process(monkeypatch, a_cache_of_its_own):
    """And made again where what was kept is damaged, and where nothing can be kept."""
    wall, kept = bumpy_wall(), lambda: list(a_cache_of_its_own.rglob("output.pkl"))
    first = simplification.simplified(wall)
    simplification.simplified.cache_clear()
    with monkeypatch.context() as patched:
        patched.setattr(simplification, "_welded", lambda *_: pytest.fail("it was made again"))
        again = simplification.simplified(wall)
        np.testing.assert_array_equal(again.vertices, first.vertices)
        np.testing.assert_array_equal(again.faces, first.faces)
    simplification.simplified(bumpy_wall(seed=4))
    with monkeypatch.context() as patched:
        patched.setattr(simplification, "TOLERANCE", 0.01)
        simplification.simplified.cache_clear()
        simplification.simplified(wall)
    assert len(kept()) == 3
    file = a_cache_of_its_own / "a file, no folder"
    file.write_text("")
    for path in kept():
        path.write_bytes(path.read_bytes()[:1000])
    for place in (a_cache_of_its_own, file):
        monkeypatch.setenv("XDG_CACHE_HOME", str(place))
        simplification.simplified.cache_clear()
        assert len(simplification.simplified(wall)) == len(first)


def test_against_the_true_world_fewer_triangles_are_no_worse(corridor_folder):
    """Judged by the world as it was on the day of the recording, which no filter sees."""
    recording = read_sequence(corridor_folder / "wagon")
    states = state_from_optical_pose(recording.camera_to_world[::60])
    camera = recording.camera().resized(88, 72)
    scene_map = SceneMap.load(corridor_folder / "map.ply")
    with DepthRenderer(SceneMap.load(corridor_folder / "true_world.ply"), camera, exact=True) as renderer:
        true = renderer.render(states)
    errors = []
    for exact in (True, False):
        with DepthRenderer(scene_map, camera, exact=exact) as renderer:
            images = renderer.render(states)
        both = np.isfinite(true) & np.isfinite(images)
        assert both.mean() > 0.5
        errors.append(np.percentile(np.abs(images[both] - true[both]), [50, 99]))
    assert (errors[1] <= 1.1 * errors[0]).all()
