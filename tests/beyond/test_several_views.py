"""Several views: what one view leaves open the next one closes, and odometry says which way."""

import numpy as np
import pytest

from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis
from course_lib.beyond.several_views import CarriedPose, Motion, SemanticTracker, carried_on, fused
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.outcomes import Reason
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from tests.beyond.look_alikes.look_alike_scene import PLANTED, POSE, SYMMETRIC, observed

SURE = np.diag([0.02, 0.02, 0.02]) ** 2


def motion(start, end, covariance=SURE):
    forward, left = rotation_2d(start[2]).T @ (end[:2] - start[:2])
    return Motion(forward, left, wrap_angle(end[2] - start[2]), covariance)


WALK = list(POSE + np.array([[0.0, 0.0, 0.0], [0.3, -0.1, 0.2], [0.5, 0.2, 0.3]]))


def near(pose, other):
    return np.hypot(*(np.array(pose)[:2] - other[:2])) < 0.1 and abs(wrap_angle(pose[2] - other[2])) < 0.05


def test_a_carried_pose_goes_where_the_rig_went_and_fusing_two_meets_in_the_middle_across_the_cut_of_the_circle():
    start = CarriedPose(np.array([1.0, 2.0, np.pi / 2]), np.zeros((3, 3)), 0.0, None)
    moved = carried_on(start, Motion(0.5, 0.1, 3.0, np.diag([0.1, 0.2, 0.3]) ** 2))
    np.testing.assert_allclose(moved.mean, [0.9, 2.5, np.pi / 2 + 3.0 - 2 * np.pi])
    np.testing.assert_allclose(np.diag(moved.covariance), [0.2**2, 0.1**2, 0.3**2])  # forward is north
    spread = np.diag([0.1, 0.1, 0.1]) ** 2
    carried = CarriedPose(np.array([0.0, 0.0, 3.1]), spread, 0.0, None)
    view = PoseHypothesis(Pose2D(0.2, 0.0, -3.1), spread, (), 4.0, 0.0, ())
    found = fused(carried, view, prior_log_density=0.0)
    np.testing.assert_allclose(found.mean[:2], [0.1, 0.0])
    assert abs(wrap_angle(found.mean[2] - np.pi)) < 1e-9
    np.testing.assert_allclose(found.covariance, spread / 2)
    further = fused(carried._replace(mean=np.array([-1.0, 0.0, 3.1])), view, prior_log_density=0.0)
    assert further.log_weight < found.log_weight - 10


def test_odometry_resolves_what_the_last_view_alone_or_two_objects_cannot():
    """The plant is seen in the first view only: what it told is carried to the last."""
    tracker, alone = SemanticTracker(PLANTED), SemanticTracker(PLANTED)
    tracker.step(observed(PLANTED, WALK[0]))
    tracker.step(observed(PLANTED, WALK[1], which=range(5)), motion(WALK[0], WALK[1]))
    track = tracker.step(observed(PLANTED, WALK[2], which=range(5)), motion(WALK[1], WALK[2]))
    unsure = alone.step(observed(PLANTED, WALK[2], which=range(5)))
    assert near(track.pose, WALK[2])
    assert unsure.confidence < 0.75 < track.confidence
    tracker, two = SemanticTracker(PLANTED), observed(PLANTED, WALK[1], which=(3, 5))
    tracker.step(observed(PLANTED, WALK[0]))
    assert near(tracker.step(two, motion(WALK[0], WALK[1])).pose, WALK[1])
    assert SemanticTracker(PLANTED).step(two).reason == Reason.TOO_FEW_AGREE


def test_a_rig_carried_away_is_found_again_nothing_makes_it_no_surer_and_a_symmetric_room_stays_two_rooms():
    tracker, elsewhere = SemanticTracker(PLANTED), np.array([0.9, 1.6, -2.0])  # no alternative of the first view's
    tracker.step(observed(PLANTED, POSE))
    for _ in range(2):
        track = tracker.step(observed(PLANTED, elsewhere), Motion(0.0, 0.0, 0.0, SURE))
    assert near(track.pose, elsewhere)
    tracker = SemanticTracker(PLANTED)
    first = tracker.step(observed(PLANTED, WALK[0]))
    second = tracker.step([], motion(WALK[0], WALK[1]))
    assert near(second.pose, WALK[1])
    assert np.trace(second.covariance) > np.trace(first.covariance)
    assert SemanticTracker(PLANTED).step([]).reason == Reason.NOTHING_AGREES
    tracker = SemanticTracker(SYMMETRIC)
    for start, end in zip([None, *WALK], WALK, strict=False):
        track = tracker.step(observed(SYMMETRIC, end), None if start is None else motion(start, end))
    assert (track.status, track.reason, track.pose) == ("unable", Reason.AMBIGUOUS, None)
    assert [share for _, share in track.alternatives[:2]] == pytest.approx([0.5, 0.5], abs=0.05)
    assert any(near(pose, WALK[-1]) for pose, _ in track.alternatives[:2])
