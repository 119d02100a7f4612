"""What lesson 18 says about poses of two matches, their scores, abstaining, and rooms with two equal ends holds."""

import numpy as np
import pytest

from course_lib.beyond import Evidence, SemanticTracker, rank_poses
from course_lib.beyond.look_alikes.confidence import confidence_of
from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.look_alikes.evidence import detection_probabilities
from course_lib.beyond.look_alikes.hypotheses import pair_poses, scene_of
from course_lib.experiments.look_alikes import CORRECT, UNANSWERED, WRONG, is_right, pose_errors
from course_lib.lessons import lesson_18
from course_lib.lessons.kit.display import require_labels
from course_lib.lessons.kit.exercises import find_exercise
from course_lib.lessons.lesson_18.figures import ellipse_of
from course_lib.lessons.lesson_18.panel import MAX_HIDDEN, MIRROR, PAIRS, ROOM, hypotheses_panel, ranked
from course_lib.lessons.lesson_18.scenes import mirrored
from course_lib.lessons.lesson_18.terms import residual_sigmas, score_terms, share_of_nothing
from course_lib.lessons.lesson_18.trials import answers_of_confidence
from course_lib.spherical_stereo import Pose2D, SemanticLocalizer, StereoRig

TRUTH = np.array([1.2, -0.7, 0.4])


@pytest.fixture(scope="module")
def scene():
    return lesson_18.room_scenes()[lesson_18.PAIR]


@pytest.fixture(scope="module")
def half_seen():
    return lesson_18.half_seen_scenes(5, np.random.default_rng(18))


def wrong_matches(scene, pairs):
    return sum(scene.true_landmarks[i] != j for i, j in pairs)


def test_by_colour_all_three_sofas_are_wrong_and_two_matches_get_every_object_right(scene):
    pose, pairs = lesson_18.matched_by_colour(scene)
    assert wrong_matches(scene, pairs) == 3
    assert np.hypot(pose.x - scene.pose.x, pose.y - scene.pose.y) > 0.5
    pose, pairs, observations = lesson_18.matched_by_two(scene, (6, 11))
    assert {scene.true_landmarks[i] for i in observations} == {6, 11}
    assert (len(pairs), wrong_matches(scene, pairs)) == (12, 0)
    assert np.hypot(pose.x - scene.pose.x, pose.y - scene.pose.y) < 0.25


def test_most_pairs_of_matches_are_wrong_and_most_right_ones_make_the_right_pose(scene):
    two = pair_poses(scene_of(scene.observations, lesson_18.room_map()))
    right = lesson_18.both_right(two, scene)
    near = np.array([is_right(pose_errors(Pose2D(*pose), scene.pose)) for pose in two.poses])
    assert right.mean() < 0.35
    assert 0.8 < near[right].mean() < 1
    assert near[~right].mean() < 0.05


@pytest.mark.parametrize("hidden", [0, 4, MAX_HIDDEN])
@pytest.mark.parametrize("map_name", [ROOM, MIRROR])
def test_the_terms_add_up_to_the_score_and_the_shares_to_one(hidden, map_name):
    for photographs in PAIRS:
        found = ranked(photographs, map_name, hidden)
        assert found.poses
        for one in found.poses:
            assert sum(score_terms(found.arrays, one).values()) == pytest.approx(one.score)
            assert (residual_sigmas(found.arrays, one) ** 2).sum() == pytest.approx(one.chi_square)
        shares = sum(one.share for one in found.poses)
        assert shares + share_of_nothing(found.arrays, found.poses) == pytest.approx(1)


def test_a_mirror_changes_no_distance_and_leaves_no_pose_right():
    room, mirror = lesson_18.room_map(), mirrored(lesson_18.room_map())
    apart = [np.linalg.norm(one.positions[:, None] - one.positions[None], axis=-1) for one in (room, mirror)]
    assert np.allclose(*apart)
    assert np.ptp(mirror.walls, axis=0) == pytest.approx(np.ptp(room.walls, axis=0))
    for scene in list(lesson_18.room_scenes().values())[::4]:
        assert confidence_of(rank_poses(scene.observations, mirror)[0]) < 0.01


