"""Ambiguity of a room from its map alone: which objects are taken for which, and where."""

import numpy as np
import pytest

from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from courseware.experiments.ambiguity import ambiguity_map, imagined_observations
from tests.beyond.look_alikes.look_alike_scene import PLANTED, POSE, SYMMETRIC


def test_imagined_observations_lie_about_their_landmarks_as_their_covariances_say():
    rng, normalized = np.random.default_rng(1), []
    for _ in range(60):
        observations, shown = imagined_observations(PLANTED, POSE, rng)
        for one, landmark in zip(observations, shown, strict=True):
            true = rotation_2d(POSE[2]).T @ (PLANTED.positions[landmark] - POSE[:2])
            error = np.array([one.x, one.y]) - true
            normalized.append(error @ np.linalg.solve(one.covariance, error))
            assert one.label == PLANTED.labels[landmark]
    assert np.mean(normalized) == pytest.approx(2.0, rel=0.2)
    assert 3.5 < len(normalized) / 60 < 6


def test_a_symmetric_room_is_in_doubt_and_a_plant_lifts_it():
    symmetric, planted = (ambiguity_map(m, np.random.default_rng(0), 2.0, 2) for m in (SYMMETRIC, PLANTED))
    assert symmetric.confidence.mean() < 0.4
    assert planted.confidence.mean() > symmetric.confidence.mean() + 0.2
    (first, second, share), *_ = symmetric.most_confused()
    assert (first, second) in {(0, 1), (3, 4)}
    assert share > 0.3
    assert planted.most_confused(1)[0][2] < share


def test_the_greedy_matcher_confuses_where_the_consistent_one_does_not():
    found = [ambiguity_map(PLANTED, np.random.default_rng(0), 2.0, 3, one) for one in ("greedy", "consistent")]
    assert found[0].confused.sum() > 2 * found[1].confused.sum()


def test_only_where_a_rig_can_stand_is_asked():
    found = ambiguity_map(SYMMETRIC, np.random.default_rng(0), 1.0, 1)
    distances = np.linalg.norm(found.places[:, None] - SYMMETRIC.positions, axis=-1)
    assert distances.min() > 0.2
    assert (np.abs(found.places) < 3).all()
