"""Rooms of look-alikes: within their written limits, one room a seed, no room of the training generator."""

import numpy as np
import pytest

from course_lib.geometry import wrap_angle
from course_lib.simulation.room.footprints import clear_of, distance_to, footprint
from course_lib.simulation.room.furnishing import make_room
from course_lib.simulation.room.look_alike_recording import WalkModel, measurement_poses, walk_from
from course_lib.simulation.room.look_alike_room import LookAlikeLimits, make_look_alike_room

SEEDS = (10_200, 10_201, 10_202)
LIMITS = LookAlikeLimits()


@pytest.fixture(scope="module")
def rooms():
    return [make_look_alike_room(seed) for seed in SEEDS]


def alike(room):
    return [thing for thing in room.objects if thing.label == room.objects[0].label]


def test_three_to_five_pieces_of_one_class_are_one_piece_in_several_places(rooms):
    for room in rooms:
        pieces = alike(room)
        assert pieces[0].label in LIMITS.kinds
        assert 3 <= len(pieces) <= 5
        for other in pieces[1:]:
            for first, second in zip(pieces[0].meshes, other.meshes, strict=True):
                np.testing.assert_array_equal(first.texture, second.texture)
                np.testing.assert_array_equal(first.texture_coordinates, second.texture_coordinates)
                np.testing.assert_allclose(np.ptp(first.vertices[:, 2]), np.ptp(second.vertices[:, 2]))


@pytest.mark.slow
def test_one_seed_gives_one_room_another_draw_another_and_none_is_the_training_generators(rooms):
    def places(room):
        return [(thing.label, thing.x, thing.y) for thing in room.objects]

    assert places(make_look_alike_room(SEEDS[0])) == places(rooms[0])
    assert places(make_look_alike_room(SEEDS[0], draw=1)) != places(rooms[0])
    assert places(rooms[0]) != places(rooms[1])
    # The first random number of both is the room's size: here as a share of each generator's range.
    ours = (np.ptp(rooms[0].walls, axis=0) - 5.0) / 2.0
    for source in (SEEDS[0], np.random.default_rng(SEEDS[0]).spawn(1)[0]):
        assert not np.allclose((np.ptp(make_room(source).walls, axis=0) - 4.5) / 3.0, ours)


def test_the_rig_stands_free_in_two_headings_at_every_place(rooms):
    for seed, room in zip(SEEDS, rooms, strict=True):
        poses = measurement_poses(room, 5, seed)
        assert poses.shape == (5, 3)
        np.testing.assert_array_equal(poses[0:4:2, :2], poses[1:4:2, :2])
        quarters = (poses[1::2, 2] - poses[0:4:2, 2]) / (np.pi / 2)
        np.testing.assert_allclose(quarters, np.round(quarters), atol=1e-9)
        assert (np.round(quarters) % 4 != 0).all()
        assert min(distance_to(footprint(thing), poses[:, :2]).min() for thing in room.objects) >= 0.3
        np.testing.assert_array_equal(measurement_poses(room, 20, seed)[:5], poses)


WALK = WalkModel()


@pytest.fixture(scope="module")
def walks(rooms):
    rng = np.random.default_rng(0)
    starts = measurement_poses(rooms[0], 20, SEEDS[0])
    return [(start, walk_from(rooms[0], start, 3, rng)) for start in starts]


def test_every_step_of_a_walk_is_short_and_ends_where_a_rig_can_stand(walks, rooms):
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