def test_weighed_by_the_covariance_the_fit_errs_by_a_third_less():
    errors = lesson_18.fit_errors()
    assert len(errors["plain"]) == len(errors["weighed"]) == 20
    assert errors["weighed"].mean() < 0.67 * errors["plain"].mean()


def test_half_seen_the_consistent_matcher_abstains_where_the_others_are_wrong(half_seen):
    answers = lesson_18.answers_of_matchers(half_seen)
    count = {
        (matcher, kind): sum(one.method == matcher and one.kind == kind for one in answers)
        for matcher in ("greedy", "hungarian", "consistent")
        for kind in (CORRECT, WRONG, UNANSWERED)
    }
    assert count["greedy", WRONG] > 20
    assert count["hungarian", WRONG] > count["greedy", WRONG]
    assert count["consistent", WRONG] == 0
    assert count["consistent", CORRECT] > count["greedy", CORRECT] > count["hungarian", CORRECT]
    assert sum(one.best_is_right for one in answers if one.method == "consistent") >= 97


def test_the_gap_alone_falls_for_the_mirror_and_none_of_these_does_not(half_seen):
    fooled = {
        kind: sum(one.kind == WRONG for one in answers_of_confidence(half_seen, evidence, wrong_map=True))
        for kind, evidence in (("all", Evidence()), ("gap", lesson_18.GAP_ALONE))
    }
    assert fooled["all"] == 0
    assert fooled["gap"] >= 15


def test_both_maps_are_asked_with_every_kind_of_evidence(half_seen):
    found = lesson_18.answers_on_both_maps(half_seen[:4], {"everything": Evidence()})
    here, mirror = found["everything"]
    assert len(here) == len(mirror) == 4
    assert all(one.kind != CORRECT and not one.best_is_right for one in mirror)


def test_two_objects_are_never_answered_and_eight_always():
    for n_seen, answered in ((2, 0), (8, 20)):
        answers = lesson_18.answers_of_few(n_seen, 1, np.random.default_rng(18))
        assert sum(one.kind != UNANSWERED for one in answers) == answered


def test_a_second_view_answers_what_the_first_did_not():
    answers = lesson_18.answers_of_two_views(2, np.random.default_rng(18))
    correct = {
        method: sum(one.method == method and one.kind == CORRECT for one in answers)
        for method in ("one view", "two views, odometry")
    }
    assert correct["one view"] < correct["two views, odometry"]
    assert all(one.kind != WRONG for one in answers)


def test_two_equal_ends_share_the_belief_and_no_pose_is_given_out():
    hall = lesson_18.SYMMETRIC_ROOM
    view = lesson_18.exact_view(hall, TRUTH, [0, 1, 2, 3, 4])
    first, second, *_ = rank_poses(view, hall)
    assert first.share == pytest.approx(second.share)
    assert first.share + second.share == pytest.approx(1, abs=0.01)
    places = sorted([first.pose[:2], second.pose[:2]])
    assert np.allclose(places, [(-1.2, 0.7), (1.2, -0.7)], atol=1e-6)
    found = SemanticLocalizer(StereoRig(0.3), hall, association=associate_consistent).localize_observations(view)
    assert (found.pose, found.reason) == (None, "ambiguous")


def test_the_plant_misleads_while_it_is_missed_and_settles_it_when_it_is_seen():
    room = lesson_18.ROOM_WITH_PLANT
    poses, views, motions = lesson_18.walk_past_the_plant(TRUTH)
    assert [len(view) for view in views] == [5, 5, 6]
    assert motions[0] is None
    tracker, belief = SemanticTracker(room), []
    for pose, view, motion in zip(poses, views, motions, strict=True):
        track = tracker.step(view, motion)
        belief.append(lesson_18.belief_at(pose, track.alternatives))
    assert belief[1] < 0.5 < belief[0]
    assert belief[2] > 0.9
    assert track.status == "ok"
    other = np.array([-poses[1, 0], -poses[1, 1], 0.0])
    assert detection_probabilities(room, other[None])[0, 5] == 0.5 < detection_probabilities(room, poses[1:2])[0, 5]


