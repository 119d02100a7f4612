"""The shipped detector: small, whole, as good as its scores say, blind to the seam; and the method on top of it."""

import json
from pathlib import Path

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detected_object import box_iou
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from courseware.experiments.room import localize_pair, turn_summary, turn_the_rig, weigh_by_covariance
from tools.score_detector import labelled_panoramas, score_detector

FOLDER = Path(__file__).resolve().parents[2] / "data" / "detector"


@pytest.fixture(scope="module")
def recording(recordings):
    return recordings[1]


@pytest.mark.slow
def test_the_experiments_room_scores_as_stored(detector, recording):
    stored = json.loads((FOLDER / "scores.json").read_text())["experiment_room"]
    score = score_detector(detector, list(labelled_panoramas(recording))[::2])
    assert score.precision == pytest.approx(stored["precision"], abs=0.04)
    assert score.recall == pytest.approx(stored["recall"], abs=0.04)


@pytest.mark.parametrize("shift", range(0, 1280, 256))
def test_a_sofa_is_found_exactly_once_wherever_the_seam_is(detector, recording, shift):
    pair = recording.pairs[0]
    boxes = [thing.visible_box for thing in pair.upper_objects if thing.label == "sofa"]
    u_min, v_min, u_max, v_max = max(boxes, key=lambda box: box[2] - box[0])
    found = detector.detect(np.roll(pair.images()[0], shift, axis=1))
    boxes = [one.box for one in found if one.label == "sofa"]
    overlap = box_iou(boxes, [[u_min + shift, v_min, u_max + shift, v_max]], 1280)
    assert (overlap > 0.5).sum() == 1


@pytest.mark.slow
def test_weighted_by_covariance_a_turn_never_moves_the_pose_by_more_than_a_decimetre(recording, semantic_map, detector):
    """Of two pairs with their images rolled by two numbers of columns, 640 of them half a turn."""
    localizer = SemanticLocalizer(recording.rig, semantic_map, detector, reject_implausible=False)
    results = [localize_pair(pair, localizer) for pair in recording.pairs[4:12:4]]
    rolled = turn_the_rig(results, localizer, (97, 640))
    found = turn_summary(weigh_by_covariance(rolled, localizer))
    assert found["within_0.10_m"] == found["associations_agree"]
    assert found["greatest_turned_deg"] < 2.0
