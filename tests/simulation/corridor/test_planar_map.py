"""The planar map: large planes stay, flattened; small things and clutter of the surface go."""

import numpy as np
import pytest
import trimesh

from course_lib.rendering.scene_map import SceneMap
from course_lib.simulation.corridor.planar_map import planar_simplification


def rough_room(rng, noise=0.01):
    """A room of 4 x 3 x 2.5 m with bumpy walls, and a ball of 0.2 m radius in it."""
    room = trimesh.creation.box((4.0, 3.0, 2.5)).subdivide_to_size(0.15)
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.2)
    vertices = np.concatenate([room.vertices + noise * rng.uniform(-1, 1, room.vertices.shape), ball.vertices])
    return SceneMap(vertices, np.concatenate([room.faces, ball.faces + len(room.vertices)]))


def area(scene_map):
    a, b, c = np.moveaxis(scene_map.vertices[scene_map.faces], 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


@pytest.fixture(scope="module")
def planar():
    return planar_simplification(rough_room(np.random.default_rng(0)), np.random.default_rng(1))


def test_the_six_walls_stay_and_the_ball_goes(planar):
    assert area(planar) == pytest.approx(2 * (4 * 3 + 4 * 2.5 + 3 * 2.5), rel=0.05)
    assert len(planar.faces) < 0.2 * len(rough_room(np.random.default_rng(0)).faces)
    used = planar.vertices[np.unique(planar.faces)]
    assert (np.linalg.norm(used, axis=1) > 1.0).all()


def test_walls_are_flat_to_a_millimetre(planar):
    corners = planar.vertices[planar.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    large = np.linalg.norm(normals, axis=1) > 1e-3
    unit = normals[large] / np.linalg.norm(normals[large], axis=1, keepdims=True)
    for axis, half in enumerate((2.0, 1.5, 1.25)):
        mine = corners[large][np.abs(unit[:, axis]) > 0.9][..., axis]
        for side in (-1, 1):
            wall = mine[np.sign(mine[:, 0]) == side]
            assert np.std(wall) < 0.005
            assert np.mean(wall) == pytest.approx(side * half, abs=0.005)


def sheets(*sizes_and_places):
    """Horizontal square sheets, each (side, x, z), of triangles of about a decimetre."""
    parts = []
    for side, x, z in sizes_and_places:
        corners = np.array([[x, 0, z], [x + side, 0, z], [x + side, side, z], [x, side, z]])
        parts.append(trimesh.Trimesh(corners, [[0, 1, 2], [0, 2, 3]]).subdivide_to_size(0.15))
    both = trimesh.util.concatenate(parts)
    return SceneMap(both.vertices, both.faces)


def test_a_small_plane_is_dropped_by_its_area():
    scene_map = sheets((3.0, 0.0, 0.0), (0.5, 0.0, 2.0))
    kept = planar_simplification(scene_map, np.random.default_rng(0), min_area=1.0)
    assert kept.bounds[1][2] < 0.1
    kept = planar_simplification(scene_map, np.random.default_rng(0), min_area=0.2)
    assert kept.bounds[1][2] > 1.9
    assert area(kept) == pytest.approx(9.25, rel=1e-3)


def test_pieces_of_one_plane_are_judged_one_by_one():
    """A shelf at the height of a far table is no part of it: regions with a gap between them count alone."""
    scene_map = sheets((2.0, 0.0, 0.7), (0.4, 5.0, 0.7))
    kept = planar_simplification(scene_map, np.random.default_rng(0))
    assert kept.bounds[1][0] == pytest.approx(2.0)


def test_a_plane_is_fitted_by_area_and_not_by_the_number_of_triangles():
    """Nine square metres in 18 triangles outweigh one in thousands, 40 mm above: the plane stays near the large one."""
    coarse, fine = (
        trimesh.Trimesh([[x, x, z], [y, x, z], [y, y, z], [x, y, z]], [[0, 1, 2], [0, 2, 3]])
        for x, y, z in ((0.0, 3.0, 0.0), (1.0, 2.0, 0.04))
    )
    both = trimesh.util.concatenate([coarse.subdivide_to_size(1.5), fine.subdivide_to_size(0.04)])
    kept = planar_simplification(SceneMap(both.vertices, both.faces), np.random.default_rng(0), reduction=0.0)
    assert len(both.faces) > 1000
    assert np.abs(kept.vertices[:, 2]).max() < 0.012


def test_without_large_planes_it_says_so():
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.3)
    with pytest.raises(ValueError, match="no plane of 1 square metres"):
        planar_simplification(SceneMap(ball.vertices, ball.faces), np.random.default_rng(0))
