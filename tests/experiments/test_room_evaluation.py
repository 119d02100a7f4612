"""The paper's tables: what counts as correct, how errors are averaged, and that its own rows agree."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.pose.localization import Localization, PlacedObject
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.association import Observation
from courseware.experiments.room_evaluation import (
    NO_OBJECT,
    PAPER_TABLE_3,
    PAPER_TABLE_4,
    PoseOutcome,
    identify_detections,
    match_detections,
    outcome,
    summary,
    true_landmarks_of,
    wrong_pairs,
)
from courseware.simulation.room.stereo_recording import TrueObject

WIDTH = 1280
TRUE_POSE = (1.0, 2.0, 3.1)


def localized(pairs=((0, 0), (1, 1), (2, 2)), pose=Pose2D(1.1, 1.7, -3.1), status="ok", same_class=None):  # noqa: B008
    n = 1 + max((i for i, _ in pairs), default=-1)
    same_class = [True] * len(pairs) if same_class is None else same_class
    usable = tuple(pair for pair, same in zip(pairs, same_class, strict=True) if same)
    association = SimpleNamespace(pairs=tuple(pairs), usable_pairs=usable)
    observations = tuple(Observation("sofa", i, 0, 10, 50) for i in range(n))
    return Localization(pose if status == "ok" else None, status, observations=observations, association=association)


def test_errors_are_absolute_and_the_heading_goes_the_short_way_round():
    kind, *errors = outcome(localized(), TRUE_POSE, [0, 1, 2])
    assert kind == "correct"
    assert errors == pytest.approx([0.1, 0.3, math.degrees(2 * math.pi - 6.2)])


def test_one_wrong_pair_is_incorrect_and_one_of_unlike_classes_does_not_count():
    assert outcome(localized(), TRUE_POSE, [0, 1, 3]).kind == "incorrect"
    assert outcome(localized(), TRUE_POSE, [0, NO_OBJECT, 2]).kind == "incorrect"
    assert wrong_pairs(localized(), [0, 1, 3]) == ((2, 2, 3),)
    assert outcome(localized(same_class=[True, True, False]), TRUE_POSE, [0, 1, 9]).kind == "correct"


@pytest.mark.parametrize(
    ("x", "y", "kind"),
    [(3.0, 4.0, "correct"), (3.01, 2.0, "incorrect"), (1.0, -0.01, "incorrect"), (-1.0, 0.0, "correct")],
)
def test_more_than_two_metres_in_x_or_y_is_incorrect_and_a_heading_alone_is_not_in_table_2(x, y, kind):
    assert outcome(localized(pose=Pose2D(x, y, 0.0)), TRUE_POSE, [0, 1, 2]).kind == kind


@pytest.mark.parametrize(
    "found", [localized(status="unable"), localized(pairs=[(0, 0)]), localized(same_class=[True, False, False])]
)
def test_no_pose_or_one_pair_is_unable(found):
    judged = outcome(found, TRUE_POSE, [0] * len(found.observations))
    assert judged.kind == "unable"
    assert all(math.isnan(error) for error in judged[1:])


def detection(label, u, across=100.0):
    return Detection(label, 0.9, (u, 300.0, u + across, 380.0), 10.0, 50.0)


def true(number, label, u):
    return TrueObject(number, label, *[(u, 300.0, u + 100.0, 380.0)] * 2, 1.0)


# The box of what is seen, and of all of it.
HALF_HIDDEN = TrueObject(7, "sofa", (500, 300, 540, 380), (500, 300, 600, 380), 0.4)


@pytest.mark.parametrize(
    ("detections", "objects", "shown"),
    [
        ([detection("sofa", 504), detection("sofa", 535)], [true(7, "sofa", 500), true(4, "sofa", 530)], (7, 4)),
        ([detection("sofa", 520), detection("sofa", 505)], [true(7, "sofa", 500)], (NO_OBJECT, 7)),
        ([detection("chair", 500)], [true(7, "sofa", 500)], (NO_OBJECT,)),
        ([detection("couch", 500)], [true(7, "sofa", 500)], (7,)),
        ([detection("sofa", 540)], [true(7, "sofa", 500)], (NO_OBJECT,)),
        ([detection("sofa", 530)], [true(7, "sofa", 500)], (7,)),
        ([detection("sofa", 500, across=45.0)], [HALF_HIDDEN], (7,)),
        ([detection("sofa", 500, across=95.0)], [HALF_HIDDEN], (7,)),
        ([detection("sofa", 1230)], [true(7, "sofa", -40)], (7,)),
        ([], [true(7, "sofa", 500)], ()),
        ([detection("sofa", 500)], [], (NO_OBJECT,)),
    ],
    ids=["the one that it overlaps most", "the better one shows it", "another class", "a couch is a sofa",
         "less than half", "half", "what is seen of it", "all of it", "the seam", "no detection", "no object"],
)  # fmt: skip
def test_what_a_detection_shows(detections, objects, shown):
    assert identify_detections(detections, objects, WIDTH) == shown


def test_an_observation_shows_the_landmark_of_its_object_unless_there_is_none_or_two_objects():
    """Three objects in both images; the second is of a class that the map lacks."""
    seen = (2, 0, 0), (0, 1, None), (1, 2, 1)
    objects = tuple(PlacedObject(up, low, "sofa", "ok", np.zeros(3), observed) for up, low, observed in seen)
    found = Localization(None, "unable", objects=objects, observations=(Observation("sofa", 0, 0, 0, 0),) * 2)
    assert true_landmarks_of(found, [7, 5, 6], [6, 7, 5], 8) == (6, 5)
    assert true_landmarks_of(found, [7, 5, 6], [6, 7, 5], 6) == (NO_OBJECT, 5), "6 is on no map"
    assert true_landmarks_of(found, [7, 5, 6], [6, 7, 4], 8) == (6, NO_OBJECT), "two objects"
    assert true_landmarks_of(found, [7, NO_OBJECT, 6], [6, 7, NO_OBJECT], 8) == (6, NO_OBJECT)


def test_the_summary_counts_kinds_and_averages_absolute_errors_of_everything_but_unable():
    correct = [PoseOutcome("correct", 0.1, 0.2, 2.0), PoseOutcome("correct", 0.3, 0.4, 4.0)]
    others = [PoseOutcome("incorrect", 1.4, 0.9, 90.0), PoseOutcome("unable", math.nan, math.nan, math.nan)]
    found = summary(correct + others)
    assert [found[f"{kind}_percent"] for kind in ("correct", "incorrect", "unable")] == [50.0, 25.0, 25.0]
    assert [found[kind]["n"] for kind in ("all", "correct", "incorrect")] == [3, 2, 1]
    assert found["all"]["mean_dx_m"] == pytest.approx((0.1 + 0.3 + 1.4) / 3)
    assert found["all"]["median_dx_m"] == pytest.approx(0.3)
    assert (found["correct"]["std_dy_m"], found["incorrect"]["std_dy_m"]) == (pytest.approx(0.1), 0.0)
    nothing = summary(correct)["incorrect"]
    assert nothing.pop("n") == 0
    assert set(nothing.values()) == {None}


@pytest.mark.parametrize("table", [PAPER_TABLE_3, PAPER_TABLE_4])
def test_the_papers_rows_are_those_of_13_and_5_poses_with_divisor_n(table):
    n = {"correct": 13, "incorrect": 5}
    for unit, last_digit in (("dx_m", 0.01), ("dy_m", 0.01), ("dtheta_deg", 0.02)):
        mean, std, total = f"mean_{unit}", f"std_{unit}", sum(n.values())
        together = sum(n[kind] * table[kind][mean] for kind in n) / total
        assert together == pytest.approx(table["all"][mean], abs=last_digit)
        square = sum(n[kind] * (table[kind][std] ** 2 + table[kind][mean] ** 2) for kind in n) / total
        assert math.sqrt(square - together**2) == pytest.approx(table["all"][std], abs=2 * last_digit)


def matched(boxes, scores, wanted=(), ignored=(), label="chair"):
    """What becomes of detections; objects are chairs."""
    detections = [Detection(label, score, tuple(box), 0.0, 0.0) for box, score in zip(boxes, scores, strict=True)]
    objects = [TrueObject(k, "chair", tuple(box), tuple(box), 1.0) for k, box in enumerate([*wanted, *ignored])]
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
        (BOX, "chair", [BOX], [BOX], [True]),
    ],
    ids=["half", "less than half", "another class", "the seam", "the seam, from the other side", "ignored",
         "less than half of an ignored one", "another class than the ignored one", "small inside an ignored one",
         "ignored across the seam", "beside an ignored one"],
)  # fmt: skip
def test_a_detection_is_right_a_false_alarm_or_ignored(box, label, wanted, ignored, told):
    assert matched([box], [0.9], wanted, ignored, label).correct.tolist() == told
    assert matched([box], [0.9], wanted, ignored, label).n_objects == len(wanted)


def test_the_best_score_takes_the_free_object_that_it_overlaps_most_and_a_second_one_is_a_false_alarm():
    scores, correct, _ = matched([[100, 300, 150, 400], [105, 300, 155, 400]], [0.5, 0.9], [[100, 300, 150, 400]])
    assert (scores.tolist(), correct.tolist()) == ([0.9, 0.5], [True, False])
    # The second one overlaps the first object alone: it is right only where that one is left free.
    boxes, objects = [[100, 0, 200, 100], [130, 0, 230, 100]], [[120, 0, 220, 100], [95, 0, 195, 100]]
    assert matched(boxes, [0.9, 0.8], objects).correct.tolist() == [True, True]
