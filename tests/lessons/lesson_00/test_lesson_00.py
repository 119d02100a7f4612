"""Lesson 00's plumbing: equation (8) peaks at the true pose of the recorded frame, and drawing can be checked."""

import numpy as np
import pytest

from course_lib.depth_mcl.likelihood import likelihood
from course_lib.lessons.lesson_00.exercises import BUDGET, Score, off_the_top
from course_lib.lessons.lesson_00.panel import pose_panel
from course_lib.lessons.lesson_00.recorded import mean_votes, moment, moved, wall_reads


def test_a_wall_reads_its_distance():
    assert wall_reads(2.0) == pytest.approx(2.0, abs=0.0005)
    assert wall_reads(5.5) == pytest.approx(5.5, abs=0.0005)


def test_one_number_of_the_state_is_moved_and_yaw_in_degrees():
    states = moved(np.zeros(6), "yaw", np.array([-90.0, 90.0]))
    np.testing.assert_allclose(states[:, 5], [-np.pi / 2, np.pi / 2])
    assert not states[:, :5].any()
    assert moved(np.zeros(6), "y", np.array([0.5]))[0].tolist() == [0, 0.5, 0, 0, 0, 0]


@pytest.mark.parametrize(("name", "offsets"), [("x", [-0.3, 0, 0.3]), ("y", [-0.2, 0, 0.2]), ("yaw", [-5, 0, 5])])
def test_equation_8_is_greatest_at_the_true_pose(name, offsets):
    now = moment()
    share = now.share(moved(now.state, name, np.array(offsets)))
    assert share.argmax() == 1
    assert 0 < share.min() < share.max() < 1


def test_the_panel_starts_wrong_and_its_button_finds_the_truth():
    panel = pose_panel()
    before = panel.draw(**panel.defaults()).summary
    panel.press("Show the true pose")
    found = panel.values()
    now = moment()
    assert abs(found["x"] - now.state[0]) <= 0.03
    assert abs(found["y"] - now.state[1]) <= 0.03
    assert abs(found["yaw"] - np.rad2deg(now.state[5])) <= 0.26
    after = panel.draw(**found).summary
    share = [float(text.split("l / m = ")[1].split(" ")[0]) for text in (before, after)]
    assert share[1] > share[0] + 0.1


def test_the_floor_alone_does_not_tell_x():
    now = moment()
    row, column = np.indices(now.measured.shape)
    floor = np.where((row >= 115) & (np.abs(column - 90) < 40), now.measured, np.nan)
    x = np.linspace(-1.5, 1.5, 25)
    views = now.renderer.render(moved(now.state, "x", x))
    whole, alone = likelihood(now.measured, views), likelihood(floor, views)
    assert alone.min() > 0.9 * alone.max()
    assert whole.min() < 0.6 * whole.max()
    assert abs(x[alone.argmax()]) > 0.5
    assert abs(x[whole.argmax()]) < 0.2


def test_the_floor_loses_least_from_behind_and_the_sides_most():
    votes = mean_votes(moment(), back=0.3)
    lost = {name: before - behind for name, (before, behind) in votes.items()}
    assert lost["floor"] < 0.02
    assert lost["floor"] < lost["ceiling"] < 0.1
    assert min(lost["left side"], lost["right side"]) > 0.15
    assert all(before == pytest.approx(behind) for before, behind in mean_votes(moment(), back=0.0).values())


TRUTH = np.array([2.0, 2.0, 0.1])


def test_a_score_is_greatest_at_the_truth_and_answers_so_many_poses_alone():
    score = Score(TRUTH, np.arange(5))
    around = TRUTH + np.vstack([np.zeros(3), 0.1 * np.eye(3), -0.1 * np.eye(3)])
    assert score(around).argmax() == 0
    assert score(TRUTH) == pytest.approx(score(TRUTH[None])[0])
    score(np.tile(TRUTH, (BUDGET - score.asked, 1)))
    with pytest.raises(RuntimeError, match=f"more than {BUDGET} poses"):
        score(TRUTH)
    with pytest.raises(ValueError, match=r"poses \(N, 3\)"):
        score(np.zeros((4, 6)))


def test_the_end_of_a_search_is_judged_by_place_and_heading_on_the_circle():
    given = Score(TRUTH, np.arange(5)), TRUTH
    assert off_the_top(given, np.add(TRUTH, [0.02, 0.02, 0.015])) is None
    assert off_the_top(given, [np.add(TRUTH, [0, 0, 2 * np.pi])]) is None
    assert "0.04 m" in off_the_top(given, np.add(TRUTH, [0.04, 0, 0]))
    assert "1.5 degrees" in off_the_top(given, TRUTH - [0, 0, np.deg2rad(1.5)])
    assert "three finite numbers" in off_the_top(given, [1.0, np.nan, 0.0])
    assert "three numbers" in off_the_top(given, "here")
