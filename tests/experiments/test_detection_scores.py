"""Which detections on a panorama are right, which are false alarms, and which are ignored."""

import numpy as np
import pytest

from course_lib.experiments.room_evaluation import match_detections
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.recording import TrueObject

WIDTH = 1280


def matched(boxes, scores, wanted=(), ignored=(), label="chair", ignored_label="chair"):
    """What becomes of detections; objects are chairs, and the ignored ones of a class of their own."""
    detections = [Detection(label, score, tuple(box), 0.0, 0.0) for box, score in zip(boxes, scores, strict=True)]
    things = [("chair", box) for box in wanted] + [(ignored_label, box) for box in ignored]
    objects = [TrueObject(k, name, tuple(box), tuple(box), 1.0) for k, (name, box) in enumerate(things)]
    return match_detections(detections, objects, WIDTH, [k < len(wanted) for k in range(len(objects))])


BOX = [100, 0, 175, 100]
HALF, LESS = [125, 0, 200, 100], [126, 0, 201, 100]  # IoU 50 / 100 and 49 / 101


ACROSS, FROM_THE_OTHER_SIDE = [1270, 300, 1320, 400], [-8, 300, 42, 400]


@pytest.mark.parametrize(
    ("box", "label", "wanted", "ignored", "told"),
    [
        (HALF, "chair", [BOX], [], [True]),
        (LESS, "chair", [BOX], [], [False]),
        (BOX, "table", [BOX], [], [False]),
        (ACROSS, "chair", [[1272, 300, 1322, 400]], [], [True]),
        (ACROSS, "chair", [FROM_THE_OTHER_SIDE], [], [True]),
        (HALF, "chair", [], [BOX], []),
        (LESS, "chair", [], [BOX], [False]),
        (BOX, "television", [], [BOX], [False]),
        ([110, 10, 140, 40], "chair", [], [BOX], [False]),
        (ACROSS, "chair", [], [FROM_THE_OTHER_SIDE], []),
    ],
    ids=["half", "less than half", "another class", "the seam", "the seam, from the other side", "ignored",
         "less than half of an ignored one", "another class than the ignored one", "small inside an ignored one",
         "ignored across the seam"],
)  # fmt: skip
def test_a_detection_is_right_a_false_alarm_or_ignored(box, label, wanted, ignored, told):
    assert matched([box], [0.9], wanted, ignored, label).correct.tolist() == told


def test_an_ignored_object_of_another_class_in_the_same_place_changes_nothing():
    assert matched([BOX], [0.9], [BOX], [BOX], ignored_label="table").correct.tolist() == [True]
    assert matched([BOX], [0.9], [BOX], [BOX]).n_objects == 1


def test_the_best_score_takes_the_free_object_that_it_overlaps_most_and_a_second_one_is_a_false_alarm():
    matching = matched([[100, 300, 150, 400], [105, 300, 155, 400]], [0.5, 0.9], [[100, 300, 150, 400]])
    assert matching.scores.tolist() == [0.9, 0.5]
    assert matching.correct.tolist() == [True, False]
    # The second one overlaps the first object alone: it is right only where that one is left free.
    boxes, objects = [[100, 0, 200, 100], [130, 0, 230, 100]], [[120, 0, 220, 100], [95, 0, 195, 100]]
    assert matched(boxes, [0.9, 0.8], objects).correct.tolist() == [True, True]


def test_matching_does_not_depend_on_the_order_of_detections():
    rng = np.random.default_rng(3)
    low = rng.uniform([0, 0], [WIDTH, 500], (12, 2))
    boxes = np.concatenate([low, low + rng.uniform(20, 120, (12, 2))], axis=1)
    targets, scores = boxes[:6] + rng.uniform(-8, 8, (6, 4)), rng.permutation(12) / 12
    first = matched(boxes, scores, targets)
    order = rng.permutation(12)
    second = matched(boxes[order], scores[order], targets)
    assert first.scores.tolist() == second.scores.tolist()
    assert first.correct.tolist() == second.correct.tolist()
    assert first.correct.sum() >= 4