def test_four_right_matches_are_sure_and_a_quarter_of_a_metre_off():
    name, which = lesson_18.FEW_SEEN
    few = lesson_18.thinned(lesson_18.room_scenes()[name], np.array(which))
    best = rank_poses(few.observations, lesson_18.room_map())[0]
    assert wrong_matches(few, best.pairs) == 0
    assert len(best.pairs) == 4
    assert confidence_of(best) >= 0.8
    off = np.array(best.pose[:2]) - few.pose[:2]
    assert np.hypot(*off) > 0.25
    assert np.sqrt(off @ np.linalg.inv(best.covariance[:2, :2]) @ off) < 3


def test_a_threshold_reads_coverage_and_risk_off_the_curve():
    curve = {"threshold": [0.9, 0.8, 0.5], "coverage_percent": [10.0, 20.0, 30.0], "risk_percent": [0.0, 5.0, 7.0]}
    assert lesson_18.at_threshold(curve) == (20.0, 5.0)
    assert lesson_18.at_threshold(curve, 0.95) == (0.0, 0.0)
    assert lesson_18.at_threshold(curve, 0.1) == (30.0, 7.0)


def test_a_tape_measure_moves_landmarks_by_centimetres():
    moved = lesson_18.surveyed(lesson_18.SYMMETRIC_ROOM, np.random.default_rng(1))
    off = np.linalg.norm(moved.positions - lesson_18.SYMMETRIC_ROOM.positions, axis=1)
    assert 0.002 < off.mean() < 0.06
    assert moved.labels == lesson_18.SYMMETRIC_ROOM.labels


def test_an_ellipse_has_its_long_axis_along_the_greater_variance():
    turn = np.deg2rad(30)
    along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    found = ellipse_of(np.zeros(2), 0.09 * np.outer(along, along) + 0.01 * np.outer(across, across), 2.0)
    assert (found["width"], found["height"]) == pytest.approx((0.4, 1.2))
    assert (found["angle"] + 90) % 180 == pytest.approx(30)


def test_stored_answers_are_the_rows_of_results():
    one_view = lesson_18.stored_answers()["one_view"]
    assert list(one_view) == ["greedy", "hungarian", "consistent"]
    assert lesson_18.shares_line("greedy", one_view["greedy"]).startswith(
        "greedy                 correct  67.8 (64.4 to"
    )


def test_the_figures_are_labelled(scene):
    arrays = scene_of(scene.observations, lesson_18.room_map())
    best = rank_poses(scene.observations, lesson_18.room_map())[0]
    curve = {"threshold": [0.9, 0.5], "coverage_percent": [10.0, 30.0], "risk_percent": [0.0, 7.0]}
    for figure in (
        lesson_18.matches_figure((scene, arrays), {"one": best, "the same": best}),
        lesson_18.few_seen_figure((scene, arrays), best.pose, best.covariance, best.pairs),
        lesson_18.risk_figure({"one": curve}, {"one": (10.0, 0.0)}),
    ):
        require_labels(figure)


def test_the_panel_says_when_no_pose_is_given_out():
    panel = hypotheses_panel()
    sure = panel.draw(**panel.defaults()).summary
    assert "12 of 12 objects matched, 0 of them wrongly" in sure
    assert "confidence of pose 1: 1.00" in sure
    unsure = panel.draw(**(panel.defaults() | {"photographs": "07_b", "hidden": 8})).summary
    assert "confidence of pose 1: 0.47" in unsure
    panel.press("Worse")
    assert panel.values()["rank"] == 2
    panel.press("Better")
    panel.press("Better")
    assert panel.values()["rank"] == 1


def test_the_examples_in_the_tasks_are_right():
    def solve(number, *given):
        return find_exercise(number).reference(*(np.array(one) for one in given))

    assert solve("18.1", [350.0], [30.0], [10.0], [45.0]) == pytest.approx([1.0])
    assert solve("18.2", [[1, 0], [3, 0]], [[2, 1], [2, 3]]) == pytest.approx((2, 0, np.pi / 2))
    assert solve("18.3", [[-5, -4], [-4, 3]]).tolist() == [1, 0]
    assert solve("18.3", [[-5, -1], [3, 2]]).tolist() == [0, -1]
    confidence, right = [0.9, 0.8, 0.8, 0.4, 0.0], [True, False, True, True, True]
    assert solve("18.4", confidence, right, 0.25) == pytest.approx(0.8)
    assert solve("18.4", confidence, right, 0.2) == pytest.approx(0.2)
