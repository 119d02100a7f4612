"""Lesson 19: a place has one recording, two answers join by their information, and the lesson's story is true."""

import numpy as np
import pytest

from course_lib.lessons.lesson_19 import anywhere_panel, journey, misplaced, panel, stages, turn_and_look, world

STORY = (3.35, 3.30, 65)


def test_who_comes_back_to_a_place_finds_the_same_recording():
    here, place = world(), journey(*STORY)
    assert np.array_equal(here.photographs(place.pose), place.images)
    assert np.array_equal(here.depth_images(place.pose)[1], place.depths, equal_nan=True)
    elsewhere = here.depth_images(np.add(place.pose, [0.01, 0, 0]))[0]
    assert not np.allclose(elsewhere[:, 2], place.states[:, 2], atol=1e-6)


def test_information_adds_up_and_angles_are_joined_across_the_half_turn(rng):
    a, b = (m @ m.T + np.eye(6) for m in rng.standard_normal((2, 6, 6)))
    x, y = rng.uniform(-1, 1, (2, 6))
    state, covariance = stages.joined(x, a, y, b)
    assert np.linalg.inv(covariance) == pytest.approx(np.linalg.inv(a) + np.linalg.inv(b))
    assert state == pytest.approx(covariance @ (np.linalg.solve(a, x) + np.linalg.solve(b, y)))
    yaw = np.eye(6)[5]
    assert stages.joined(3.0 * yaw, np.eye(6), -2.9 * yaw, np.eye(6))[0] == pytest.approx((0.05 - np.pi) * yaw)


def test_the_filter_chooses_among_look_alikes_and_a_robot_at_a_wall_turns_and_knows():
    crowded, wall = journey(*STORY, hidden_share=0.8), journey(1.70, 4.40, 60)
    ends = [stages.state_error(run[-1].state, crowded.states[-1])[0] for run in crowded.runs]
    assert (crowded.found.pose, len(ends), crowded.reached, wall.best[-1].status) == (None, 3, True, "lost")
    assert all(run[-1].status == "lost" for run, end in zip(crowded.runs, ends, strict=True) if end > 1)
    error, views, knows = turn_and_look(wall)
    assert (error[0] < 0.03, error[1] < 1, views > 1, knows) == (True, True, True, True)
    assert (journey(*STORY, lens_cap=True).best, journey(*STORY, hidden_share=1.0).starts) == (None, [])
    arrived = [misplaced([journey(*STORY)], *off, 1, np.random.default_rng(0)) for off in ((0.1, 0), (0.0, 180))]
    assert arrived == [[True], [False]]


def test_neither_a_slider_nor_a_place_inside_furniture_runs_the_methods(monkeypatch):
    shown = anywhere_panel()
    monkeypatch.setattr(panel, "journey", lambda *_: pytest.fail("the methods ran"))
    assert 'press "Locate"' in shown.draw(**(shown.defaults() | {"x": 2.0})).summary
    assert shown.actions["Locate"](sofa := shown.defaults() | {"x": 5.6, "y": 1.2}) == {}
    assert "Nobody can stand inside a sofa" in shown.draw(**sofa).summary
