"""Lesson 18: what a score is made of, a map in the mirror, poses that share the belief."""

import numpy as np
import pytest

from course_lib.beyond.look_alikes.evidence import detection_probabilities
from courseware.lessons.kit.room_data import room_map, room_scenes
from courseware.lessons.lesson_18 import scenes
from courseware.lessons.lesson_18.panel import MIRROR, PAIRS, ROOM, ranked, score_terms
from courseware.lessons.lesson_18.trials import answers_of


@pytest.mark.parametrize(("hidden", "map_name"), [(0, ROOM), (4, MIRROR), (8, ROOM)])
def test_the_terms_of_a_score_add_up_to_it(hidden, map_name):
    _, arrays, poses = ranked(PAIRS[0], map_name, hidden)
    for terms, sigmas, one in ((*score_terms(arrays, one), one) for one in poses):
        assert [sum(terms.values()), sum(sigmas**2)] == pytest.approx([one.score, one.chi_square])


def test_a_mirror_changes_no_distance_and_no_answer_in_it_is_right_or_sure():
    mirror = scenes.mirrored(room_map())
    apart = [np.linalg.norm(one.positions[:, None] - one.positions, axis=-1) for one in (room_map(), mirror)]
    assert np.allclose(*apart)
    found = answers_of(dict(list(room_scenes().items())[::4]), semantic_map=mirror)
    assert not any(one.best_is_right or one.confidence > 0.01 for one in found)


def test_from_the_wrong_end_the_plant_would_be_hidden():
    poses, views, _ = scenes.walk_past_the_plant(np.array([1.2, -0.7, 0.4]))
    assert [len(view) for view in views] == [5, 5, 6]
    assert np.diff(detection_probabilities(scenes.ROOM_WITH_PLANT, np.array([poses[1], -poses[1]]))[:, 5]) < -0.2
