"""Whether a pose is known, from its image, its covariance and the frames before: causally, and never too sure."""

import itertools

import numpy as np
import pytest

from course_lib.beyond import being_lost
from course_lib.beyond.being_lost import NOTHING_MEASURED, Agreement, TrackJudge, agreement, judge_refined, judge_track
from course_lib.depth_mcl.likelihood import likelihood


def agreeing(share, through=0.0, pixels=1000):
    return Agreement(pixels, share, share, through)


MIDDLE = (being_lost.TRACKED_SUPPORT + being_lost.LOST_SUPPORT) / 2
VERY_GOOD, GOOD, MIDDLING, BAD = map(
    agreeing,
    (being_lost.RECOVERED_SUPPORT + 0.1, being_lost.TRACKED_SUPPORT + 0.1, MIDDLE, being_lost.LOST_SUPPORT - 0.15),
)
BLIND = NOTHING_MEASURED


def test_every_pixel_counts_for_what_it_is():
    """Ten measured pixels: five agree, two see through the map, one is in front of it, two meet a hole in it."""
    measured = np.array([[1, 1, 1, 1.05, 0.95, 2, 9, 0.5, 3, 3, np.nan, 0]], float)
    simulated = np.array([[1, 1, 1, 1, 1, 1, 1, 1, np.inf, np.inf, 1, 1]], float)
    found = agreement(measured, simulated)
    assert found.pixels == 10
    assert (found.agreeing, found.through) == pytest.approx((0.5, 0.2))
    assert found.support == pytest.approx(0.3)
    assert found.score == pytest.approx(likelihood(measured, simulated[None])[0] / 10)


@pytest.mark.parametrize(
    ("frames", "expected"),
    [
        ([GOOD] * 4, "TTTT"),
        ([MIDDLING] * 3, "DDD"),
        ([BAD] * 3, "LLL"),
        ([BLIND, GOOD, BLIND, GOOD], "DTDT"),
        ([GOOD, GOOD, GOOD, BAD, GOOD], "TTTDD"),  # one image alone does not decide: a person walked through
        ([BAD] * 3 + [GOOD] * 8, "LLLL" + "D" * 7),  # what was lost is not tracked for agreeing as well as usual
        ([BAD] * 3 + [VERY_GOOD] * 6 + [GOOD], "LLLDDDDTTT"),  # two frames until the mean is good, three good in a row
        ([BAD] * 3 + [BLIND] * 9 + [GOOD] * 3, "LLL" + "D" * 12),  # blind frames do not heal
        ([agreeing(1.0, pixels=3)] * 4 + [BAD], "DDDDL"),  # a few stray returns are no view
    ],
)
def test_the_papers_filter_is_judged_frame_by_frame_without_looking_ahead(frames, expected):
    for count in range(len(frames) + 1):
        assert "".join(status[0].upper() for status in judge_track(frames[:count])) == expected[:count]


def test_a_refined_pose_is_judged_by_its_own_image_and_is_doubtful_where_it_agrees_less_than_usual():
    assert {judge_refined(frame) for frame in (agreeing(0.9, 0.02), agreeing(0.6, 0.01))} == {"tracked"}
    assert {judge_refined(frame) for frame in (agreeing(0.72, 0.14), agreeing(0.35))} == {"lost"}, "through walls"
    assert {judge_refined(frame) for frame in (agreeing(0.0, 1.0, pixels=5), BLIND)} == {"doubtful"}
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
        covariance[axis, axis] = (share * being_lost.KNOWN[axis // 3]) ** 2
        assert told(FITS, covariance=covariance) == [status]


def test_doubtful_frames_end_a_loss_after_as_many_frames_as_it_had_but_are_never_called_tracked():
    after = told(FITS, *[BEHIND_THE_MAP] * 5, *[POOR] * 8)[6:]
    assert after == ["lost"] * 4 + ["doubtful"] * 4
    assert told(FITS, BEHIND_THE_MAP, *[POOR] * 3)[-3:] == ["lost", "lost", "doubtful"]
