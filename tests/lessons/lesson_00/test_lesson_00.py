"""Lesson 00's plumbing: equation (8) peaks at the true pose of the recorded frame, and drawing can be checked."""

from __future__ import annotations

import numpy as np
import pytest

from course_lib.depth_mcl.likelihood import likelihood
from course_lib.lessons.lesson_00.panel import pose_panel
from course_lib.lessons.lesson_00.recorded import moment, moved, wall_reads


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
