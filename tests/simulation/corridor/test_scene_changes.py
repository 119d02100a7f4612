"""Another day in the same building: the building stays, doors and things change, and a wagon still gets past."""

import numpy as np
import pytest

from course_lib.simulation.corridor.scene_changes import DayModel, scene_change
from course_lib.simulation.corridor.world import draw_building, make_corridor

SEEDS = (10_000, 10_001, 10_002)


@pytest.fixture(scope="module")
def building():
    return draw_building(np.random.default_rng(4))


@pytest.fixture(scope="module")
def days(building):
    return [scene_change(building, DayModel(), np.random.default_rng(seed)) for seed in SEEDS]


@pytest.fixture(scope="module")
def surveyed():
    return make_corridor(np.random.default_rng(4)).survey_day


@pytest.mark.slow
def test_doors_and_things_differ_from_day_to_day_and_from_the_survey(days, surveyed):
    meshes = [surveyed, *(day.mesh for day in days)]
    leaves = [np.array([mesh.part_bounds(f"door {number} leaf") for number in range(7)]) for mesh in meshes]
    for i, one in enumerate(leaves):
        for other in leaves[:i]:
            assert (np.abs(one - other).max(axis=(1, 2)) > 0.1).sum() >= 2
    for i, one in enumerate(days):
        for other in days[:i]:
            middles = [day.clutter_boxes.mean(axis=1) for day in (one, other)]
            nearest = np.linalg.norm(middles[0][:, None] - middles[1][None], axis=2).min(axis=1)
            assert np.median(nearest) > 0.3
