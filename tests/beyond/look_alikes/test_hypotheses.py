"""Poses of two matches: which pairs can both be right, and where they put the rig."""

import numpy as np

from course_lib.beyond.look_alikes.hypotheses import fit_poses, pair_poses, pairs_of_matches, scene_of
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.semantic_map.association import Observation
from tests.beyond.look_alikes.look_alike_scene import PLANTED, POSE, observed


def test_pairs_join_like_classes_to_distinct_landmarks_at_compatible_distances_and_the_right_ones_give_the_pose():
    observations = observed(PLANTED, POSE)
    scene = scene_of(observations, PLANTED)
    seen, on_map = pairs_of_matches(scene)
    assert (seen[:, 0] < seen[:, 1]).all()
    assert (on_map[:, 0] != on_map[:, 1]).all()
    for k in range(2):
        assert all(PLANTED.labels[j] == observations[i].label for i, j in zip(seen[:, k], on_map[:, k], strict=True))
    narrow, _ = pairs_of_matches(scene, gate=0.1)
    assert 0 < len(narrow) < len(seen)
    observations = [Observation("sofa", 1.0, 0.0, 0.0, 50.0), Observation("sofa", 1.2, 0.0, 0.0, 50.0)]
    assert len(pairs_of_matches(scene_of(observations, PLANTED))[0]) == 0
    found = pair_poses(scene)
    right = (found.observations == found.landmarks).all(axis=1)
    np.testing.assert_allclose(found.poses[right], np.tile(POSE, (15, 1)), atol=1e-6)
    assert len(found.poses) > 15, "look-alikes give wrong pairs too"
    rng = np.random.default_rng(3)
    errors = []
    for _ in range(300):
        scene = scene_of(observed(PLANTED, POSE, rng=rng), PLANTED)
        fitted, spread = fit_poses(POSE, scene.places[None], PLANTED.positions[None], scene.covariances[None])
        error = fitted[0] - POSE
        error[2] = wrap_angle(error[2])
        errors.append(error @ np.linalg.solve(spread[0], error))
    assert 2.2 < np.mean(errors) < 3.5  # three numbers; the map's 2 cm are told and not drawn
