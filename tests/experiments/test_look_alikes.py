"""Answers within half a metre and 10 degrees: who is counted as what, how surely, and what a threshold buys."""

from functools import partial

import numpy as np
import pytest

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.matchers import ASSOCIATIONS
from courseware.experiments.look_alikes import (
    Answer,
    answers_of_rooms,
    answers_of_sequences,
    answers_table,
    is_right,
    measured_motion,
    risk_coverage,
)
from courseware.experiments.observed_rooms import record_of_observations
from tests.beyond.look_alikes.look_alike_scene import PLANTED, POSE, SYMMETRIC, observed, scattered

STEPS = (POSE, POSE + [0.3, -0.1, 0.2], POSE + [0.5, 0.2, 0.3])  # noqa: RUF005 (they are arrays)


def record_of(semantic_map, seed=7, which=None):
    """A room's record with one pose at each height; which: the landmarks that are seen."""
    indices = list(range(len(semantic_map))) if which is None else list(which)
    entry = {"observations": record_of_observations(observed(semantic_map, POSE, indices)), "true_landmarks": indices}
    pose = {"pose": POSE.tolist(), "name": "00", "sources": {"images": entry, "exact_boxes": entry}}
    landmarks = [[one.label, one.x, one.y, one.hue, one.saturation] for one in semantic_map.landmarks]
    poses = [pose | {"experiment": number} for number in (1, 2)]
    return {"seed": seed, "map": landmarks, "walls": np.asarray(semantic_map.walls).tolist(), "poses": poses}


def views_of(semantic_map, which=None):
    seen = [record_of_observations(observed(semantic_map, pose, which)) for pose in STEPS[1:]]
    views = [{"pose": pose.tolist(), "observations": one} for pose, one in zip(STEPS[1:], seen, strict=True)]
    return [{"experiment": 2, "name": "00", "views": views}]


def answer(kind="correct", confidence=0.9, right=True, seed=1, errors=(0.1, 0.2, 3.0), all_right=True):
    return Answer(seed, 1, "00", "consistent", kind, confidence, right, *errors, all_right)


@pytest.mark.parametrize(
    ("error", "right"),
    [((0.3, 0.39, 9.9), True), ((0.4, 0.4, 0.0), False), ((0.0, 0.0, 10.1), False), ((np.nan,) * 3, False)],
)
def test_correct_is_within_half_a_metre_and_ten_degrees(error, right):
    assert is_right(error) is right


def test_every_matcher_answers_and_only_the_consistent_one_says_that_it_cannot():
    found = {one.method: one for one in answers_of_rooms([record_of(SYMMETRIC)], ASSOCIATIONS)}
    assert found["consistent"].kind == "unanswered"
    assert {found[name].kind for name in ("greedy", "hungarian")} <= {"correct", "wrong"}
    assert found["greedy"].confidence == 1.0
    right = {one.method: one for one in answers_of_rooms([record_of(PLANTED)], ASSOCIATIONS)}["consistent"]
    assert (right.kind, right.all_matches_right, right.best_is_right) == ("correct", True, True)
    assert right.dx_m < 0.01


def test_on_a_wrong_map_every_answer_is_wrong():
    rng = np.random.default_rng(27)
    rooms = [record_of(scattered(rng), seed=1), record_of(scattered(rng), seed=2)]
    kinds = {"everything": Evidence(), "gap_alone": Evidence(absolute=False)}
    variants = {name: partial(associate_consistent, evidence=one) for name, one in kinds.items()}
    found = answers_of_rooms(rooms, variants, wrong_map=True)
    assert {one.kind for one in found} <= {"wrong", "unanswered"}
    assert not any(one.all_matches_right or one.best_is_right for one in found)
    assert {one.kind for one in found if one.method == "everything"} == {"unanswered"}
    own = answers_of_rooms(rooms, variants)
    assert {one.kind for one in own if one.method == "everything"} == {"correct"}


def test_what_the_first_view_told_is_known_after_the_last():
    """The plant is in the first view only; the views after it are of a symmetric room."""
    found = answers_of_sequences([record_of(PLANTED)], [views_of(PLANTED, which=range(5))])
    assert {one.method: one.kind for one in found} == {"odometry": "correct", "no_odometry": "correct"}
    assert {one.all_matches_right for one in found} == {None}
    nothing = answers_of_sequences([record_of(PLANTED, which=range(5))], [views_of(PLANTED, which=range(5))])
    assert {one.kind for one in nothing} == {"unanswered"}


def test_odometry_is_the_true_motion_with_its_noise():
    rng = np.random.default_rng(2)
    start, end = np.array([1.0, 1.0, np.pi / 2]), np.array([1.0, 3.0, np.pi / 2 + 0.5])
    drawn = np.array([measured_motion(start, end, rng)[:3] for _ in range(400)])
    np.testing.assert_allclose(drawn.mean(axis=0), [2.0, 0.0, 0.5], atol=0.03)
    covariance = measured_motion(start, end, rng).covariance
    np.testing.assert_allclose(np.sqrt(np.diag(covariance)), [0.11, 0.11, np.deg2rad(1.0) + 0.025])
    np.testing.assert_allclose(drawn.std(axis=0), np.sqrt(np.diag(covariance)), rtol=0.15)


def test_the_table_counts_kinds_and_averages_the_errors_of_the_correct():
    answers = [answer(), answer(errors=(0.3, 0.0, 1.0), all_right=False), answer("wrong", right=False, seed=2)]
    answers.append(answer("unanswered", 0.2, True, 2, (np.nan,) * 3, False))
    table = answers_table(answers)
    assert (table["correct_percent"], table["wrong_percent"], table["unanswered_percent"]) == (50.0, 25.0, 25.0)
    assert (table["all_matches_right_percent"], table["best_is_right_percent"]) == (50.0, 75.0)
    assert (table["mean_dx_m"], table["mean_dy_m"], table["mean_dtheta_deg"]) == pytest.approx((0.2, 0.1, 2.0))
    assert table["wrong_wilson_percent"][0] > 0
    assert table["correct_rooms_percent"] == [0.0, 100.0]
    unknown = answers_table([one._replace(all_matches_right=None) for one in answers])
    assert unknown["all_matches_right_percent"] is None


def test_risk_over_coverage_goes_through_every_threshold():
    told = (0.9, True), (0.8, False), (0.7, True), (0.7, True), (0, False)
    curve = risk_coverage([answer(confidence=confidence, right=right) for confidence, right in told])
    assert list(curve.values()) == [[0.9, 0.8, 0.7], [20.0, 40.0, 80.0], [0.0, 50.0, 25.0]]
