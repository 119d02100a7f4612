"""Lesson 00: equation (8) tells the pose, the floor alone does not, and a search is judged on the circle."""

import numpy as np
import pytest

from courseware.answers.lesson_00 import off_the_top
from courseware.lessons.lesson_00.figures import pose_panel
from courseware.lessons.lesson_00.recorded import mean_votes, moment
from courseware.lessons.lesson_00.search import BUDGET, Score


def test_the_panels_button_finds_the_truth_and_no_surface_loses_a_vote_without_a_step_back():
    panel, now = pose_panel(), moment()
    panel.press("Show the true pose")
    x, y, yaw, _ = panel.values().values()
    np.testing.assert_allclose([x, y, np.deg2rad(yaw)], now.state[[0, 1, 5]], atol=0.03)
    assert all(before == pytest.approx(behind) for before, behind in mean_votes(now, back=0.0).values())


def test_a_score_answers_so_many_poses_alone_and_its_top_is_found_on_the_circle():
    truth = np.array([2.0, 2.0, 0.1])
    score = Score(truth, 0)
    assert score(truth + np.vstack([np.zeros(3), 0.1 * np.eye(3)])).argmax() == 0
    with pytest.raises(RuntimeError, match=f"more than {BUDGET} poses"):
        score(np.tile(truth, (BUDGET - 3, 1)))
    for off, words in (([0.02, 0.02, 2 * np.pi], "None"), ([0.04, 0, 0], "0.04 m"), ([0, 0, -0.026], "1.5 degrees")):
        assert words in str(off_the_top((score, truth), truth + np.array(off)))
