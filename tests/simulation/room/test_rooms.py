"""Furnished rooms: geometry, textures, layout, and the room of the experiment."""

import hashlib
import itertools

import numpy as np
import pytest

from course_lib.simulation import textures
from course_lib.simulation.furniture import solids
from course_lib.simulation.room.experiment_room import LAYOUT, make_experiment_room
from course_lib.simulation.room.footprints import footprint, overlap
from course_lib.simulation.room.furnishing import make_room

SEEDS = (3, 11)


@pytest.fixture(scope="module")
def rooms():
    return [make_room(seed) for seed in SEEDS]


@pytest.fixture(scope="module")
def experiment():
    return make_experiment_room()


@pytest.fixture(scope="module")
def cover():
    return textures.cloth(np.random.default_rng(0), (0.8, 0.3, 0.2))


def bytes_of(room) -> str:
    digest = hashlib.sha256()
    for mesh in [*room.shell, *(mesh for item in room.objects for mesh in item.meshes)]:
        for array in (mesh.vertices, mesh.faces, mesh.texture_coordinates, mesh.texture):
            digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(repr((room.lamps, room.ambient, room.height)).encode())
    return digest.hexdigest()


def triangles(meshes) -> np.ndarray:
    return np.concatenate([mesh.vertices[mesh.faces] for mesh in meshes])


def area_vectors(corners: np.ndarray) -> np.ndarray:
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2


def volume(meshes) -> float:
    corners = triangles(meshes)
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6)


def solid_examples(cover):
    path = np.array([(0, 0, 0), (0.1, 0, 0.3), (0.3, 0, 0.5), (0.5, 0.1, 0.5)])
    return {
        "box": (solids.box((0.5, 1.2, 0.3), (1, 2, 3), cover), 0.5 * 1.2 * 0.3, 1e-9),
        "rounded box": (solids.rounded_box((0.5, 1.2, 0.3), (1, 2, 3), cover, 0.02), 0.18, 0.01),
        "cylinder": (solids.cylinder(0.2, 0.6, (1, 2, 0), cover, n=64), np.pi * 0.04 * 0.6, 0.01),
        "bar": (solids.rod([(0, 0, 0), (0, 0.4, 0.3)], 0.02, cover, n=32), np.pi * 0.0004 * 0.5, 0.01),
        "turned box": (solids.turn(solids.box((0.5, 1.2, 0.3), (0, 0, 0), cover), 1, 2, 3, 0.7, 0.4), 0.18, 1e-9),
        "leaf": (solids.swept(path, (0, 1, 0), np.full(4, 0.03), np.full(4, 0.01), cover, n=32), 7.75e-4, 0.08),
    }


@pytest.mark.parametrize("name", ["box", "rounded box", "turned box", "cylinder", "bar", "leaf"])
def test_a_solid_is_closed_and_encloses_its_volume_outwards(cover, name):
    meshes, expected, tolerance = solid_examples(cover)[name]
    vectors = area_vectors(triangles(meshes))
    assert np.abs(vectors.sum(axis=0)).max() < 1e-9 * len(vectors) + 1e-12
    assert volume(meshes) == pytest.approx(expected, rel=max(tolerance, 1e-9))


def test_the_same_seed_makes_the_same_bytes(rooms):
    assert bytes_of(make_room(SEEDS[0])) == bytes_of(rooms[0])
    assert bytes_of(rooms[0]) != bytes_of(rooms[1])
    assert bytes_of(make_experiment_room()) == bytes_of(make_experiment_room())


def test_no_two_pieces_at_one_height_overlap_and_none_leaves_the_room(rooms, experiment):
    for room in [*rooms, experiment]:
        low, high = room.walls.min(axis=0), room.walls.max(axis=0)
        for item in room.objects:
            corners = footprint(item)
            assert (corners >= low).all()
            assert (corners <= high).all()
            np.testing.assert_allclose(corners.mean(axis=0), (item.x, item.y), atol=1e-6)
        for first, second in itertools.combinations(room.objects, 2):
            if overlap(footprint(first), footprint(second)):
                # Only what stands on top: a television on a cabinet.
                lower, upper = sorted((first, second), key=lambda item: item.vertices()[:, 2].min())
                assert (lower.label, upper.label) == ("cabinet", "television")
                assert upper.vertices()[:, 2].min() >= lower.vertices()[:, 2].max() - 0.005


def test_only_the_distance_from_the_centroid_tells_the_sofas_apart(experiment):
    places = np.array([(item.x, item.y) for item in experiment.objects])
    from_centroid = np.linalg.norm(places - places.mean(axis=0), axis=1)
    assert [name for name, *_ in LAYOUT[:3]] == ["sofa south", "sofa east", "sofa west"]
    apart = np.diff(np.sort(from_centroid[:3]))
    # About what boxes get wrong, and less than a few unseen objects move the centroid.
    assert apart.min() > 0.2
    assert apart.max() < 1.2
