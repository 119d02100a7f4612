"""What lesson 10 says about its hotel, its filters and its alarm holds."""

import numpy as np
import pytest

from courseware.lessons.lesson_10.hotel_floor import ALIKE, OUT_OF_101, carried_next_door, record, walk
from courseware.lessons.lesson_10.narrowing import MAX_PARTICLES, MIN_PARTICLES, kld_count, narrow, shares
from courseware.lessons.lesson_10.trials import KIDNAPPED, PERSON, Trace, alarms, follow, traces


def test_rooms_101_and_102_look_alike_but_room_103_and_the_corridor_do_not():
    inside, end = walk(OUT_OF_101[:3], 5), walk(OUT_OF_101, 30)[-1:]
    for states, k, far in ((inside, 1, False), (inside, 2, True), (end, 1, True)):
        here, there = (record(states + np.r_[offset, 0, 0, 0], seed=10_000).depths for offset in (0 * ALIKE, k * ALIKE))
        assert (np.mean(np.abs(here - there) > 0.1) > 0.2) == far


def test_a_run_that_starts_anywhere_narrows_to_one_of_the_two_rooms_and_chance_decides_which():
    bins, counts = [one.bins for one in narrow(1)], [len(one.particles) for one in narrow(1)]
    assert counts == [MAX_PARTICLES, *(kld_count(k, MIN_PARTICLES, MAX_PARTICLES) for k in bins[:-1])]
    at_ten = np.array([shares(narrow(run))[:, 9] for run in (1, 2, 3)])
    assert at_ten.max(axis=1) == pytest.approx(1, abs=0.05) == at_ten.sum(axis=1)
    assert 0 < np.sum(at_ten[:, 0] > 0.5) < 3


def test_an_alarm_needs_both_conditions_and_a_person_who_walks_by_makes_no_pose_impossible():
    trace = Trace(np.r_[np.full(KIDNAPPED, 0.9), np.full(5, 0.3)], np.arange(KIDNAPPED + 5) == KIDNAPPED + 2)
    told = [alarms(trace, c, cannot_be_right=both)[1:] for c, both in ((0.8, False), (0.8, True), (0.2, False))]
    assert told == [(0, 0), (0, 2), (0, None)]  # false alarms, and the delay of the right one
    for scores, _ in traces().values():
        assert scores[list(PERSON)].min() < 0.7 * scores[:10].min()
    assert not any(lost[:KIDNAPPED].any() for _, lost in traces().values())


def test_in_the_room_next_door_the_filter_says_tracked():
    carried = carried_next_door()
    found = [one.estimate for one in follow(carried, seed=10_001, until=12)]
    off = np.linalg.norm([one.state[:3] - true[:3] for one, true in zip(found, carried.states, strict=False)], axis=1)
    assert off == pytest.approx([0] * 8 + [4] * 4, abs=0.1)
    assert {one.status for one in found[8:]} == {"tracked"}
