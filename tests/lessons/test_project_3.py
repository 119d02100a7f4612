"""Project P3: the points of pairs, pairs that are refused, thinned views, and the rivals on a practice room."""

import numpy as np
import pytest

from courseware.answers.project_3_task import PROJECT, checked_pairs, measure, points_of
from courseware.lessons.kit.projects import AnswerError, one_outcome
from courseware.lessons.project_2.rooms import room_of
from courseware.lessons.project_3.tasks import DRAWS, prepare

BAD = {"neither None": 3, "observation twice": [(0, 1), (0, 2)], "landmark twice": [(0, 1), (1, 1)]}
BAD |= {"not: 2, of 2": [(0, 1), (2, 2)], "not: 3, of 3": [(0, 3), (1, 2)], "not: -1": [(0, -1), (1, 2)]}


@pytest.mark.parametrize("words", BAD)
def test_pairs_that_are_none_are_refused(words):
    with pytest.raises(AnswerError, match=words):
        checked_pairs(BAD[words], (2, 3))


def test_right_pairs_earn_by_the_centimetre_and_wrong_ones_cost():
    room, task = room_of(10_601), prepare(10_601)
    seen, right = room.views[0].observations, [(i, j) for i, j in enumerate(room.views[0].shows) if j >= 0]
    points = [points_of(right, seen, room.semantic_map, room.views[0].pose + np.array([d, 0, 0])) for d in (0.1, 0.2)]
    assert 100 > max(points) > min(points) > 80
    wrong = [(right[0][0], right[1][1]), (right[1][0], right[0][1]), *right[2:]]
    given = [(seen, room.semantic_map)] * 4
    result = measure(task._replace(arguments=given, truth=[room.views[0].pose] * 4), [right, None, wrong, right[:1]])
    assert (result.remark, result.value < -50) == ("2 of 4 answered, 1 of them wrong", True)
    assert len(task.arguments) == DRAWS * len(room.views) == len(task.truth)
    paper, other, ours = (one_outcome(PROJECT, rival.function, 10_601).value for rival in PROJECT.rivals)
    assert max(paper, other) < 0 < ours
