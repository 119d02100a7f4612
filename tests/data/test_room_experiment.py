"""The room experiment on the shipped data: exact boxes measured anew, images as stored and, in part, measured anew."""

import csv
from pathlib import Path

import numpy as np
import pytest

from course_lib.spherical_stereo.localizer import SemanticLocalizer
from courseware.experiments.room import experiment_summary, localize_pair, range_errors, run_experiment

FOLDER = Path(__file__).resolve().parents[2] / "data" / "room"
SHIPPED_SEED = 4
EXPERIMENTS = (1, 2)


def rows_of(experiment, source):
    with (FOLDER / "results" / f"seed_{SHIPPED_SEED}.csv").open() as file:
        of_both = (f"experiment_{experiment}", source)
        rows = [row for row in csv.DictReader(file) if (row["experiment"], row["source"]) == of_both]
    return {row["place"]: row for row in rows}


def far_from(result, row):
    """Whether a pose, or what it is called, is another than the stored one; 2 mm count as the same."""
    pose = result.localization.pose
    same = result.outcome.kind == row["outcome"] and (pose is None) == (row["x"] == "")
    return not same or (pose is not None and np.hypot(pose.x - float(row["x"]), pose.y - float(row["y"])) > 0.002)


@pytest.fixture(scope="module")
def from_exact_boxes(recordings, semantic_map):
    localizers = {
        k: SemanticLocalizer(one.rig, semantic_map, reject_implausible=False) for k, one in recordings.items()
    }
    return {k: run_experiment(one, localizers[k], "exact_boxes") for k, one in recordings.items()}


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_from_exact_boxes_all_poses_come_out_as_stored_and_errors_are_as_promised(
    experiment, from_exact_boxes, recordings, semantic_map
):
    results, rows = from_exact_boxes[experiment], rows_of(experiment, "exact_boxes")
    assert [one.pair.name for one in results if far_from(one, rows[one.pair.name])] == []
    assert np.median(range_errors(results, semantic_map, recordings[experiment].rig.baseline, "box_centre")) <= 0.06
    summary = experiment_summary(results)
    worst = {"mean_dx_m": 0.08, "mean_dy_m": 0.12, "mean_dtheta_deg": 0.8}
    assert all(summary["correct"][key] <= value for key, value in worst.items())
    assert summary["correct_percent"] < 100, "look-alike sofas are confused now and then"


@pytest.mark.slow
def test_poses_from_images_come_out_as_stored(recordings, semantic_map, detector):
    recording, rows = recordings[2], rows_of(2, "images")
    localizer = SemanticLocalizer(recording.rig, semantic_map, detector, reject_implausible=False)
    chosen = recording.pairs[::4]
    far = [pair.name for pair in chosen if far_from(localize_pair(pair, localizer), rows[pair.name])]
    # Another processor may round a score across the threshold, so that one pose comes out otherwise.
    assert len(far) <= 1, far


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_the_covariances_of_observations_tell_their_errors(experiment, from_exact_boxes, semantic_map):
    """Squared error over variance, a coordinate: 1 in the mean if they told it exactly (the rig here is too good)."""
    ratios = []
    for result in from_exact_boxes[experiment]:
        x, y, heading = result.pair.pose
        turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
        for one, landmark in zip(result.localization.observations, result.true_landmarks, strict=True):
            error = turn @ (semantic_map.positions[landmark] - (x, y)) - (one.x, one.y)
            ratios.append(error @ np.linalg.solve(one.covariance, error) / 2)
    assert 0.3 < np.mean(ratios) < 1.5
