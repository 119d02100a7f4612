"""The true world: sizes, what it holds, how its two days differ, and that no spacing repeats."""

import numpy as np
import pytest

from course_lib.simulation.corridor import world as corridor
from course_lib.simulation.corridor.world import make_corridor


@pytest.fixture(scope="module")
def world():
    return make_corridor(np.random.default_rng(4))


def test_only_doors_and_clutter_differ_between_the_days(world):
    survey, run = world.survey_day, world.run_day
    for part in ("wall", "radiator", "notice board", "cable tray"):
        one, other = (mesh.vertices[mesh.faces[mesh.faces_of(part)]] for mesh in (survey, run))
        assert np.array_equal(one, other)
    leaves = [
        np.array([mesh.part_bounds(f"door {number} leaf") for number in range(len(corridor.LEFT_DOORS))])
        for mesh in (survey, run)
    ]
    moved = np.abs(leaves[0] - leaves[1]).max(axis=(1, 2)) > 0.1
    assert moved.tolist() == [row[4] != row[5] for row in corridor.LEFT_DOORS]
    assert len(survey.faces_of("clutter")) == 0
    kinds = {name.split()[-1] for name in run.part_names if name.startswith("clutter")}
    assert kinds == {thing.kind for thing in corridor.CLUTTER}
    assert len(world.clutter_boxes) == len(corridor.CLUTTER)


def test_the_seed_decides_the_world(world):
    again, other = make_corridor(np.random.default_rng(4)), make_corridor(np.random.default_rng(5))
    assert np.array_equal(world.run_day.vertices, again.run_day.vertices)
    assert not np.array_equal(world.run_day.vertices, other.run_day.vertices)
