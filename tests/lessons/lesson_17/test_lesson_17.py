"""Lesson 17: stored results of any number of seeds, what fails and what would have saved it, hidden objects."""

import json
import math

import numpy as np
import pytest

from course_lib.experiments.room_evaluation import CORRECT, INCORRECT, UNABLE, wrong_pairs
from course_lib.lessons.kit.room_observations import in_body_frame
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_17.experiments import exact_results, failing_places, live_places, table_1
from course_lib.lessons.lesson_17.figures import outcomes_figure
from course_lib.lessons.lesson_17.room_causes import (
    CURES,
    cured_by,
    greedy_pairs,
    is_matched_rightly,
    position_errors,
    randomly_thinned,
    rate_of,
    thinned,
)
from course_lib.lessons.lesson_17.room_runs import (
    StoredRoom,
    errors,
    rates,
    stored_rooms,
    table_3_or_4,
    table_5,
    two_heights,
    used_pairs,
)
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.association import Observation, associate_greedy


@pytest.fixture(scope="module")
def room():
    return room_map()


@pytest.fixture(scope="module")
def localizer(room):
    return SemanticLocalizer(room_recording(1).rig, room, reject_implausible=False)


@pytest.fixture(scope="module")
def results():
    return exact_results(1)


def made_up_run(seed: int, correct: float, wrong_places=("06_a",)) -> StoredRoom:
    """A seed whose poses are all correct but some; its errors grow with the seed."""
    group = {"n": 20} | dict.fromkeys(("mean_dx_m", "mean_dy_m", "mean_dtheta_deg"), 0.1 * seed)
    group |= dict.fromkeys(("std_dx_m", "std_dy_m", "std_dtheta_deg"), 0.2 * seed)
    none = {"n": 0} | dict.fromkeys(list(group)[1:])
    table = {"correct_percent": correct, "incorrect_percent": 100 - correct, "unable_percent": 0.0}
    table |= {"all": group, "correct": group, "incorrect": none}
    summary = {f"experiment_{e}": {"greedy": table, "greedy_exact_boxes": table} for e in (1, 2)}
    rows = [
        {
            "experiment": f"experiment_{e}",
            "source": source,
            "place": pair.name,
            "outcome": INCORRECT if pair.name in wrong_places else CORRECT,
        }
        for e in (1, 2)
        for source in ("images", "exact_boxes")
        for pair in room_recording(1).pairs
    ]
    return StoredRoom(seed, summary, rows)


def test_all_stored_seeds_are_read_with_every_pose_of_both_experiments():
    runs = stored_rooms()
    assert [run.seed for run in runs] == sorted(run.seed for run in runs)
    for run in runs:
        for experiment in (1, 2):
            assert set(run.outcomes(experiment, "images")) == {pair.name for pair in room_recording(1).pairs}


def test_the_stored_rates_are_those_of_the_stored_poses():
    for run in stored_rooms():
        kinds = list(run.outcomes(2, "images").values())
        shares = [100 * kinds.count(kind) / len(kinds) for kind in (CORRECT, INCORRECT, UNABLE)]
        assert rates([run], 2, "images")[0] == pytest.approx(shares)


def test_used_pairs_are_counted_over_all_stored_poses():
    runs = stored_rooms()
    assert used_pairs(runs, "exact_boxes").shape == (40 * len(runs),)
    assert used_pairs(runs, "exact_boxes").min() > 5


def test_a_folder_without_results_is_named(tmp_path):
    (tmp_path / "seed_1_old.json").write_text(json.dumps({}))
    with pytest.raises(FileNotFoundError, match="demo room"):
        stored_rooms(tmp_path)


@pytest.mark.parametrize("n_seeds", [1, 3, 5])
def test_tables_hold_for_any_number_of_seeds(n_seeds):
    runs = [made_up_run(seed, 50 + 10 * seed) for seed in range(1, n_seeds + 1)]
    middle = 50 + 10 * (n_seeds + 1) / 2
    assert f"{middle:.0f} (60-{50 + 10 * n_seeds:.0f})" in table_5(runs)
    assert errors(runs, 1, "images", "correct")[0] == pytest.approx(0.1 * (n_seeds + 1) / 2)
    assert np.isnan(errors(runs, 1, "images", "incorrect")).all()
    assert "no such pose" in table_3_or_4(runs, 1)
    assert len(outcomes_figure(runs, "images").axes) == 1


def test_the_papers_rows_stand_in_the_tables():
    runs = [made_up_run(1, 60)]
    assert "experiment 1, paper" in table_5(runs)
    assert "1.31" in table_3_or_4(runs, 1)
    assert "1.65" in table_3_or_4(runs, 2)
    assert table_1().count("deg") == 10


