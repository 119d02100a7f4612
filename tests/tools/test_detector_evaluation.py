"""A detector measured against exact boxes: centres, votes, precision and recall, and the choice of a threshold."""

import numpy as np
import pytest

from course_lib.experiments.detection_scores import Matching, match_image
from course_lib.spherical_stereo.detection import suppression
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.recording import TrueObject
from tools import detector_evaluation
from tools.detector_evaluation import (
    average_precision,
    best_threshold,
    centre_errors,
    compare_voting,
    precision_recall_curve,
    scores_at,
)

IMAGE = np.zeros((640, 1280, 3), np.uint8)


def thing(number, u, label="sofa", visible=1.0):
    box = (float(u), 300.0, u + 100.0, 380.0)
    return TrueObject(number, label, box, box, visible)


def detection(u, v=300.0, label="sofa", score=0.9):
    return Detection(label, score, (float(u), v, u + 100.0, v + 80.0), 10.0, 50.0)


def test_centres_miss_by_columns_and_rows_across_the_seam_too():
    objects = [thing(0, 500), thing(1, 2), thing(2, 700)]
    detections = [detection(503, 298.0), detection(1276, 305.0), detection(900)]
    matching = match_image(detections, objects, 1280)
    errors = centre_errors(matching, detections, objects, 1280)
    np.testing.assert_allclose(sorted(errors.tolist()), [[-6.0, 5.0], [3.0, -2.0]])


class Voter:
    """A detector whose boxes are the nearer to the truth, the lower the voters' bars; it finds less without votes."""

    def detect(self, image):
        miss = 10.0 * suppression.VOTE_IOU + detector_evaluation.detector_module.VOTE_SCORE
        return [detection(500, 300.0 + miss)] + ([detection(700)] if suppression.VOTE_SCORE < 1 else [])


def test_every_choice_of_the_constants_is_tried_and_undone():
    before = suppression.VOTE_IOU, suppression.VOTE_SCORE, detector_evaluation.detector_module.VOTE_SCORE
    found = compare_voting(Voter(), [(IMAGE, [thing(0, 500), thing(1, 700)])])
    assert (suppression.VOTE_IOU, suppression.VOTE_SCORE, detector_evaluation.detector_module.VOTE_SCORE) == before
    none, *others = found
    assert (none.vote_iou, none.vote_score, none.score.recall) == (*detector_evaluation.NO_VOTES, 0.5)
    assert none.jitter_v == pytest.approx(11.0)
    assert len({(one.vote_iou, one.vote_score) for one in others}) == 12
    assert (0.6, 0.1) in {(one.vote_iou, one.vote_score) for one in others}
    for one in others:
        assert (one.score.precision, one.score.recall) == (1.0, 1.0)
        assert one.jitter_v == pytest.approx((10 * one.vote_iou + one.vote_score) / np.sqrt(2))
        assert one.jitter_u == 0.0


def matching(scores, correct, n_objects):
    nothing = np.zeros(len(scores), int)
    return Matching(np.array(scores, float), np.array(correct, bool), nothing, nothing, n_objects)


def test_the_curve_counts_all_panoramas_together():
    curve = precision_recall_curve([matching([0.9, 0.6], [True, False], 2), matching([0.8], [True], 2)])
    assert curve.threshold.tolist() == [0.9, 0.8, 0.6]
    assert curve.precision == pytest.approx([1.0, 1.0, 2 / 3])
    assert curve.recall == pytest.approx([0.25, 0.5, 0.5])


def test_scores_at_a_threshold_keep_detections_of_that_score():
    curve = precision_recall_curve([matching([0.9, 0.6], [True, False], 2)])
    assert scores_at(curve, 0.9) == (1.0, 0.5)
    assert scores_at(curve, 0.61) == (1.0, 0.5)
    assert scores_at(curve, 0.6) == (0.5, 0.5)


def test_the_best_threshold_has_the_largest_f1():
    # F1: 0.9 -> 0.5, 0.8 -> 0.8, 0.5 -> 6/7, 0.4 -> 6/8.
    curve = precision_recall_curve([matching([0.9, 0.8, 0.5, 0.4], [True, True, True, False], 3)])
    assert best_threshold(curve) == 0.5


def test_a_perfect_detector_has_average_precision_one_and_a_half_blind_one_a_half():
    assert average_precision(precision_recall_curve([matching([0.9, 0.8], [True, True], 2)])) == pytest.approx(1.0)
    assert average_precision(precision_recall_curve([matching([0.9], [True], 2)])) == pytest.approx(0.5)
    assert average_precision(precision_recall_curve([matching([], [], 2)])) == 0.0
