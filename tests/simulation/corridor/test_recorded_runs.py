"""The trajectories: steps, turns, heights, distance from the clutter, and the surveyed line on the floor."""

import numpy as np
import pytest

from courseware.simulation.corridor.recorded_runs import (
    FloorSurveyModel,
    PushModel,
    WagonModel,
    draw_pushing,
    steps_and_turns,
    survey_floor_line,
    wagon_run,
)
from courseware.simulation.corridor.world import make_corridor

SEEDS = (0, 1, 2, 3)


@pytest.fixture(scope="module")
def boxes():
    return make_corridor(np.random.default_rng(4)).clutter_boxes


@pytest.mark.parametrize("seed", SEEDS)
def test_the_wagon_takes_short_steps_clear_of_the_clutter_and_if_pushed_varies_its_speed(boxes, seed):
    states, times = wagon_run(WagonModel(), boxes, np.random.default_rng(seed))
    step, turn = steps_and_turns(states)
    assert len(states) == len(times) >= 300
    assert 0.08 < step.mean() < step.max() <= 0.1
    assert np.rad2deg(turn.max()) < 3.0
    assert np.diff(times) == pytest.approx(0.1)
    assert 0.0002 < np.abs(states[:, 2] - 1.0).max() <= 0.002 + 1e-9
    assert 0.02 < np.rad2deg(np.abs(states[:, 3:5])).max() <= 0.2 + 1e-9
    for low, high in boxes:
        gap = np.maximum(np.maximum(low - states[:, :2], states[:, :2] - high), 0)
        assert np.hypot(*gap.T).min() > 0.33
    assert np.ptp(states[:, 1]) > 0.2
    even, step = step, steps_and_turns(pushed(boxes, seed))[0]
    standing = step < 0.003
    assert standing.sum() >= 4
    assert np.std(step[~standing]) / np.mean(step[~standing]) > 0.2
    assert np.std(even) / np.mean(even) < 0.03
    assert 0.12 < step.max() < 0.19
    # It never rolls back, and stays in the corridor of 40 m from wherever a seed's run may start.
    assert step.sum() < 1.15 * even.sum()


def test_the_floor_line_is_dense_and_millimetres_from_the_path(boxes):
    states, _ = wagon_run(WagonModel(), boxes, np.random.default_rng(0))
    line = survey_floor_line(states, FloorSurveyModel(), np.random.default_rng(1))
    path_length = np.linalg.norm(np.diff(states[:, :2], axis=0), axis=1).sum()
    assert len(line) == pytest.approx(path_length / 0.01, rel=0.01)
    nearest = np.min(np.linalg.norm(states[::20, None, :2] - line[None, :, :2], axis=2), axis=1)
    assert nearest.max() < 0.02
    assert np.abs(line[:, 2]).max() < 0.03
    # Also where the wagon stands still.
    line = survey_floor_line(pushed(boxes, 1), FloorSurveyModel(noise=0.0, registration=0.0), np.random.default_rng(1))
    assert np.linalg.norm(np.diff(line[:, :2], axis=0), axis=1) == pytest.approx(0.01, abs=1e-3)


def pushed(boxes, seed):
    pushing = draw_pushing(PushModel(), WagonModel().frames, np.random.default_rng(seed + 100))
    return wagon_run(WagonModel(), boxes, np.random.default_rng(seed), pushing)[0]