def test_failing_poses_are_counted_over_the_seeds_the_most_frequent_first():
    runs = [made_up_run(1, 90, ("06_a", "01_b")), made_up_run(2, 90, ("06_a",)), made_up_run(3, 100, ())]
    assert failing_places(runs, 1, "images") == {"06_a": 2, "01_b": 1}
    assert failing_places(runs[2:], 1, "images") == {}


def test_live_poses_are_those_that_failed_on_the_shipped_photographs_and_never_too_few():
    shipped = room_recording(1).seed
    runs = [made_up_run(shipped, 95, ("09_b",)), made_up_run(shipped + 1, 95, ("02_a",))]
    assert live_places(runs, 1) == ["09_b", "01_a"]
    assert live_places([made_up_run(shipped, 100, ())], 1) == ["01_a", "01_b"]


def test_nothing_hidden_gives_the_pose_back_and_one_object_left_is_unable(results, localizer):
    whole = thinned(results[2], range(len(results[2].localization.observations)), localizer)
    assert whole.found.pose == results[2].localization.pose
    assert whole.outcome == results[2].outcome
    assert thinned(results[2], [0], localizer).outcome.kind == UNABLE
    assert thinned(results[2], [], localizer).outcome.kind == UNABLE


def test_unable_is_as_frequent_as_the_binomial_says(results, localizer):
    q, repeats = 0.2, 12
    found = randomly_thinned(results, localizer, q, repeats, np.random.default_rng(3))
    expected = []
    for result in results:
        n = len(result.localization.observations)
        expected.append((1 - q) ** n + n * q * (1 - q) ** (n - 1))
    sigma = 100 * math.sqrt(np.mean(expected) / (repeats * len(results)))
    assert rate_of(found, UNABLE) == pytest.approx(100 * np.mean(expected), abs=4 * sigma)
    assert len(position_errors(found, UNABLE)) == 0
    assert len(position_errors(found, INCORRECT)) == sum(one.outcome.kind == INCORRECT for one in found)


def test_the_body_frame_is_the_poses_own(rng):
    points, pose = rng.normal(size=(5, 2)), Pose2D(1.0, -2.0, 0.7)
    assert pose.apply(in_body_frame(points, pose)) == pytest.approx(points)


def test_the_search_is_the_librarys(results, room):
    for result in results[:5]:
        association = associate_greedy(result.localization.observations, room)
        assert greedy_pairs(association.table.total) == list(association.pairs)


def test_uncured_it_says_what_the_evaluation_says(results, room):
    for result in (*results, *exact_results(2)):
        right = is_matched_rightly(result.localization.observations, result.true_landmarks, result.pair.pose, room)
        assert right == (not wrong_pairs(result.localization, result.true_landmarks))


def perfect_observations(room, pose):
    places = in_body_frame(room.positions, pose)
    return [
        Observation(m.label, *map(float, p), m.hue, m.saturation) for m, p in zip(room.landmarks, places, strict=True)
    ]


def test_each_cure_mends_what_it_should(room):
    pose = np.array([2.0, 3.0, 0.5])
    perfect = perfect_observations(room, pose)
    truth = list(range(len(room)))
    # Sofas 0 and 1 exchange their places: nothing but the true places mends that.
    swapped = [one._replace(x=perfect[k].x, y=perfect[k].y) for one, k in zip(perfect, [1, 0, *truth[2:]], strict=True)]
    assert is_matched_rightly(perfect, truth, pose, room)
    assert not is_matched_rightly(swapped, truth, pose, room)
    assert is_matched_rightly(swapped, truth, pose, room, "true places")
    assert not is_matched_rightly(swapped, truth, pose, room, "true centroid")
    # Half of the room unseen, all on one side: the places are right, the centroid is not.
    east = [k for k in truth if room.positions[k, 0] > 2.0]
    seen = [perfect[k] for k in east]
    assert not is_matched_rightly(seen, east, pose, room)
    assert is_matched_rightly(seen, east, pose, room, "true centroid")
    with pytest.raises(ValueError, match="cure"):
        is_matched_rightly(perfect, truth, pose, room, "true love")


def test_cures_are_counted_over_failing_poses(results, localizer, room):
    found = randomly_thinned(results, localizer, 0.6, 2, np.random.default_rng(5))
    failing = [one for one in found if one.outcome.kind == INCORRECT]
    counts = cured_by(failing, room)
    assert tuple(counts) == CURES
    assert 0 < counts["true centroid"] <= len(failing)
    assert cured_by([], room) == dict.fromkeys(CURES, 0)


def test_the_higher_rig_loses_poses_from_exact_boxes_in_every_seed():
    runs = stored_rooms()
    counted = two_heights(runs, "exact_boxes")
    assert (counted.poses, counted.lower, counted.higher) == (100, 95, 83)
    assert (counted.lost, counted.gained) == (15, 3)
    for run in runs:
        alone = two_heights([run], "exact_boxes")
        assert alone.higher < alone.lower
        assert alone.lower - alone.lost + alone.gained == alone.higher
