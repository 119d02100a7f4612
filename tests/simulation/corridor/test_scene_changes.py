"""Another day in the same building: the building stays, doors and things change, and a wagon still gets past."""

import numpy as np
import pytest

from course_lib.simulation.corridor.recorded_runs import WagonModel, wagon_run
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


@pytest.mark.parametrize("number", range(len(SEEDS)))
def test_things_stand_apart_inside_the_corridor_and_the_wagon_gets_past(days, number):
    boxes = days[number].clutter_boxes
    assert 6 <= len(boxes) <= 12
    assert np.diff(np.sort(boxes.mean(axis=1)[:, 0])).min() > 1.8
    assert np.abs(boxes[:, :, 1]).max() < 1.45
    states, _ = wagon_run(WagonModel(), boxes, np.random.default_rng(number))
    for low, high in boxes:
        gap = np.maximum(np.maximum(low - states[:, :2], states[:, :2] - high), 0)
        assert np.hypot(*gap.T).min() > 0.33
