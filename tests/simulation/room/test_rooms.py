"""Furnished rooms: geometry, textures, layout, and the room of the experiment."""

import hashlib
import itertools

import numpy as np
import pytest

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


def bytes_of(room) -> str:
    digest = hashlib.sha256()
    for mesh in [*room.shell, *(mesh for item in room.objects for mesh in item.meshes)]:
        for array in (mesh.vertices, mesh.faces, mesh.texture_coordinates, mesh.texture):
            digest.update(np.ascontiguousarray(array).tobytes())
    digest.update(repr((room.lamps, room.ambient, room.height)).encode())
    return digest.hexdigest()


@pytest.mark.slow
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
