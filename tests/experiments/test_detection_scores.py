"""Which detections on a panorama are right, which are false alarms, and which are ignored."""

import numpy as np
import pytest

from course_lib.experiments.detection_scores import Boxes, match_detections

WIDTH = 1280.0
NONE = Boxes([], np.zeros((0, 4)))


def objects(*boxes, label="chair"):
    return Boxes([label] * len(boxes), np.array(boxes, float))


def found(*boxes, scores, label="chair"):
    return Boxes([label] * len(boxes), np.array(boxes, float), np.array(scores, float))


BOX = [100, 0, 175, 100]
HALF, LESS = [125, 0, 200, 100], [126, 0, 201, 100]  # IoU 50 / 100 and 49 / 101


@pytest.mark.parametrize(
    ("box", "label", "target", "ignored", "told"),
    [
        (HALF, "chair", objects(BOX), NONE, [True]),
        (LESS, "chair", objects(BOX), NONE, [False]),
        (BOX, "table", objects(BOX), NONE, [False]),
        ([1270, 300, 1320, 400], "chair", objects([1272, 300, 1322, 400]), NONE, [True]),
        ([1270, 300, 1320, 400], "chair", objects([-8, 300, 42, 400]), NONE, [True]),
        (HALF, "chair", NONE, objects(BOX), []),
        (LESS, "chair", NONE, objects(BOX), [False]),
        (BOX, "television", NONE, objects(BOX), [False]),
        ([110, 10, 140, 40], "chair", NONE, objects(BOX), [False]),
        ([1270, 300, 1320, 400], "chair", NONE, objects([-8, 300, 42, 400]), []),
        (BOX, "chair", objects(BOX), objects(BOX, label="table"), [True]),
    ],
    ids=["half", "less than half", "another class", "the seam", "the seam, from the other side", "ignored",
         "less than half of an ignored one", "another class than the ignored one", "small inside an ignored one",
         "ignored across the seam", "found where an ignored one lies"],
)  # fmt: skip
def test_a_detection_is_right_a_false_alarm_or_ignored(box, label, target, ignored, told):
    assert match_detections(found(box, scores=[0.9], label=label), target, ignored, WIDTH).correct.tolist() == told


def test_the_best_score_takes_the_free_object_that_it_overlaps_most_and_a_second_one_is_a_false_alarm():
    detections = found([100, 300, 150, 400], [105, 300, 155, 400], scores=[0.5, 0.9])
    matching = match_detections(detections, objects([100, 300, 150, 400]), NONE, WIDTH)
    assert matching.scores.tolist() == [0.9, 0.5]
    assert matching.correct.tolist() == [True, False]
    detections = found([100, 0, 200, 100], [100, 0, 200, 100], scores=[0.9, 0.8])
    matching = match_detections(detections, objects([110, 0, 210, 100], [102, 0, 202, 100]), NONE, WIDTH)
    assert matching.object_index.tolist() == [1, 0]
