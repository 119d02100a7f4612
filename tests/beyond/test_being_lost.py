"""The annealed filter's judge, from the image, the covariance and the frames before: causally, and never too sure."""

import itertools

import numpy as np

from course_lib.beyond import being_lost
from course_lib.beyond.being_lost import TrackJudge, judge_refined
from course_lib.depth_mcl.status import KNOWN, NOTHING_MEASURED
from tests.depth_mcl.test_status import agreeing


def test_a_refined_pose_is_judged_by_its_own_image_and_is_doubtful_where_it_agrees_less_than_usual():
    assert {judge_refined(frame) for frame in (agreeing(0.9, 0.02), agreeing(0.6, 0.01))} == {"tracked"}
    assert {judge_refined(frame) for frame in (agreeing(0.72, 0.14), agreeing(0.35))} == {"lost"}, "through walls"
    assert {judge_refined(frame) for frame in (agreeing(0.0, 1.0, pixels=5), NOTHING_MEASURED)} == {"doubtful"}
    assert told(FITS, agreeing(0.99 * being_lost.FALLEN * 0.95)) == ["tracked", "doubtful"]
    assert told(FITS, agreeing(1.01 * being_lost.FALLEN * 0.95)) == ["tracked", "tracked"]
    assert told(FITS, *[POOR] * 40) == ["tracked"] + ["doubtful"] * 40, "what is usual is learned from good frames only"


SURE = np.diag([1e-4] * 6)
FITS, BEHIND_THE_MAP, POOR = agreeing(0.95), agreeing(0.7, through=0.3), agreeing(0.75)


def told(*frames, covariance=SURE, rivals=()):
    """Statuses of frames; rivals: the numbers of those with a rival."""
    judge, statuses = TrackJudge(), []
    for number, frame in enumerate(frames):
        statuses.append(judge.judge(judge.judge_image(frame), frame, covariance, number in rivals))
    return statuses


def test_a_good_image_of_an_unknown_pose_is_lost_and_after_lost_frames_as_many_good_ones_are_wanted_but_three():
    assert told(FITS, BEHIND_THE_MAP, FITS) == ["tracked", "lost", "tracked"]
    assert told(FITS, *[BEHIND_THE_MAP] * 2, FITS, FITS)[-2:] == ["lost", "tracked"]
    long = told(FITS, *[BEHIND_THE_MAP] * 9, *[FITS] * being_lost.CONFIRMED)
    assert long[-being_lost.CONFIRMED :] == ["lost"] * (being_lost.CONFIRMED - 1) + ["tracked"]
    assert told(FITS, BEHIND_THE_MAP, POOR) == ["tracked", "lost", "lost"], "a doubtful frame is no good one"
    after = told(FITS, BEHIND_THE_MAP, FITS, FITS, FITS, rivals=(2, 3))
    assert after == ["tracked", "lost", "lost", "lost", "tracked"]
    assert told(FITS, FITS, rivals=(1,)) == ["tracked", "tracked"], "one that was never lost need not be confirmed"
    for axis, (share, status) in itertools.product(range(6), ((1.01, "lost"), (0.99, "tracked"))):
        covariance = SURE.copy()
        covariance[axis, axis] = (share * KNOWN[axis // 3]) ** 2
        assert told(FITS, covariance=covariance) == [status]


def test_doubtful_frames_end_a_loss_after_as_many_frames_as_it_had_but_are_never_called_tracked():
    after = told(FITS, *[BEHIND_THE_MAP] * 5, *[POOR] * 8)[6:]
    assert after == ["lost"] * 4 + ["doubtful"] * 4
    assert told(FITS, BEHIND_THE_MAP, *[POOR] * 3)[-3:] == ["lost", "lost", "doubtful"]
