"""Project P2: the cost of a pose, the rivals on a practice room, and the record of a room."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from course_lib.spherical_stereo.detection.detected_object import Detection
from courseware.answers.project_2_task import PROJECT, measure, prepare
from courseware.lessons.kit.projects import AnswerError, one_outcome
from courseware.lessons.project_2.rooms import read_rooms, room_of
from courseware.simulation.room.look_alike_recording import RecordingModels
from tools.project_rooms import record_room


def test_a_pose_costs_its_error_here_and_a_metre_ahead_and_ours_is_nearer_than_the_paper():
    task = prepare(10_601)._replace(truth=np.tile([2.0, 3.0, 1.0], (5, 1)))
    result = measure(task, [(2, 3, 1 - 2 * np.pi), (2.3, 3.4, 1), (2, 3, 1.2), (9, 3, 1), None])
    assert result.value == pytest.approx((0 + 0.5 + np.sin(0.1) + 2 + 1) / 5)
    with pytest.raises(AnswerError, match="neither None nor three finite numbers"):
        measure(task, [(1.0, 2.0, np.nan)] * 5)
    paper, ours = (one_outcome(PROJECT, rival.function, 10_601).value for rival in PROJECT.rivals)
    assert 0 < ours < 0.15 < paper


@pytest.mark.slow
def test_a_room_is_seen_from_both_heights_and_reads_back():
    chair = Detection("chair", 0.9876, (250.12345, 60, 262, 80), 359.99999, 40)
    detector = SimpleNamespace(detect=lambda image: [chair, Detection("sofa", 0.9, (10, 60, 60, 80), np.nan, 4)])
    recorded = record_room(10_690, detector, 1, RecordingModels(width=256))
    view, other = read_rooms(json.dumps({"rooms": [recorded]}))[0].views
    assert view.pose == pytest.approx(other.pose, abs=0.05)
    assert (view.upper[0].box[0], view.upper[0].hue, view.upper[1].is_grey) == (250.1234, 0.0, True)


def test_the_rooms_of_the_score_are_not_among_those_that_students_get():
    assert len(PROJECT.prepare(PROJECT.seeds[0]).arguments) == 8
    with pytest.raises(ValueError, match="the practice rooms are 10601, 10602, 10603, 10604"):
        room_of(PROJECT.seeds[0])
