"""Rooms: what a seed decides, how furniture stands, what looks alike, and where a rig stands and walks in them."""

import itertools

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from courseware.simulation.room.experiment_room import LAYOUT, make_experiment_room
from courseware.simulation.room.furnishing import LookAlikeLimits, make_look_alike_room, make_room
from courseware.simulation.room.look_alike_recording import WalkModel, measurement_poses, walk_from
from courseware.simulation.room.scene import clear_of, distance_to, footprint, overlap

SEEDS = (10_200, 10_201, 10_202)
LIMITS, WALK = LookAlikeLimits(), WalkModel()


@pytest.fixture(scope="module")
def rooms():
    return [make_look_alike_room(seed) for seed in SEEDS]


@pytest.fixture(scope="module")
def training_rooms():
    return [make_room(seed) for seed in (3, 11)]


@pytest.fixture(scope="module")
def experiment():
    return make_experiment_room()


def test_pieces_neither_overlap_nor_leave_the_room_and_some_look_alike(rooms, training_rooms, experiment):
    for room in rooms:
        pieces = [thing for thing in room.objects if thing.label == room.objects[0].label]
        assert pieces[0].label in LIMITS.kinds
        assert 3 <= len(pieces) <= 5
        for other in pieces[1:]:
            for first, second in zip(pieces[0].meshes, other.meshes, strict=True):
                np.testing.assert_array_equal(first.texture, second.texture)
                np.testing.assert_array_equal(first.texture_coordinates, second.texture_coordinates)
                np.testing.assert_allclose(np.ptp(first.vertices[:, 2]), np.ptp(second.vertices[:, 2]))
    assert not np.array_equal(rooms[0].walls, rooms[1].walls), "each seed has its own room"
    ours = (np.ptp(rooms[0].walls, axis=0) - 5.0) / 2.0
    for source in (SEEDS[0], np.random.default_rng(SEEDS[0]).spawn(1)[0]):
        assert not np.allclose((np.ptp(make_room(source).walls, axis=0) - 4.5) / 3.0, ours)
    for room in [*training_rooms, experiment]:
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
    places = np.array([(item.x, item.y) for item in experiment.objects])
    from_centroid = np.linalg.norm(places - places.mean(axis=0), axis=1)
    assert [name for name, *_ in LAYOUT[:3]] == ["sofa south", "sofa east", "sofa west"]
    apart = np.diff(np.sort(from_centroid[:3]))
    # About what boxes get wrong, and less than a few unseen objects move the centroid.
    assert apart.min() > 0.2
    assert apart.max() < 1.2


def test_the_rig_stands_free_in_two_headings_and_every_step_of_a_walk_is_short_and_ends_where_a_rig_can_stand(rooms):
    for seed, room in zip(SEEDS, rooms, strict=True):
        poses = measurement_poses(room, 5, seed)
        assert poses.shape == (5, 3)
        np.testing.assert_array_equal(poses[0:4:2, :2], poses[1:4:2, :2])
        quarters = (poses[1::2, 2] - poses[0:4:2, 2]) / (np.pi / 2)
        np.testing.assert_allclose(quarters, np.round(quarters), atol=1e-9)
        assert (np.round(quarters) % 4 != 0).all()
        assert min(distance_to(footprint(thing), poses[:, :2]).min() for thing in room.objects) >= 0.3
        np.testing.assert_array_equal(measurement_poses(room, 20, seed)[:5], poses)
    rng = np.random.default_rng(0)
    walks = [(start, walk_from(rooms[0], start, 3, rng)) for start in measurement_poses(rooms[0], 20, SEEDS[0])]
    for start, walk in walks:
        poses = np.vstack([start, walk])
        steps = np.linalg.norm(np.diff(poses[:, :2], axis=0), axis=1)
        assert ((steps >= WALK.step[0]) & (steps <= WALK.step[1])).all()
        assert (np.abs(wrap_angle(np.diff(poses[:, 2]))) <= np.deg2rad(WALK.turn_deg)).all()
    places = np.vstack([walk[:, :2] for _, walk in walks])
    assert clear_of([footprint(item) for item in rooms[0].objects], places, WALK.clearance).all()
    low, high = np.min(rooms[0].walls, axis=0) + WALK.wall, np.max(rooms[0].walls, axis=0) - WALK.wall
    assert ((places >= low) & (places <= high)).all()
    np.testing.assert_array_equal(walk_from(rooms[0], walks[0][0], 3, np.random.default_rng(0)), walks[0][1])
