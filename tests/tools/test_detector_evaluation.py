"""A detector measured against exact boxes: precision and recall, and the choice of a threshold."""

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detected_object import Detection
from courseware.experiments.room_evaluation import Matching
from courseware.simulation.room.stereo_recording import TrueObject
from tools import detector_evaluation
from tools.detector_evaluation import (
    DetectionScoreError,
    average_precision,
    best_threshold,
    precision_recall_curve,
    scores_at,
)


class Sees:
    """A detector that reports the same two sofas in every image."""

    def detect(self, image):
        return [Detection("sofa", 0.9, (u, 300.0, u + 100.0, 380.0), 10.0, 50.0) for u in (500.0, 900.0)]


def test_hits_misses_and_false_alarms_are_counted_and_what_does_not_count_is_left_out():
    boxes = [(u, 300.0, u + 100.0, 380.0) for u in (500.0, 700.0, 900.0)]
    shares = (1.0, 1.0, 0.2)
    things = [TrueObject(k, "sofa", box, box, shares[k]) for k, box in enumerate(boxes)]
    image = np.zeros((640, 1280, 3), np.uint8)
    found = detector_evaluation.score_detector(Sees(), [(image, things), (image, things[1:])])
    assert found == (2, 3, 1, 1)
    assert (found.precision, found.recall) == (0.5, pytest.approx(1 / 3))
    with pytest.raises(DetectionScoreError, match="no object"):
        detector_evaluation.score_detector(Sees(), [(image, [])])


def matching(scores, correct, n_objects):
    return Matching(np.array(scores, float), np.array(correct, bool), n_objects)


def test_the_curve_counts_all_panoramas_together_and_equal_scores_enter_it_together():
    curve = precision_recall_curve([matching([0.9, 0.6], [True, False], 2), matching([0.8], [True], 2)])
    assert curve.threshold.tolist() == [0.9, 0.8, 0.6]
    assert curve.precision == pytest.approx([1.0, 1.0, 2 / 3])
    assert curve.recall == pytest.approx([0.25, 0.5, 0.5])
    assert [scores_at(curve, limit) for limit in (0.9, 0.81)] == [(1.0, 0.25)] * 2
    np.testing.assert_array_equal(scores_at(curve, 0.95), (np.nan, 0.0))
    curve = precision_recall_curve([matching([0.7, 0.7], [True, False], 1)])
    assert (curve.threshold.tolist(), curve.precision.tolist()) == ([0.7], [0.5])


def test_the_best_threshold_has_the_largest_f1_and_the_average_precision_is_the_area():
    # F1: 0.9 -> 0.5, 0.8 -> 0.8, 0.5 -> 6/7, 0.4 -> 6/8.
    curve = precision_recall_curve([matching([0.9, 0.8, 0.5, 0.4], [True, True, True, False], 3)])
    assert best_threshold(curve) == 0.5
    for found, area in ((([0.9, 0.8], [True, True], 2), 1), (([0.9], [True], 2), 0.5), (([], [], 2), 0)):
        assert average_precision(precision_recall_curve([matching(*found)])) == pytest.approx(area)
    with pytest.raises(DetectionScoreError, match="no object"):
        precision_recall_curve([matching([0.5], [False], 0)])
    with pytest.raises(DetectionScoreError, match="no detection is right"):
        best_threshold(precision_recall_curve([matching([0.5], [False], 1)]))
