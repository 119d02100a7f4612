"""The planar map: large planes stay, flattened; small things and clutter of the surface go."""

import numpy as np
import pytest
import trimesh

from course_lib.rendering.scene_map import SceneMap
from tools.planar_map import planar_simplification


def rough_room(rng, noise=0.01):
    room = trimesh.creation.box((4.0, 3.0, 2.5)).subdivide_to_size(0.15)
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.2)
    vertices = np.concatenate([room.vertices + noise * rng.uniform(-1, 1, room.vertices.shape), ball.vertices])
    return SceneMap(vertices, np.concatenate([room.faces, ball.faces + len(room.vertices)]))


def area(scene_map):
    a, b, c = np.moveaxis(scene_map.vertices[scene_map.faces], 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()


def test_the_six_walls_stay_the_ball_goes_and_a_plane_is_fitted_by_area():
    rough = rough_room(np.random.default_rng(0))
    planar = planar_simplification(rough, np.random.default_rng(1))
    assert area(planar) == pytest.approx(2 * (4 * 3 + 4 * 2.5 + 3 * 2.5), rel=0.05)
    assert len(planar.faces) < 0.2 * len(rough.faces)
    used = planar.vertices[np.unique(planar.faces)]
    assert (np.linalg.norm(used, axis=1) > 1.0).all()
    # Nine square metres in 18 triangles outweigh one in thousands, 40 mm above: the plane stays near the large one.
    coarse, fine = (
        trimesh.Trimesh([[x, x, z], [y, x, z], [y, y, z], [x, y, z]], [[0, 1, 2], [0, 2, 3]])
        for x, y, z in ((0.0, 3.0, 0.0), (1.0, 2.0, 0.04))
    )
    both = trimesh.util.concatenate([coarse.subdivide_to_size(1.5), fine.subdivide_to_size(0.04)])
    kept = planar_simplification(SceneMap(both.vertices, both.faces), np.random.default_rng(0), reduction=0.0)
    assert len(both.faces) > 1000
    assert np.abs(kept.vertices[:, 2]).max() < 0.012
