"""Where the cloud is drawn: as far and as wide as the camera has been moving."""

import numpy as np
import pytest

from course_lib.beyond.six_dof import prediction as module
from course_lib.beyond.six_dof.poses import local, retract
from course_lib.beyond.six_dof.prediction import PRIOR_SHARE, MeasuredMotion, MotionPrediction, Rival
from course_lib.geometry import optical_pose

START = optical_pose(np.array([1.0, 2.0, 0.5, 0.1, 0.2, 0.3]))
STEP = np.array([0.03, 0.0, 0.1, 0.0, 0.05, 0.0])


def walked(n, step=STEP):
    prediction, pose = MotionPrediction(START), START
    prediction.found(pose)
    for _ in range(n):
        pose = retract(pose, step)
        prediction.found(pose)
    return prediction, pose


def test_the_cloud_is_as_wide_as_the_longest_of_the_last_motions_and_before_one_was_seen_as_for_a_start_by_hand():
    prediction = MotionPrediction(START)
    assert prediction.spread()[[0, 3]] == pytest.approx(module.START_SPREAD)
    prediction.found(retract(START, STEP))  # the start was off; that is no motion
    assert prediction.spread()[[0, 3]] == pytest.approx(module.START_SPREAD)
    assert not prediction.motion.any()
    prediction, pose = walked(5)
    prediction.found(retract(pose, 4 * STEP), seen=False)  # an image that leaves a direction open teaches no length
    prediction.found(pose, seen=False)
    assert prediction.spread()[0] == pytest.approx(module.SPREAD_OF_MOTION * np.hypot(0.03, 0.1))
    assert prediction.spread()[3] == pytest.approx(module.SPREAD_OF_MOTION * 0.05)
    pose = retract(pose, 3 * STEP)
    prediction.found(pose)
    for _ in range(2):
        assert prediction.spread()[0] == pytest.approx(3 * module.SPREAD_OF_MOTION * np.hypot(0.03, 0.1))
        pose = retract(pose, STEP)
        prediction.found(pose)
    for _ in range(3):
        prediction.found(pose)
    assert prediction.spread()[[0, 3]] == pytest.approx(module.MIN_SPREAD)
    assert walked(3, 50 * STEP)[0].spread()[0] == module.MAX_SPREAD[0]


def test_particles_lie_about_the_motion_an_odometer_is_believed_but_for_a_share_and_predictions_decide_ties(rng):
    prediction, pose = walked(3)
    particles = prediction.draw(4000, np.full(6, 1e-6), rng)
    assert particles[0] == pytest.approx(pose, abs=1e-12)
    assert particles[1] == pytest.approx(retract(pose, STEP), abs=1e-9)
    shares = local(pose, particles)[:, 2] / STEP[2]
    assert shares.min() == pytest.approx(-0.25, abs=0.01)
    assert shares.max() == pytest.approx(1.25, abs=0.01)
    assert np.mean(shares) == pytest.approx(0.5, abs=0.03)
    increment = np.array([0.2, 0.0, 0.0, 0.0, 0.0, 0.4])
    odometer = MeasuredMotion.of_odometer(increment)
    assert prediction.spread(odometer)[[0, 3]] == pytest.approx(module.SPREAD_OF_INCREMENT * np.array([0.2, 0.4]))
    particles = prediction.draw(800, np.full(6, 1e-6), rng, odometer)
    there = np.abs(local(retract(pose, increment), particles)).max(axis=1) < 1e-4
    assert there.mean() == pytest.approx(1 - 1 / module.UNMEASURED)
    as_before = local(pose, particles[~there])
    assert np.abs(np.median(as_before, axis=0)).max() < 0.1
    assert as_before.std(axis=0)[[0, 3]] == pytest.approx(prediction.spread()[[0, 3]], rel=0.6)
    spread = np.full(6, 0.1)
    on_the_way = retract(pose, STEP * np.array([[0.0], [0.5], [1.0]]))
    assert prediction.preference(on_the_way, spread) == pytest.approx(np.zeros(3), abs=1e-9)
    beyond = retract(retract(pose, STEP), np.array([0.0, 0.2, 0.0, 0.0, 0.0, 0.0]))
    assert prediction.preference(beyond[None], spread) == pytest.approx([-2.0 * PRIOR_SHARE], rel=0.02)
    assert prediction.preference(pose[None], spread, MeasuredMotion(STEP, np.eye(6)))[0] < -0.5 * PRIOR_SHARE, (
        "an odometer says how far it went"
    )
    far = retract(pose, 100 * STEP)[None]
    assert prediction.preference(far, spread, odometer) == pytest.approx([-module.MEASURED_SHARE * module.FARTHEST / 2])
    prediction.not_found(beyond, spread)
    assert prediction.preference(np.array([pose, beyond]), spread) == pytest.approx([0.0, 0.0], abs=1e-9)


def test_where_it_was_not_found_or_has_rivals_the_cloud_starts_from_either_place(rng):
    prediction, pose = walked(3)
    doubted, spread = retract(pose, np.array([2.0, 0, 0, 0, 0, 0])), prediction.spread()
    prediction.not_found(doubted, spread)
    assert prediction.spread()[[0, 3]] == pytest.approx(module.GROWTH * spread[[0, 3]])
    along = local(pose, prediction.draw(1000, np.full(6, 1e-3), rng))[:, 0]
    assert (along > 1.0).mean() == pytest.approx(0.5, abs=0.01)
    prediction.found(doubted)
    assert not prediction.rivals
    prediction, pose = walked(3)
    there, rival = retract(pose, STEP), retract(pose, np.array([3.0, 0, 0, 0, 0, 0]))
    prediction.found(there, rivals=[Rival(rival, -0.01)])
    along = local(pose, prediction.draw(1000, np.full(6, 1e-3), rng))[:, 0]
    assert (along > 1.5).mean() == pytest.approx(0.5, abs=0.01)
    assert prediction.spread(MeasuredMotion.of_odometer(10 * STEP))[0] == pytest.approx(
        10 * module.SPREAD_OF_INCREMENT * np.hypot(0.03, 0.1)
    )
    preferred = prediction.preference(np.array([rival]), np.full(6, 0.1))
    assert preferred == pytest.approx([-0.01 * module.CARRIED], abs=1e-9)
    arrived = retract(rival, STEP)
    before, predicted = prediction.origin(arrived, np.full(6, 0.1))
    assert before == pytest.approx(rival)
    assert predicted == pytest.approx(arrived, abs=1e-9)
    prediction.found(arrived)
    assert prediction.motion == pytest.approx(STEP, abs=1e-9)
    prediction.not_found(rival, spread, measured=MeasuredMotion(STEP, np.eye(6)))
    assert prediction.pose == pytest.approx(retract(arrived, STEP)), "the last pose moves on as measured"
