"""What lesson 10 says of its hotel, its filters and its exercises holds."""

import numpy as np
import pytest

from course_lib.beyond.lost_and_found.adaptive_count import kld_count
from course_lib.beyond.lost_and_found.global_search import PoseCandidate, PoseCandidates
from course_lib.lessons.kit.exercises import find_exercise
from course_lib.lessons.lesson_10.hotel import (
    ALIKE,
    CAMERA,
    behind_a_person,
    boxes_on_the_plan,
    hotel_map,
    record,
    walk,
)
from course_lib.lessons.lesson_10.narrowing import (
    MAX_PARTICLES,
    MIN_PARTICLES,
    OUT_OF_101,
    distance_to_either,
    free_space,
    inside_furniture,
    leaving_101,
    narrow,
    share_near,
    shares,
)
from course_lib.lessons.lesson_10.stored_trials import stored_table
from course_lib.lessons.lesson_10.trials import (
    GOALS,
    Trace,
    alarms,
    carried_next_door,
    evidence_near,
    follow,
    running_mean,
    traces,
)
from course_lib.rendering.renderer import DepthRenderer


def test_rooms_101_and_102_look_alike_and_103_does_not():
    inside = walk(OUT_OF_101[:3], 5)
    here, next_door = (record(inside + np.r_[offset, 0, 0, 0], seed=10_000).depths for offset in (0 * ALIKE, ALIKE))
    other = record(inside + np.r_[2 * ALIKE, 0, 0, 0], seed=10_000).depths
    assert np.nanmedian(np.abs(here - next_door)) < 1e-3
    assert np.mean(np.abs(here - other) > 0.1) > 0.2


def test_in_the_corridor_the_two_places_differ():
    end = walk(OUT_OF_101, 30)[-1:]
    here, next_door = (record(end + np.r_[offset, 0, 0, 0], seed=10_000).depths for offset in (0 * ALIKE, ALIKE))
    assert np.mean(np.abs(here - next_door) > 0.1) > 0.2


def test_the_world_holds_what_the_map_lacks():
    state = walk([(5.0, 0.9, -10)], 1)
    seen = record(state, seed=10_000).depths[0]
    with DepthRenderer(hotel_map(), CAMERA) as renderer:
        drawn = renderer.render(state)[0]
    assert (seen < drawn - 0.3).sum() > 10


def test_a_door_that_is_shut_stands_on_the_map():
    assert len(hotel_map(1).faces) == len(hotel_map().faces) + 12


def test_the_plan_leaves_out_floor_and_ceiling():
    walls, furniture = boxes_on_the_plan()
    assert all(high[2] - low[2] > 1 for low, high in walls)
    assert len(walls) == 6 + 2 * 3
    assert not any(low[1] == 1.6 for low, _ in furniture)


def test_a_person_covers_sixteen_columns_and_stays_on_the_image():
    depth = np.full(CAMERA.shape, 3.0)
    assert (behind_a_person(depth, 10) == 0.8).sum() == 16 * 30
    assert (behind_a_person(depth, -10) == 0.8).sum() == 6 * 30
    assert (depth == 3.0).all()


def test_free_places_are_inside_the_hotel_and_some_inside_a_bed():
    tried = np.random.default_rng(10_000).uniform(*hotel_map().bounds, (4_000, 3))
    free = free_space().contains(tried)
    assert ((tried[free] > [0, 0, 0]) & (tried[free] < [12, 5.7, 2.5])).all()
    assert 0.01 < inside_furniture(tried[free]).mean() < 0.15
    assert inside_furniture(np.array([[1.0, 4.0, 0.3], [1.0, 4.0, 1.0]])).tolist() == [True, False]


def test_a_run_that_starts_anywhere_narrows_to_one_of_the_two_rooms():
    rounds = narrow(1)[:10]
    counts = [len(one.particles) for one in rounds]
    assert counts[0] == MAX_PARTICLES
    assert counts[9] < 2 * MIN_PARTICLES
    assert all(
        n == kld_count(one.bins, MIN_PARTICLES, MAX_PARTICLES) for one, n in zip(rounds[:-1], counts[1:], strict=True)
    )
    here, next_door = (share[9] for share in shares(narrow(1)))
    assert max(here, next_door) > 0.95
    assert min(here, next_door) < 0.05


def test_chance_decides_between_the_rooms():
    right = [shares(narrow(run))[0][9] > 0.5 for run in (1, 2, 3)]
    assert 0 < sum(right) < len(right)


