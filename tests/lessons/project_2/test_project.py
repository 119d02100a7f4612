"""Project P2's measure: what a pose costs, what an answer must be, and what the rivals make of a practice room."""

import numpy as np
import pytest

from course_lib.lessons.kit.projects import AnswerError, one_outcome
from course_lib.lessons.project_2 import boxes_figure, rooms_of
from course_lib.lessons.project_2.project import (
    MAX_COST,
    NO_ANSWER,
    PROJECT,
    Rig,
    measure,
    pose_cost,
    prepare,
    room_of,
)

TRUE = np.array([2.0, 3.0, 1.0])
PRACTICE = 10_601


def test_the_true_pose_costs_nothing_by_whole_turns_too():
    assert pose_cost((2.0, 3.0, 1.0), TRUE) == pytest.approx(0, abs=1e-12)
    assert pose_cost([2.0, 3.0, 1.0 - 2 * np.pi], TRUE) == pytest.approx(0, abs=1e-12)
    assert pose_cost(np.float32([2.0, 3.0, 1.0]), TRUE) == pytest.approx(0, abs=1e-6)


def test_a_place_costs_what_it_is_off_and_a_heading_what_a_metre_ahead_is_off():
    assert pose_cost((2.3, 3.4, 1.0), TRUE) == pytest.approx(0.5)
    assert pose_cost((2.0, 3.0, 1.2), TRUE) == pytest.approx(np.sin(0.1))
    assert pose_cost((9.0, 3.0, 1.0), TRUE) == MAX_COST
    assert pose_cost(None, TRUE) == NO_ANSWER


@pytest.mark.parametrize("answer", [(1.0, 2.0), (1.0, 2.0, np.nan), "here", (1, 2, 3, 4), ({},) * 3])
def test_what_is_no_pose_is_refused(answer):
    with pytest.raises(AnswerError, match="neither None nor three finite numbers"):
        pose_cost(answer, TRUE)


def test_a_room_is_the_mean_of_its_views():
    task = prepare(PRACTICE)._replace(truth=np.array([TRUE, TRUE, TRUE]))
    result = measure(task, [tuple(TRUE), None, (9.0, 9.0, 0.0)])
    assert result.value == pytest.approx((0 + NO_ANSWER + MAX_COST) / 3)
    assert result.remark == "1 correct, 1 wrong, 1 unable"


def test_a_task_is_all_views_of_a_room_and_never_the_truth():
    task = prepare(PRACTICE)
    assert task.truth.shape == (len(task.arguments), 3)
    upper, lower, semantic_map, rig = task.arguments[0]
    assert rig == Rig(0.3, 1280, 640)
    assert semantic_map is room_of(PRACTICE).semantic_map
    assert {type(one).__name__ for one in (*upper, *lower)} == {"Detection"}


def test_an_unknown_room_is_named_with_those_to_practise_on():
    with pytest.raises(ValueError, match="no room of seed 5; the practice rooms are 10601, 10602"):
        room_of(5)


def test_the_rivals_answer_and_ours_is_nearer():
    paper, ours = (one_outcome(PROJECT, rival.function, PRACTICE) for rival in PROJECT.rivals)
    assert not paper.failed
    assert 0 < ours.value < 0.15 < paper.value


def test_the_figure_shows_every_box_of_both_images():
    room = rooms_of("practice")[0]
    upper, lower, _ = boxes_figure(room, room.views[0]).axes
    assert len(upper.patches) >= len(room.views[0].upper)
    assert len(lower.patches) >= len(room.views[0].lower)
