"""Lesson 18: what a score is made of, a map in the mirror, poses that share the belief."""

import numpy as np
import pytest

from course_lib.beyond import rank_poses
from course_lib.beyond.look_alikes.confidence import confidence_of
from course_lib.beyond.look_alikes.evidence import detection_probabilities
from course_lib.lessons.lesson_18 import room_map, room_scenes, scenes
from course_lib.lessons.lesson_18.figures import at_threshold
from course_lib.lessons.lesson_18.panel import MAX_HIDDEN, MIRROR, PAIRS, ROOM, ranked, score_terms
from course_lib.lessons.lesson_18.trials import answers_of


@pytest.mark.parametrize(("hidden", "map_name"), [(0, ROOM), (4, MIRROR), (MAX_HIDDEN, ROOM)])
def test_the_terms_of_a_score_add_up_to_it(hidden, map_name):
    for photographs in PAIRS:
        _, arrays, poses = ranked(photographs, map_name, hidden)
        for one in poses:
            terms, sigmas = score_terms(arrays, one)
            assert sum(terms.values()) == pytest.approx(one.score)
            assert sum(sigmas**2) == pytest.approx(one.chi_square)


def test_a_mirror_changes_no_distance_and_leaves_no_pose_right():
    mirror = scenes.mirrored(room_map())
    apart = [np.linalg.norm(one.positions[:, None] - one.positions, axis=-1) for one in (room_map(), mirror)]
    assert np.allclose(*apart)
    some = dict(list(room_scenes().items())[::4])
    assert not any(one.best_is_right for one in answers_of(some, semantic_map=mirror))
    assert all(confidence_of(rank_poses(scene.observations, mirror)[0]) < 0.01 for scene in some.values())


def test_from_the_wrong_end_the_plant_would_be_hidden():
    poses, views, _ = scenes.walk_past_the_plant(np.array([1.2, -0.7, 0.4]))
    assert [len(view) for view in views] == [5, 5, 6]
    ends = np.array([poses[1], -poses[1]])
    assert np.diff(detection_probabilities(scenes.ROOM_WITH_PLANT, ends)[:, 5]) < -0.2


def test_a_threshold_that_nothing_reaches_answers_nothing():
    curve = {"threshold": [0.9, 0.8, 0.5], "coverage_percent": [10.0, 20.0, 30.0], "risk_percent": [0.0, 5.0, 7.0]}
    assert [at_threshold(curve, one) for one in (0.95, 0.8, 0.1)] == [(0.0, 0.0), (20.0, 5.0), (30.0, 7.0)]
