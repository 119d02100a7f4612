"""Which frames are troubled, as many as asked and never touching; and what is counted of troubled runs."""

from itertools import pairwise

import numpy as np
import pytest

from courseware.experiments.troubled_frames import (
    LEFT_AT_THE_END,
    Gate,
    confident_wrong,
    frames_to_judge,
    generator,
    summary,
    troubled_frames,
    troubled_runs,
)

GATE = Gate(0.3, 15.0)


@pytest.mark.parametrize("share", [0.01, 0.05, 0.2])
@pytest.mark.parametrize(("n", "length"), [(100, 1), (100, 10), (304, 1), (304, 10)])
def test_stretches_make_up_the_share_and_do_not_touch(share, n, length):
    for seed in range(20):
        runs = troubled_runs(n, share, length, np.random.default_rng(seed))
        assert [end - first for first, end in runs] == [length] * max(1, round(share * n / length))
        assert all(first > before_end for (_, before_end), (first, _) in pairwise(runs))
        assert 1 <= runs[0][0] < runs[-1][1] <= n - LEFT_AT_THE_END
        assert troubled_frames(runs, n).sum() == len(runs) * length


def test_the_same_seed_has_the_same_places_and_each_trouble_its_own():
    def places(seed, name):
        return troubled_runs(304, 0.05, 1, generator(seed, name, 0.05))

    assert places(3, "black") == places(3, "black")
    assert places(3, "black") != places(3, "dropped")
    assert places(3, "black") != places(4, "black")


def frame(outcome="tracked", metres=0.01, degrees=0.1):
    degrees = None if metres is None else degrees
    return {"outcome": outcome, "confident": outcome == "tracked", "position_m": metres, "rotation_deg": degrees}


@pytest.mark.parametrize(
    ("runs", "judged"),
    [
        ([(5, 6)], [15]),
        ([(5, 8)], [17]),
        ([(5, 6), (10, 12)], [17, 21]),  # good frames are counted, whatever comes between
        ([(25, 26)], []),  # the recording ends before
    ],
)
def test_the_tenth_good_frame_after_each_trouble_is_judged(runs, judged):
    assert frames_to_judge(runs, 30) == judged


@pytest.mark.parametrize(
    ("one", "wrong"),
    [
        (frame(), 0),
        (frame(metres=0.31), 1),
        (frame(degrees=15.1), 1),
        (frame("lost", metres=3.0), 0),
        (frame("no image", metres=None), 0),
    ],
)
def test_wrong_is_what_was_given_out_and_lies_beyond_either_gate(one, wrong):
    assert confident_wrong([one], GATE) == wrong


def test_a_row_counts_outcomes_recovery_and_wrong_poses():
    calm = [frame(metres=0.01 * (k % 10)) for k in range(40)]
    bad = [dict(one) for one in calm]
    bad[5] = frame("repeated", metres=0.9)
    bad[20] = frame("tracked", metres=0.9)
    bad[15] = frame("doubtful", metres=0.5)
    trouble = {"trouble": "repeated", "share": 0.05, "runs": [(5, 6), (20, 21)], "frames": bad}
    told = summary([{"undisturbed": calm, "troubles": [trouble]}] * 2, GATE)
    assert told["usual"]["metres"] == pytest.approx(0.09)
    assert told["undisturbed"] == dict(frames=80, good_frames={"tracked": 80}, false_alarms=0, confident_wrong=0)
    (row,) = told["rows"]
    assert (row["trouble"], row["share"]) == ("repeated", 0.05)
    assert (row["outcomes"], row["good_frames"]) == ({"repeated": 2, "tracked": 2}, {"doubtful": 2, "tracked": 74})
    counted = ("frames", "troubled", "judged", "recovered", "undisturbed", "confident_wrong")
    assert [row[key] for key in counted] == [80, 4, 4, 2, 4, 2]
