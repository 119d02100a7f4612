"""Project P4: an unknown camera's raw numbers, and what a calibrated depth is worth."""

import numpy as np
import pytest

from courseware.answers.project_4_rivals import in_metres
from courseware.answers.project_4_task import measure, prepare
from courseware.lessons.kit.projects import AnswerError
from courseware.lessons.project_4.sessions import MAX_RANGE, session


def test_seeds_differ_in_what_is_secret_and_unit_and_code_are_found():
    sessions = [session(seed) for seed in range(10_001, 10_007)]
    for given, secrets in sessions:
        ranges, _ = in_metres(given.walls, given.distances, given.frames)
        assert np.array_equal(np.isnan(ranges), given.frames == secrets.invalid)
        assert np.nanmax(np.abs(ranges - given.frames / secrets.units)) == 0
        assert 0.04 < abs(given.intrinsics[0, 0] / secrets.focal - 1) < 0.13
    assert min(len({getattr(secrets, name) for _, secrets in sessions}) for name in ("units", "invalid", "focal")) > 2


def test_the_truth_costs_nothing_refusing_50_mm_and_a_depth_where_nothing_was_measured_200():
    task = prepare(10_001)
    true, measured = task.truth
    exact = np.where(measured & np.isfinite(true), true, np.nan)
    costs = [measure(task, exact + off).value for off in (0, 0.03, -5.0, np.nan)]
    assert costs == pytest.approx([0, 30, 200, 50], abs=1e-9)
    lost = (~measured)[true < MAX_RANGE].mean()
    assert measure(task, np.where(np.isfinite(true), true, 1.0)).value == pytest.approx(200 * lost)
    for answer, words in ((None, "one depth"), ("deep", "no array of numbers"), (0 * true + np.inf, "with NaN")):
        with pytest.raises(AnswerError, match=words):
            measure(task, answer)
