"""Project P3's measure: points of a pose, pairs that are none, thinned views, and the rivals on a practice room."""

import numpy as np
import pytest

from course_lib.lessons.kit.projects import AnswerError, one_outcome
from course_lib.lessons.project_3 import prepare, rooms_of, view_figure
from course_lib.lessons.project_3.project import (
    DRAWS,
    PROJECT,
    WRONG_POINTS,
    checked_pairs,
    measure,
    points_of,
    pose_of,
)
from course_lib.spherical_stereo import Pose2D

TRUE = np.array([2.0, 3.0, 1.0])
PRACTICE = 10_601


@pytest.mark.parametrize(
    ("pose", "points"),
    [
        (Pose2D(2.0, 3.0, 1.0), 100),
        (Pose2D(2.2, 3.0, 1.0), 80),
        (Pose2D(2.6, 3.0, 1.0), WRONG_POINTS),
        (Pose2D(2.0, 3.0, 1.2), WRONG_POINTS),
        (Pose2D(2.0, 3.0, 1.1), 100),
        (None, WRONG_POINTS),
    ],
)
def test_a_right_pose_earns_by_the_centimetre_and_a_wrong_one_costs(pose, points):
    assert points_of(pose, TRUE) == pytest.approx(points)


def test_pairs_in_any_dress_and_none_for_what_fixes_no_pose():
    assert checked_pairs(np.array([[0, 2], [1, 0]]), 2, 3) == [(0, 2), (1, 0)]
    assert checked_pairs(((0, 2), (1, 0)), 2, 3) == [(0, 2), (1, 0)]
    assert checked_pairs(None, 2, 3) is checked_pairs([], 2, 3) is checked_pairs([(0, 1)], 2, 3) is None


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (3, "neither None nor a list"),
        ([1, 2], "neither None nor a list"),
        ([(0, 1), (0, 2)], "one observation twice"),
        ([(0, 1), (1, 1)], "one landmark twice"),
        ([(0, 1), (2, 2)], "an observation that there is not: 2, of 2"),
        ([(0, 3), (1, 2)], "a landmark that there is not: 3, of 3"),
        ([(0, -1), (1, 2)], "a landmark that there is not: -1"),
    ],
)
def test_pairs_that_are_none_are_refused(answer, words):
    with pytest.raises(AnswerError, match=words):
        checked_pairs(answer, 2, 3)


def test_a_room_is_thinned_three_times_a_view_and_always_alike():
    (room, *_), task = rooms_of("practice"), prepare(PRACTICE)
    assert len(task.arguments) == DRAWS * len(room.views) == len(task.truth)
    kept = sum(len(observations) for observations, _ in task.arguments)
    assert kept / (DRAWS * sum(len(view.observations) for view in room.views)) == pytest.approx(0.5, abs=0.1)
    again = prepare(PRACTICE)
    assert [len(one[0]) for one in again.arguments] == [len(one[0]) for one in task.arguments]


def test_the_points_of_a_room_are_the_mean_of_its_tasks():
    (room, *_) = rooms_of("practice")
    view = room.views[0]
    truth = [(i, j) for i, j in enumerate(view.shows) if j >= 0]
    pose = np.array(pose_of(truth, view.observations, room.semantic_map))
    task = prepare(PRACTICE)._replace(
        arguments=((view.observations, room.semantic_map),) * 3, truth=np.array([pose, pose, pose])
    )
    swapped = [(truth[0][0], truth[1][1]), (truth[1][0], truth[0][1]), *truth[2:]]
    result = measure(task, [truth, None, swapped])
    assert result.value == pytest.approx((100 + 0 + WRONG_POINTS) / 3)
    assert result.remark == "2 of 3 answered, 1 of them wrong"


def test_of_the_rivals_only_ours_is_above_nothing():
    paper, other, ours = (one_outcome(PROJECT, rival.function, PRACTICE).value for rival in PROJECT.rivals)
    assert max(paper, other) < 0 < ours


def test_the_figure_draws_an_ellipse_for_each_observation():
    observations, semantic_map = prepare(PRACTICE).arguments[0]
    body, _ = view_figure(observations, semantic_map).axes
    assert len(body.patches) == len(observations)