def test_shares_and_distances_are_measured_on_the_floor():
    one, state = narrow(1)[9], leaving_101().states[9]
    assert share_near(one, state, 1e3) == pytest.approx(1)
    assert share_near(one, state + 100) == 0
    assert distance_to_either(state[None] + np.r_[ALIKE, 0, 0, 0], state)[:, 0] == pytest.approx([4, 0])


def test_the_running_mean_is_a_weighted_sum_of_all_scores():
    scores = np.array([0.8, 0.2, 0.5])
    assert running_mean(scores, 0.25) == pytest.approx([0.8, 0.65, 0.6125])
    assert running_mean(scores, 1.0) == pytest.approx(scores)


def test_an_alarm_needs_both_where_both_are_asked():
    scores = np.r_[np.full(20, 0.9), np.full(5, 0.3)]
    trace = Trace(scores, np.arange(25) == 22, range(0), 20)
    assert np.flatnonzero(alarms(trace, 0.8, 0.4, 0.03, cannot_be_right=False)).tolist() == [20, 21, 22, 23, 24]
    assert np.flatnonzero(alarms(trace, 0.8, 0.4, 0.03, cannot_be_right=True)).tolist() == [22]
    assert not alarms(trace, 0.2, 0.4, 0.03, cannot_be_right=False).any()


def test_a_person_lowers_the_score_but_no_pose_becomes_impossible():
    assert len(traces()) == len(GOALS)
    for trace in traces():
        assert trace.scores[list(trace.person)].min() < 0.7 * trace.scores[:10].min()
        assert not trace.lost[: trace.kidnapped].any()
    assert traces()[0].lost[traces()[0].kidnapped]


def test_in_the_room_next_door_it_says_tracked():
    recording = carried_next_door()
    found = list(follow(recording, seed=10_001, until=14))
    errors = [np.linalg.norm(one.estimate.state[:3] - t[:3]) for one, t in zip(found, recording.states, strict=False)]
    assert max(errors[:8]) < 0.1
    assert errors[8:] == pytest.approx([4.0] * 6, abs=0.1)
    assert {one.estimate.status for one in found[8:]} == {"tracked"}


def test_covered_frames_give_no_measurement():
    found = list(follow(carried_next_door(), seed=10_001, covered=range(2, 4), until=4))
    assert [one.estimate.status for one in found] == ["tracked", "tracked", "no measurement", "no measurement"]


def test_evidence_is_that_of_a_place_within_half_a_metre():
    state = leaving_101().states[0]
    places = [PoseCandidate(state + 0.1, 0.7, 3), PoseCandidate(state + np.r_[ALIKE, 0, 0, 0], 0.6, 3)]
    run = [PoseCandidates("several", places, 0, 0), PoseCandidates("searching", [], 0, 0)]
    assert evidence_near(run, 0 * ALIKE)[0] == 0.7
    assert evidence_near(run, ALIKE)[0] == 0.6
    assert np.isnan(evidence_near(run, ALIKE)[1])


@pytest.mark.parametrize("place", ["kitchen", "corridor"])
def test_stored_trials_come_with_their_intervals(place):
    text = stored_table(place)
    assert text.startswith(f"{place}, ")
    assert text.count("interval") == 2


GRID, U = np.array([[False, True], [True, True]]), np.array([[0.1, 0.5, 0.0], [0.9, 0.5, 0.5]])
STATES = np.array([[0, 0, 3.1], [0.1, 0, -3.1], [0, 0, 0], [5, 0, 3.1]])


@pytest.mark.parametrize(
    ("number", "given", "wanted"),
    [
        ("10.1", (GRID, 0.5, U), [[0.75, 0], [0.75, 0.75]]),
        ("10.2", (np.array([0.8, 0.8, np.nan, 0.4]), 0.5, 0.1), [0, 0, 0, 0.2105]),
        ("10.3", (np.array([7, 7, 7, 2, 7, 2] * 20), 20), 66),
        ("10.3", (np.full(100, 7), 20), 20),
        ("10.4", (STATES, np.array([0.7, 0.9, 0.5, 0.6]), 0.5, 0.3), [1, 3, 2]),
    ],
)
def test_the_examples_of_the_tasks_are_right(number, given, wanted):
    assert find_exercise(number).solution(*given) == pytest.approx(np.array(wanted), abs=1e-4)
