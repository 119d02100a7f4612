"""The paper's tables: what counts as correct, how errors are averaged, and that its own rows agree."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course_lib.experiments.paper_tables import PAPER_TABLE_3, PAPER_TABLE_4, PAPER_TABLE_5
from course_lib.experiments.room_evaluation import (
    NO_OBJECT,
    EvaluationError,
    PoseOutcome,
    identify_detections,
    outcome,
    summary,
    true_landmarks_of,
    wrong_pairs,
)
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS, MEASUREMENT_PLACES
from course_lib.spherical_stereo.detection.detected_object import Detection, DetectionError
from course_lib.spherical_stereo.panorama import View
from course_lib.spherical_stereo.pose.localization import Localization, PlacedObject
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.association import Observation

WIDTH = 1280
TRUE_POSE = (1.0, 2.0, 3.1)


def localized(pairs=((0, 0), (1, 1), (2, 2)), pose=Pose2D(1.1, 1.7, -3.1), status="ok", same_class=None):  # noqa: B008
    n = 1 + max((i for i, _ in pairs), default=-1)
    same_class = [True] * len(pairs) if same_class is None else same_class
    association = SimpleNamespace(
        pairs=tuple(pairs), usable_pairs=tuple(p for p, same in zip(pairs, same_class, strict=True) if same)
    )
    observations = tuple(Observation("sofa", i, 0, 10, 50) for i in range(n))
    return Localization(pose if status == "ok" else None, status, observations=observations, association=association)


def test_all_pairs_right_and_both_errors_small_is_correct():
    judged = outcome(localized(), TRUE_POSE, [0, 1, 2])
    assert judged.kind == "correct"
    assert judged[1:3] == pytest.approx((0.1, 0.3))
    assert judged.dtheta_deg == pytest.approx(math.degrees(2 * math.pi - 6.2))


def test_one_wrong_pair_is_incorrect_however_small_the_errors():
    assert outcome(localized(), TRUE_POSE, [0, 1, 3]).kind == "incorrect"
    assert wrong_pairs(localized(), [0, 1, 3]) == ((2, 2, 3),)


def test_a_pair_with_a_detection_of_nothing_is_wrong():
    assert outcome(localized(), TRUE_POSE, [0, NO_OBJECT, 2]).kind == "incorrect"


def test_a_wrong_pair_of_unlike_classes_is_not_used_and_does_not_count():
    found = localized(same_class=[True, True, False])
    assert outcome(found, TRUE_POSE, [0, 1, 9]).kind == "correct"


@pytest.mark.parametrize(
    ("x", "y", "kind"),
    [(3.0, 4.0, "correct"), (3.01, 2.0, "incorrect"), (1.0, -0.01, "incorrect"), (-1.0, 0.0, "correct")],
)
def test_more_than_two_metres_in_x_or_y_is_incorrect(x, y, kind):
    assert outcome(localized(pose=Pose2D(x, y, 0.0)), TRUE_POSE, [0, 1, 2]).kind == kind


def test_a_wrong_heading_alone_is_not_in_table_2():
    assert outcome(localized(pose=Pose2D(1.0, 2.0, 0.0)), TRUE_POSE, [0, 1, 2]).kind == "correct"


@pytest.mark.parametrize(
    "found", [localized(status="unable"), localized(pairs=[(0, 0)]), localized(same_class=[True, False, False])]
)
def test_no_pose_or_one_pair_is_unable(found):
    judged = outcome(found, TRUE_POSE, [0] * len(found.observations))
    assert judged.kind == "unable"
    assert all(math.isnan(error) for error in judged[1:])


@given(st.floats(-10, 10), st.floats(-10, 10))
def test_the_heading_error_is_at_most_half_a_turn(theta, true_theta):
    judged = outcome(localized(pose=Pose2D(1, 2, theta)), (1, 2, true_theta), [0, 1, 2])
    assert 0 <= judged.dtheta_deg <= 180
    assert math.cos(math.radians(judged.dtheta_deg)) == pytest.approx(math.cos(theta - true_theta))


def test_a_truth_that_does_not_fit_is_named():
    with pytest.raises(EvaluationError, match="one true landmark an observation"):
        outcome(localized(), TRUE_POSE, [0, 1])
    with pytest.raises(EvaluationError, match="three finite numbers"):
        outcome(localized(), (1.0, 2.0), [0, 1, 2])
    with pytest.raises(EvaluationError, match="three finite numbers"):
        outcome(localized(), (1.0, 2.0, math.nan), [0, 1, 2])


def detection(label, u, v=300.0, across=100.0, down=80.0):
    return Detection(label, 0.9, (u, v, u + across, v + down), 10.0, 50.0)


def true(label, u, v=300.0, across=100.0, down=80.0):
    return (label, (u, v, u + across, v + down), (u, v, u + across, v + down))


def test_a_detection_shows_the_object_that_it_overlaps_most():
    objects = [true("sofa", 500), true("sofa", 530), true("chair", 505)]
    assert identify_detections([detection("sofa", 504), detection("sofa", 535)], objects, WIDTH) == (0, 1)


def test_a_detection_of_another_class_shows_nothing():
    assert identify_detections([detection("chair", 500)], [true("sofa", 500)], WIDTH) == (NO_OBJECT,)


def test_a_detection_that_overlaps_by_less_than_half_shows_nothing():
    assert identify_detections([detection("sofa", 540)], [true("sofa", 500)], WIDTH) == (NO_OBJECT,)
    assert identify_detections([detection("sofa", 530)], [true("sofa", 500)], WIDTH) == (0,)


def test_of_two_detections_of_one_object_the_better_one_shows_it():
    found = identify_detections([detection("sofa", 520), detection("sofa", 505)], [true("sofa", 500)], WIDTH)
    assert found == (NO_OBJECT, 0)


def test_a_half_hidden_object_is_recognized_by_what_is_seen_of_it_or_by_all_of_it():
    sofa = [("sofa", (500, 300, 540, 380), (500, 300, 600, 380))]
    for u_max in (545, 595):
        whole_or_part = detection("sofa", 500, across=u_max - 500.0)
        assert identify_detections([whole_or_part], sofa, WIDTH) == (0,)


def test_a_box_across_the_seam_is_recognized_from_either_side():
    assert identify_detections([detection("sofa", 1230)], [true("sofa", -40)], WIDTH) == (0,)


def test_a_couch_shows_a_sofa():
    assert identify_detections([detection("couch", 500)], [true("sofa", 500)], WIDTH) == (0,)


def test_nothing_detected_or_nothing_there_shows_nothing():
    assert identify_detections([], [true("sofa", 500)], WIDTH) == ()
    assert identify_detections([detection("sofa", 500)], [], WIDTH) == (NO_OBJECT,)


def test_a_true_box_that_is_none_is_named():
    with pytest.raises(DetectionError):
        identify_detections([detection("sofa", 500)], [("sofa", (5, 5, 1, 1), (5, 5, 1, 1))], WIDTH)


def with_objects():
    """Three objects in both images; the second is of a class that the map lacks."""
    objects = tuple(
        PlacedObject(upper, lower, "sofa", "ok", np.zeros(3), observation)
        for upper, lower, observation in ((2, 0, 0), (0, 1, None), (1, 2, 1))
    )
    return Localization(
        None,
        "unable",
        upper=View.of_detections(("a", "b", "c"), (4, 2)),
        lower=View.of_detections(("d", "e", "f"), (4, 2)),
        objects=objects,
        observations=(Observation("sofa", 0, 0, 0, 0),) * 2,
    )


def test_the_true_landmark_goes_by_the_object_in_the_upper_image():
    assert true_landmarks_of(with_objects(), [7, 5, 6], {5: 0, 6: 1, 7: 2}) == (1, 0)


def test_an_object_that_is_on_no_map_has_no_landmark():
    assert true_landmarks_of(with_objects(), [7, NO_OBJECT, 6], {5: 0}) == (NO_OBJECT, NO_OBJECT)
    assert true_landmarks_of(with_objects(), [0, NO_OBJECT, 1], [4, 3]) == (3, NO_OBJECT)


def test_an_observation_made_of_two_objects_shows_neither():
    assert true_landmarks_of(with_objects(), [7, 5, 6], {5: 0, 6: 1}, [6, 7, 4]) == (1, NO_OBJECT)


def test_identities_that_do_not_fit_are_named():
    with pytest.raises(EvaluationError, match="2 identities for 3 detections of the upper image"):
        true_landmarks_of(with_objects(), [1, 2], {})
    with pytest.raises(EvaluationError, match="lower image"):
        true_landmarks_of(with_objects(), [1, 2, 3], {}, [1])


OUTCOMES = [
    PoseOutcome("correct", 0.1, 0.2, 2.0),
    PoseOutcome("correct", 0.3, 0.4, 4.0),
    PoseOutcome("incorrect", 1.4, 0.9, 90.0),
    PoseOutcome("unable", math.nan, math.nan, math.nan),
]


def test_the_rates_are_shares_of_all_poses():
    found = summary(OUTCOMES)
    assert [found[f"{kind}_percent"] for kind in ("correct", "incorrect", "unable")] == [50.0, 25.0, 25.0]


def test_all_is_everything_but_unable():
    found = summary(OUTCOMES)
    assert [found[kind]["n"] for kind in ("all", "correct", "incorrect")] == [3, 2, 1]
    assert found["all"]["mean_dx_m"] == pytest.approx((0.1 + 0.3 + 1.4) / 3)
    assert found["all"]["mean_dtheta_deg"] == pytest.approx(32.0)


def test_the_standard_deviation_is_that_of_the_absolute_errors():
    assert summary(OUTCOMES)["correct"]["std_dy_m"] == pytest.approx(0.1)
    assert summary(OUTCOMES)["incorrect"]["std_dy_m"] == 0.0


def test_the_median_stands_beside_the_mean():
    assert summary(OUTCOMES)["all"]["median_dx_m"] == pytest.approx(0.3)
    assert summary(OUTCOMES)["all"]["median_dtheta_deg"] == pytest.approx(4.0)


def test_a_kind_that_never_happened_has_no_mean():
    nothing = summary([OUTCOMES[0]])["incorrect"]
    assert nothing.pop("n") == 0
    assert nothing.keys() >= PAPER_TABLE_3["all"].keys()
    assert set(nothing.values()) == {None}
    with pytest.raises(EvaluationError, match="no outcomes"):
        summary([])


@pytest.mark.parametrize("table", [PAPER_TABLE_3, PAPER_TABLE_4])
def test_the_papers_rows_are_those_of_13_and_5_poses_with_divisor_n(table):
    n = {"correct": 13, "incorrect": 5}
    for unit, last_digit in (("dx_m", 0.01), ("dy_m", 0.01), ("dtheta_deg", 0.02)):
        mean, std, total = f"mean_{unit}", f"std_{unit}", sum(n.values())
        together = sum(n[kind] * table[kind][mean] for kind in n) / total
        assert together == pytest.approx(table["all"][mean], abs=last_digit)
        square = sum(n[kind] * (table[kind][std] ** 2 + table[kind][mean] ** 2) for kind in n) / total
        assert math.sqrt(square - together**2) == pytest.approx(table["all"][std], abs=2 * last_digit)


def test_the_papers_table_and_not_its_text_agrees_with_its_row_all():
    def all_from(correct):
        return (13 * correct + 5 * PAPER_TABLE_3["incorrect"]["mean_dtheta_deg"]) / 18

    printed = PAPER_TABLE_3["all"]["mean_dtheta_deg"]
    assert abs(all_from(PAPER_TABLE_3["correct"]["mean_dtheta_deg"]) - printed) < 0.01  # 11.94, the table
    assert abs(all_from(11.92) - printed) > 0.01  # 11.92, the text: further off than rounding explains


def test_table_1_has_ten_places_with_two_headings_and_two_heights():
    assert [one.place for one in MEASUREMENT_PLACES] == list(range(1, 11))
    assert all(len(set(one.headings_deg)) == 2 for one in MEASUREMENT_PLACES)
    assert all(upper - lower == pytest.approx(0.30) for upper, lower in CAMERA_HEIGHTS.values())


def test_the_rates_of_table_5_are_whole_numbers_of_20_poses():
    for rates in PAPER_TABLE_5.values():
        assert sum(rates.values()) == 100
        assert [rate * 20 / 100 for rate in rates.values()] == [13, 5, 2]
