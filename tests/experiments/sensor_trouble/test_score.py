"""What is counted of troubled runs, on runs made up by hand."""

import pytest
from course_lib.experiments.sensor_trouble.score import (
    Gate,
    Usual,
    frames_to_judge,
    is_confident_wrong,
    summary,
    within,
)

GATE = Gate(0.3, 15.0)


def frame(outcome="tracked", metres=0.01, degrees=0.1):
    return {
        "outcome": outcome,
        "confident": outcome == "tracked",
        "position_m": metres,
        "rotation_deg": None if metres is None else degrees,
    }


def test_the_tenth_good_frame_after_each_trouble_is_judged():
    assert frames_to_judge([(5, 6)], 30) == [15]
    assert frames_to_judge([(5, 8)], 30) == [17]
    assert frames_to_judge([(5, 6), (10, 12)], 30) == [17, 21], "good frames are counted, whatever comes between"
    assert frames_to_judge([(25, 26)], 30) == [], "the recording ends before"


def test_wrong_is_what_was_given_out_and_lies_beyond_either_gate():
    assert not is_confident_wrong(frame(), GATE)
    assert is_confident_wrong(frame(metres=0.31), GATE)
    assert is_confident_wrong(frame(degrees=15.1), GATE)
    assert not is_confident_wrong(frame("lost", metres=3.0), GATE)
    assert not is_confident_wrong(frame("no image", metres=None), GATE)


def test_within_the_usual_needs_a_pose_and_both_errors():
    usual = Usual(0.1, 1.0)
    assert within(frame(), usual)
    assert not within(frame(metres=0.2), usual)
    assert not within(frame(degrees=1.1), usual)
    assert not within(frame("blank image", metres=None), usual)


def test_a_row_counts_outcomes_recovery_and_wrong_poses():
    calm = [frame(metres=0.01 * (k % 10)) for k in range(40)]
    bad = [dict(one) for one in calm]
    bad[5] = frame("repeated", metres=0.9)
    bad[20] = frame("tracked", metres=0.9)
    bad[15] = frame("doubtful", metres=0.5)
    result = {
        "undisturbed": calm,
        "troubles": [{"trouble": "repeated", "share": 0.05, "runs": [(5, 6), (20, 21)], "frames": bad}],
    }
    told = summary([result, result], GATE)
    assert told["usual"]["metres"] == pytest.approx(0.09)
    assert told["undisturbed"] == {
        "frames": 80,
        "good_frames": {"tracked": 80},
        "false_alarms": 0,
        "confident_wrong": 0,
    }
    assert told["rows"] == [
        {
            "trouble": "repeated",
            "share": 0.05,
            "frames": 80,
            "troubled": 4,
            "outcomes": {"repeated": 2, "tracked": 2},
            "good_frames": {"doubtful": 2, "tracked": 74},
            "judged": 4,
            "recovered": 2,
            "undisturbed": 4,
            "confident_wrong": 2,
        }
    ]


def test_a_good_frame_that_is_blamed_is_a_false_alarm():
    calm = [frame(), frame("half covered"), frame("doubtful"), frame("images of different moments", None)] * 10
    told = summary([{"undisturbed": calm, "troubles": []}], GATE)
    assert told["undisturbed"]["false_alarms"] == 20
