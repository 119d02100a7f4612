"""Each kind of evidence alone: places, colours, what should be seen and is not, where a rig can stand."""

import numpy as np
import pytest

from course_lib.beyond.look_alikes.evidence import (
    DETECTION_HIDDEN,
    NOISE_FACTOR,
    OUTSIDE_COST,
    colour_costs,
    detection_probabilities,
    free_space_costs,
    place_distances,
)
from course_lib.beyond.look_alikes.hypotheses import MAP_SIGMA, scene_of
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from tests.beyond.look_alikes.look_alike_scene import PLANTED, POSE, SYMMETRIC, observed


def colour_cost(seen, mapped):
    semantic_map = SemanticMap([Landmark("sofa", 0.0, 0.0, *mapped)])
    return float(colour_costs(scene_of([Observation("sofa", 1.0, 0.0, *seen)], semantic_map))[0, 0])


def test_distances_are_in_standard_deviations_an_uncertain_pose_forgives_and_hue_is_a_circle_of_less_meaning_if_pale():
    """One metre ahead, seen with heading north: the covariance's long axis turns with the rig."""
    semantic_map = SemanticMap([Landmark("sofa", 0.0, 1.0, 0.0, 50.0)])
    covariance = np.diag([0.3, 0.1]) ** 2
    pose = np.array([[0.0, 0.0, np.pi / 2]])
    for shift, sigma in (((0.0, 0.2), 0.3), ((0.2, 0.0), 0.1)):
        moved = pose + np.array([[*shift, 0.0]])
        scene = scene_of([Observation("sofa", 1.0, 0.0, 0.0, 50.0, covariance)], semantic_map)
        squared, log_size = place_distances(scene, moved)
        assert squared[0, 0, 0] == pytest.approx(0.2**2 / ((NOISE_FACTOR * sigma) ** 2 + MAP_SIGMA**2))
    size = np.prod((NOISE_FACTOR * np.array([0.3, 0.1])) ** 2 + MAP_SIGMA**2)
    assert log_size[0, 0] == pytest.approx(np.log(size))
    scene = scene_of(observed(PLANTED, POSE), PLANTED)
    wrong = POSE[None] + [[0.3, 0.0, 0.1]]
    exact, _ = place_distances(scene, wrong)
    forgiving, _ = place_distances(scene, wrong, np.diag([0.3, 0.3, 0.1])[None] ** 2)
    assert (np.diagonal(forgiving[0]) < 0.5 * np.diagonal(exact[0])).all()
    assert colour_cost((355.0, 60.0), (5.0, 60.0)) == pytest.approx(colour_cost((100.0, 60.0), (110.0, 60.0)))
    costs = [colour_cost((0.0, s), (40.0, s)) for s in (15.0, 30.0, 45.0)]
    assert costs[0] < 0.5 * costs[1] < 0.5 * costs[2]


def test_the_chance_of_detection_falls_with_distance_and_behind_another_and_no_rig_stands_in_a_sofa_or_behind_a_wall():
    semantic_map = SemanticMap([Landmark("sofa", 2.0, 0.0, 0, 50), Landmark("plant", 4.0, 0.1, 0, 50)])
    poses = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [-9.0, 0.0, 0.0]])
    from_west, from_north, from_afar = detection_probabilities(semantic_map, poses, max_range=8.0)
    assert from_west[0] > 0.8
    assert from_west[1] <= DETECTION_HIDDEN
    assert from_west[0] > from_north[0] > 0.6
    assert from_north[1] > 0.6
    assert (from_afar == 0.0).all()
    poses = np.array([[1.2, -0.7, 0.0], [0.05, 0.05, 0.0], [3.5, 0.0, 0.0]])
    np.testing.assert_array_equal(free_space_costs(SYMMETRIC, poses), [0.0, OUTSIDE_COST, OUTSIDE_COST])
