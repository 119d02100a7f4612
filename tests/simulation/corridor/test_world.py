"""The true world: how its days differ, and what stays as it is in one building."""

import itertools

import numpy as np
import pytest

from courseware.simulation.corridor.world import CLUTTER, LEFT, DayModel, draw_building, make_corridor, scene_change


@pytest.fixture(scope="module")
def building():
    return draw_building(np.random.default_rng(4))


@pytest.fixture(scope="module")
def world():
    return make_corridor(np.random.default_rng(4))


def moved(one, other, building, boxes=()):
    """Which left doors stand differently in two meshes; nothing differs beside them and the boxes of things."""
    known = set(map(tuple, other.vertices.tolist()))
    x, y, _ = np.array([vertex for vertex in map(tuple, one.vertices.tolist()) if vertex not in known]).T
    doors = [(np.abs(x - row[0]) < row[1] + 0.8) & (y > LEFT - 0.1) for row in building.layout["left doors"]]
    things = [(x >= low[0]) & (x <= high[0]) & (y >= low[1]) & (y <= high[1]) for low, high in boxes]
    assert np.any(doors + things, axis=0).all()
    return np.any(doors, axis=1)


def test_the_seed_decides_the_world_and_only_doors_and_clutter_differ_between_its_days(world, building):
    different = [row[4] != row[5] for row in building.layout["left doors"]]
    assert moved(world.survey_day, world.run_day, building).tolist() == different
    assert (moved(world.run_day, world.survey_day, building, world.clutter_boxes) >= different).all()
    middles = world.clutter_boxes.mean(axis=1)
    assert np.abs(middles - [(thing.x, thing.y) for thing in CLUTTER]).max() < 0.4
    again, other = make_corridor(np.random.default_rng(4)), make_corridor(np.random.default_rng(5))
    assert np.array_equal(world.run_day.vertices, again.run_day.vertices)
    assert not np.array_equal(world.run_day.vertices, other.run_day.vertices)


@pytest.mark.slow
def test_doors_and_things_differ_from_day_to_day_and_from_the_survey(world, building):
    days = [scene_change(building, DayModel(), np.random.default_rng(seed)) for seed in (10_000, 10_001, 10_002)]
    for (one, boxes), (other, others) in itertools.combinations([(world.survey_day, None), *days], 2):
        assert moved(other, one, building, others).sum() >= 2
        if boxes is not None:
            away = np.linalg.norm(boxes.mean(axis=1)[:, None] - others.mean(axis=1), axis=2)
            assert np.median(away.min(axis=1)) > 0.3
