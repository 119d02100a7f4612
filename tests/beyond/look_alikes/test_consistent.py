"""Rooms that look alike: right where something tells them apart, "unable" with the alternatives where nothing does."""

from functools import partial

import numpy as np
import pytest

from course_lib.beyond.look_alikes import consistent
from course_lib.beyond.look_alikes.confidence import MIN_CONFIDENCE
from course_lib.beyond.look_alikes.consistent import associate_consistent, distinct, rank_poses
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.matchers import associate_hungarian
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from tests.beyond.look_alikes.look_alike_scene import OTHER_POSE, PLANTED, POSE, SYMMETRIC, observed, scattered, turned


def localizer(semantic_map, **options):
    return SemanticLocalizer(StereoRig(0.3), semantic_map, association=partial(associate_consistent, **options))


def near(pose, other, metres=0.05, radians=0.02):
    return np.hypot(*(np.array(pose)[:2] - other[:2])) < metres and abs(wrap_angle(pose[2] - other[2])) < radians


def test_three_sofas_in_a_symmetric_room_have_two_poses_and_no_answer():
    found = localizer(SYMMETRIC).localize_observations(observed(SYMMETRIC, POSE))
    assert (found.status, found.reason, found.pose) == ("unable", Reason.AMBIGUOUS, None)
    for place in (POSE, OTHER_POSE):
        assert [near(one.pose, place) for one in found.alternatives[:2]].count(True) == 1
    assert [one.share for one in found.alternatives[:2]] == pytest.approx([0.5, 0.5], abs=0.02)
    assert "50%" in found.explanation


def test_one_plant_tells_the_two_apart_a_false_observation_is_left_unmatched_and_two_matches_are_never_enough():
    found = localizer(PLANTED).localize_observations(observed(PLANTED, POSE))
    assert near(found.pose, POSE)
    assert found.used_pairs == tuple((k, k) for k in range(6))
    assert found.confidence > MIN_CONFIDENCE
    assert found.rms_residual < 0.01
    assert np.array_equal(found.covariance, found.alternatives[0].covariance)
    seen = observed(PLANTED, POSE)
    false = seen[0]._replace(x=seen[0].x + 1.4, y=seen[0].y - 1.0)
    found = localizer(PLANTED).localize_observations([false, *seen])
    assert near(found.pose, POSE)
    assert found.used_pairs == tuple((k + 1, k) for k in range(6))
    assert found.association.unassigned == (0,)
    found = localizer(PLANTED).localize_observations(observed(PLANTED, POSE, which=(3, 5)))
    assert (found.status, found.reason) == ("unable", Reason.TOO_FEW_AGREE)
    assert found.alternatives


def test_a_plant_that_should_be_seen_and_is_not_tells_too_but_only_as_negative_evidence():
    """From POSE the plant would be in plain sight, from OTHER_POSE it is behind the middle sofa."""
    hidden = (*SYMMETRIC.landmarks, Landmark("potted plant", 2.0, -0.5, 120.0, 50.0))
    hidden = SemanticMap(hidden, SYMMETRIC.walls)
    at_other = observed(hidden, OTHER_POSE, which=range(5))
    with_negative, without = (rank_poses(at_other, hidden, Evidence(negative=value)) for value in (True, False))
    assert near(with_negative[0].pose, OTHER_POSE)
    assert with_negative[0].share > without[0].share + 0.2
    assert with_negative[1].missed == (5,)


def test_the_room_in_a_mirror_is_refused_however_far_ahead_its_best_pose_is():
    """Wrong poses with large gaps: by the gap alone one is sure of a pose that no rotation makes right."""
    room = scattered(np.random.default_rng(6))
    seen = observed(room, np.array([0.5, 0.3, 1.0]))
    flip = np.array([[1.0, -1.0], [-1.0, 1.0]])
    mirrored = [one._replace(y=-one.y, covariance=flip * one.covariance) for one in seen]
    assert localizer(room).localize_observations(seen).status == "ok"
    assert associate_consistent(mirrored, room, evidence=Evidence(absolute=False)).confidence > MIN_CONFIDENCE
    found = localizer(room).localize_observations(mirrored)
    assert (found.status, found.reason) == ("unable", Reason.AMBIGUOUS)


@pytest.mark.parametrize("angle", [np.pi / 2, -2.5])
def test_another_world_frame_changes_nothing_but_the_frame(angle):
    seen, shift = observed(PLANTED, POSE, rng=np.random.default_rng(6)), np.array([7.0, -3.0])
    here, there = rank_poses(seen, PLANTED)[0], rank_poses(seen, turned(PLANTED, angle, shift))[0]
    moved = consistent.Pose2D(0.0, 0.0, angle).apply(np.array(here.pose)[:2]) + shift
    np.testing.assert_allclose(np.array(there.pose)[:2], moved, atol=1e-5)
    assert wrap_angle(there.pose.theta - here.pose.theta - angle) == pytest.approx(0.0, abs=1e-6)
    assert there.score == pytest.approx(here.score, abs=1e-5)
    assert there.pairs == here.pairs


def test_poses_within_half_a_metre_and_ten_degrees_are_one_answer_and_a_refit_is_better_than_the_pose_of_two():
    poses = np.array([[0, 0, 3.1], [0.3, 0, -3.1], [0, 0.6, 3.1], [0, 0, 2.8]])
    assert distinct(poses, np.array([1.0, 2.0, 0.5, 0.2]), 9) == [1, 2, 3]
    assert distinct(poses, np.array([1.0, 2.0, 0.5, 0.2]), 2) == [1, 2]
    rng = np.random.default_rng(8)
    errors = {True: [], False: []}
    for _ in range(15):
        seen = observed(PLANTED, POSE, rng=rng)
        for refit in errors:
            best = rank_poses(seen, PLANTED, Evidence(refit=refit))[0]
            errors[refit].append(np.hypot(*(np.array(best.pose)[:2] - POSE[:2])))
    assert np.mean(errors[True]) < 0.8 * np.mean(errors[False])


def test_the_hungarian_total_is_least_where_the_greedy_search_pays_for_its_first_choice_and_places_do_not_matter():
    """The first observation likes landmark 0 best, but the second has nothing else as good."""
    plain = SemanticMap(
        [Landmark("sofa", 0, 0, 10, 50), Landmark("sofa", 5, 0, 30, 50), Landmark("plant", 2, 3, 120, 40)]
    )
    seen = [Observation("sofa", 1, 0, 19, 50), Observation("sofa", 0, 1, 1, 50), Observation("plant", 1, 1, 120, 40)]
    assert associate_hungarian(seen, plain).pairs == ((0, 1), (1, 0), (2, 2))
    assert associate_hungarian([one._replace(x=9 * one.x) for one in seen], plain).pairs == ((0, 1), (1, 0), (2, 2))
    four = associate_hungarian([Observation("sofa", k, 0, 10 + 5 * k, 50) for k in range(4)], plain)
    assert (len(four.pairs), len(four.unassigned), sorted(four.same_class)) == (3, 1, [False, True, True])
