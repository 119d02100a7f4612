"""Lesson 19: a place has one recording, two answers that err together join with care, and the story is true."""

import numpy as np
import pytest

from courseware.lessons.foundation_3.fusion import covariance_intersection
from courseware.lessons.lesson_19 import panel, stages
from courseware.lessons.lesson_19.panel import anywhere_panel
from courseware.lessons.lesson_19.stages import journey, misplaced, turn_and_look, world

STORY = (3.35, 3.30, 65)


def test_who_comes_back_to_a_place_finds_the_same_recording():
    here, place = world(), journey(*STORY)
    assert np.array_equal(here.photographs(place.pose), place.images)
    assert np.array_equal(here.depth_images(place.pose)[1], place.depths, equal_nan=True)
    elsewhere = here.depth_images(np.add(place.pose, [0.01, 0, 0]))[0]
    assert not np.allclose(elsewhere[:, 2], place.states[:, 2], atol=1e-6)


def test_start_and_filter_err_together_so_a_kalman_update_claims_more_than_covariance_intersection():
    place = journey(*STORY)
    first, known = place.best[0], stages.start_covariance(place.found.covariance)
    both = stages.start_state(place.found.pose), known, first.state, first.error_covariance
    _, careful, omega = covariance_intersection(*both)
    kalman = np.linalg.inv(np.linalg.inv(known) + np.linalg.inv(first.error_covariance))
    assert 0 < omega < 1
    assert np.linalg.eigvalsh(careful - kalman).min() > 0
    assert np.diag(careful)[[0, 1, 5]] == pytest.approx(np.array([0.025, 0.0055, np.deg2rad(0.23)]) ** 2, rel=0.2)


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
