"""The room experiment on the shipped data: exact boxes measured anew, images as stored and, in part, measured anew."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from course_lib.experiments.room import experiment_summary, localize_pair, range_errors, run_experiment
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.recording import read_stereo_recording
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

FOLDER = Path(__file__).resolve().parents[2] / "data" / "room"
SHIPPED_SEED, SEEDS = 4, (1, 2, 3, 4, 5)
EXPERIMENTS = ("experiment_1", "experiment_2")


@pytest.fixture(scope="module")
def semantic_map():
    return SemanticMap.load(FOLDER / "semantic_map.json")


def stored(seed):
    return json.loads((FOLDER / "results" / f"seed_{seed}.json").read_text())


def over_seeds(experiment, method, *keys):
    values = []
    for seed in SEEDS:
        value = stored(seed)[experiment][method]
        for key in keys:
            value = value[key]
        values.append(value)
    return values


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_from_exact_boxes_distances_and_correct_poses_are_as_good_as_promised(experiment, semantic_map):
    recording = read_stereo_recording(FOLDER / experiment)
    results = run_experiment(
        recording, SemanticLocalizer(recording.rig, semantic_map, reject_implausible=False), "exact_boxes"
    )
    assert np.median(range_errors(results, semantic_map, recording.rig.baseline, "box_centre")) <= 0.08
    summary = experiment_summary(results)
    assert summary["correct"]["mean_dx_m"] <= 0.19
    assert summary["correct"]["mean_dy_m"] <= 0.20
    assert summary["correct"]["mean_dtheta_deg"] <= 2.8
    assert 60 <= summary["correct_percent"] < 100, "look-alike sofas are confused now and then"
    again = stored(SHIPPED_SEED)[experiment]["greedy_exact_boxes"]
    assert summary["correct_percent"] == pytest.approx(again["correct_percent"], abs=5.1)
    assert summary["correct"]["mean_dx_m"] == pytest.approx(again["correct"]["mean_dx_m"], abs=0.02)


def test_poses_from_images_come_out_as_stored(semantic_map):
    recording = read_stereo_recording(FOLDER / "experiment_2")
    localizer = SemanticLocalizer(
        recording.rig, semantic_map, YoloDetector.load(FOLDER.parent / "detector"), reject_implausible=False
    )
    with (FOLDER / "results" / f"seed_{SHIPPED_SEED}.csv").open() as file:
        rows = {
            row["place"]: row
            for row in csv.DictReader(file)
            if (row["experiment"], row["source"]) == ("experiment_2", "images")
        }
    same = 0
    for pair in recording.pairs[::5]:
        result, row = localize_pair(pair, localizer), rows[pair.name]
        same += result.outcome.kind == row["outcome"]
        if result.localization.pose is not None and row["x"]:
            assert result.localization.pose.x == pytest.approx(float(row["x"]), abs=0.5)
    # Another processor may round a score across the threshold, so that one pose comes out otherwise.
    assert same >= 3


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_the_stored_rates_from_images_show_the_papers_failure(experiment):
    rates = over_seeds(experiment, "greedy", "correct_percent")
    exact = over_seeds(experiment, "greedy_exact_boxes", "correct_percent")
    assert np.median(rates) < np.median(exact) - 10, "missed objects move the centroid"
    assert min(rates) > 0
    assert max(over_seeds(experiment, "greedy", "unable_percent")) <= 10


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_the_stored_rates_from_images_are_about_the_papers(experiment):
    assert 45 <= np.median(over_seeds(experiment, "greedy", "correct_percent")) <= 80


@pytest.mark.parametrize(("key", "limit"), [("mean_dx_m", 0.25), ("mean_dy_m", 0.25), ("mean_dtheta_deg", 3.5)])
def test_the_stored_errors_of_correct_poses_from_images_are_small(key, limit):
    for experiment in EXPERIMENTS:
        assert np.median(over_seeds(experiment, "greedy", "correct", key)) <= limit


def test_the_stored_stereo_matching_and_distances_meet_the_aims():
    for seed in SEEDS:
        matching, errors = stored(seed)["stereo_matching"], stored(seed)["median_relative_range_error_percent"]
        assert matching["right_percent"] >= 99
        assert matching["unmatched_percent"] <= 4
        assert errors["exact_boxes"] <= 8
        assert errors["detected_box_centres"] <= 15
        assert errors["akaze_disparities"] <= 9


def test_weighted_by_covariance_rolled_images_never_move_the_stored_poses_by_more_than_a_decimetre():
    turns = stored(SHIPPED_SEED)["rolled_images"]["by_covariance"]
    assert turns["associations_agree"] > 80
    assert turns["within_0.10_m"] == turns["associations_agree"]
    assert turns["greatest_turned_deg"] < 2.0


@pytest.mark.xfail(
    strict=True, reason="aim not met: counted alike, far objects move the pose with a pixel of their boxes"
)
def test_counted_alike_rolled_images_never_move_the_stored_poses_by_more_than_a_decimetre():
    turns = stored(SHIPPED_SEED)["rolled_images"]["alike"]
    assert turns["within_0.10_m"] == turns["associations_agree"]
