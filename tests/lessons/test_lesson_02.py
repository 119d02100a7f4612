"""Lesson 02: what it says of its room's maps, and how its predictions are judged."""

import numpy as np
import pytest

from courseware.answers.lesson_02 import lateral_sigma, off_the_sigma
from courseware.lessons.lesson_02.small_room import STATIONS, quality, room, scans


def test_the_room_itself_is_its_own_best_map_and_the_stations_stand_in_the_open():
    found = quality(room().mesh())
    assert (found.p90 < 1e-6, found.holes, found.false) == (True, 0, 0)
    places = np.column_stack([STATIONS, np.full(4, 1.6)])[:, None]
    assert not ((room().low < places) & (room().high > places)).all(axis=2).any()


def test_another_seed_is_another_survey():
    first, second = (scans(1, registration_mm=20, seed=seed)[0] for seed in (1, 3))
    assert not np.allclose(first.registered_pose, second.registered_pose, atol=0.001)


@pytest.mark.parametrize(("factor", "words"), [(1.04, "None"), (0.96, "None"), (1.06, "large"), (0.94, "small")])
def test_a_predicted_sigma_may_be_five_percent_off_and_no_more(factor, words):
    given = (10, 5.0, 0.006, np.deg2rad(0.03))
    assert words in str(off_the_sigma(given, [factor * lateral_sigma(*given)]))
