"""Which detections on a panorama are right, which are false alarms, and which are ignored."""

import numpy as np
import pytest

from course_lib.experiments.detection_scores import Boxes, DetectionScoreError, match_detections

WIDTH = 1280.0
NONE = Boxes([], np.zeros((0, 4)))


def objects(*boxes, label="chair"):
    return Boxes([label] * len(boxes), np.array(boxes, float))


def found(*boxes, scores, label="chair"):
    return Boxes([label] * len(boxes), np.array(boxes, float), np.array(scores, float))


def test_a_detection_that_overlaps_enough_is_right():
    matching = match_detections(found([100, 300, 150, 400], scores=[0.9]), objects([105, 300, 155, 400]), NONE, WIDTH)
    assert matching.correct.tolist() == [True]
    assert matching.object_index.tolist() == [0]


def test_an_overlap_of_exactly_the_threshold_is_enough_and_a_little_less_is_not():
    # IoU = 50 / 100 for the first, 49 / 101 for the second.
    target = objects([100, 0, 175, 100])
    assert match_detections(found([125, 0, 200, 100], scores=[1]), target, NONE, WIDTH).correct.tolist() == [True]
    assert match_detections(found([126, 0, 201, 100], scores=[1]), target, NONE, WIDTH).correct.tolist() == [False]


def test_another_class_is_a_false_alarm():
    detections = found([100, 300, 150, 400], scores=[0.9], label="table")
    assert match_detections(detections, objects([100, 300, 150, 400]), NONE, WIDTH).correct.tolist() == [False]


def test_the_second_detection_of_one_object_is_a_false_alarm_even_if_it_fits_better():
    detections = found([100, 300, 150, 400], [105, 300, 155, 400], scores=[0.5, 0.9])
    matching = match_detections(detections, objects([100, 300, 150, 400]), NONE, WIDTH)
    assert matching.scores.tolist() == [0.9, 0.5]
    assert matching.correct.tolist() == [True, False]


def test_a_detection_takes_the_free_object_that_it_overlaps_most():
    detections = found([100, 0, 200, 100], [100, 0, 200, 100], scores=[0.9, 0.8])
    matching = match_detections(detections, objects([110, 0, 210, 100], [102, 0, 202, 100]), NONE, WIDTH)
    assert matching.object_index.tolist() == [1, 0]


def test_boxes_meet_across_the_seam():
    detections = found([1270, 300, 1320, 400], scores=[0.9])
    # The same place, one turn to the left, as a detector without wrapping would give it.
    for box in ([1272, 300, 1322, 400], [-8, 300, 42, 400]):
        assert match_detections(detections, objects(box), NONE, WIDTH).correct.tolist() == [True]


def test_finding_an_ignored_object_neither_gains_nor_loses():
    detections = found([100, 300, 150, 400], [600, 300, 650, 400], scores=[0.9, 0.8])
    matching = match_detections(detections, NONE, objects([100, 300, 150, 400]), WIDTH)
    assert matching.detection_index.tolist() == [1]
    assert matching.n_objects == 0


def test_a_small_box_inside_a_large_ignored_object_is_a_false_alarm():
    detections = found([110, 310, 140, 340], scores=[0.9])
    assert match_detections(detections, NONE, objects([100, 300, 300, 400]), WIDTH).correct.tolist() == [False]


def test_a_detection_of_another_class_than_the_ignored_object_is_a_false_alarm():
    detections = found([100, 300, 150, 400], scores=[0.9], label="television")
    assert match_detections(detections, NONE, objects([100, 300, 150, 400]), WIDTH).correct.tolist() == [False]


def test_an_ignored_object_is_found_at_the_same_overlap_as_any_other():
    # IoU = 50 / 100 for the first, 49 / 101 for the second.
    ignored = objects([100, 0, 175, 100])
    assert len(match_detections(found([125, 0, 200, 100], scores=[1]), NONE, ignored, WIDTH).scores) == 0
    assert len(match_detections(found([126, 0, 201, 100], scores=[1]), NONE, ignored, WIDTH).scores) == 1


def test_an_ignored_object_is_found_across_the_seam():
    detections = found([1270, 300, 1320, 400], scores=[0.9])
    assert len(match_detections(detections, NONE, objects([-8, 300, 42, 400]), WIDTH).scores) == 0


def test_an_object_is_found_even_where_an_ignored_one_lies():
    box = [100, 300, 150, 400]
    matching = match_detections(found(box, scores=[0.9]), objects(box), objects(box, label="table"), WIDTH)
    assert matching.correct.tolist() == [True]


def test_matching_does_not_depend_on_the_order_of_detections():
    rng = np.random.default_rng(3)
    low = rng.uniform([0, 0], [WIDTH, 500], (12, 2))
    boxes = np.concatenate([low, low + rng.uniform(20, 120, (12, 2))], axis=1)
    targets = objects(*(boxes[:6] + rng.uniform(-8, 8, (6, 4))))
    scores = rng.permutation(12) / 12
    first = match_detections(found(*boxes, scores=scores), targets, NONE, WIDTH)
    order = rng.permutation(12)
    second = match_detections(found(*boxes[order], scores=scores[order]), targets, NONE, WIDTH)
    assert first.scores.tolist() == second.scores.tolist()
    assert first.correct.tolist() == second.correct.tolist()
    assert first.correct.sum() >= 4


def test_bad_input_is_named():
    target = objects([0, 0, 10, 10])
    with pytest.raises(DetectionScoreError, match="one score each"):
        match_detections(objects([0, 0, 10, 10]), target, NONE, WIDTH)
    with pytest.raises(DetectionScoreError, match="NaN"):
        match_detections(found([0, 0, 10, 10], scores=[np.nan]), target, NONE, WIDTH)
    with pytest.raises(DetectionScoreError, match="2 labels and 1 boxes"):
        match_detections(Boxes(["a", "b"], np.zeros((1, 4)), np.ones(2)), target, NONE, WIDTH)
