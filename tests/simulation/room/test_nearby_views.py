"""A walk of a few steps: near each other, where a rig can stand, and the same for the same seed."""

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.simulation.room.footprints import clear_of, footprint
from course_lib.simulation.room.look_alike_recording import WalkModel, experiment_of, measurement_poses, walk_from
from course_lib.simulation.room.look_alike_room import make_look_alike_room

ROOM, WALK = make_look_alike_room(10_210), WalkModel()


def walks(seed=0):
    rng = np.random.default_rng(seed)
    return [(start, walk_from(ROOM, start, 3, rng)) for start in measurement_poses(ROOM, 20, 10_210)]


def test_every_step_is_short_and_every_turn_small():
    for start, walk in walks():
        poses = np.vstack([start, walk])
        steps = np.linalg.norm(np.diff(poses[:, :2], axis=0), axis=1)
        assert ((steps >= WALK.step[0]) & (steps <= WALK.step[1])).all()
        assert (np.abs(wrap_angle(np.diff(poses[:, 2]))) <= np.deg2rad(WALK.turn_deg)).all()


def test_the_rig_stands_clear_of_furniture_and_walls():
    places = np.vstack([walk[:, :2] for _, walk in walks()])
    assert clear_of([footprint(item) for item in ROOM.objects], places, WALK.clearance).all()
    low, high = np.min(ROOM.walls, axis=0) + WALK.wall, np.max(ROOM.walls, axis=0) - WALK.wall
    assert ((places >= low) & (places <= high)).all()


def test_one_seed_one_walk():
    np.testing.assert_array_equal(walks(3)[4][1], walks(3)[4][1])
    assert not np.array_equal(walks(3)[4][1], walks(4)[4][1])


def test_where_no_step_is_free_the_rig_turns():
    walk = walk_from(ROOM, np.array([2.0, 2.0, 0.0]), 2, np.random.default_rng(0), WalkModel(clearance=50.0))
    np.testing.assert_array_equal(walk[:, :2], [[2.0, 2.0], [2.0, 2.0]])
    assert (walk[:, 2] != 0).all()


def test_the_two_heights_take_turns():
    assert [experiment_of(k) for k in range(4)] == [1, 2, 1, 2]
