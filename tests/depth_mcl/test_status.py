"""What a filter says of a pose: how its image agrees with the map, and the judge of the paper's filter."""

import numpy as np
import pytest

from course_lib.depth_mcl import status
from course_lib.depth_mcl.likelihood import likelihood
from course_lib.depth_mcl.status import NOTHING_MEASURED, Agreement, FilterJudge, agreement

SURE = np.diag([1e-4] * 6)


def agreeing(share, through=0.0, pixels=1000):
    return Agreement(pixels, share, share, through)


MIDDLE = (status.TRACKED_SUPPORT + status.LOST_SUPPORT) / 2
VERY_GOOD, GOOD, MIDDLING, BAD = map(
    agreeing,
    (status.RECOVERED_SUPPORT + 0.1, status.TRACKED_SUPPORT + 0.1, MIDDLE, status.LOST_SUPPORT - 0.15),
)
BLIND = NOTHING_MEASURED


def judged(frames, covariance=SURE, n_free=3):
    judge = FilterJudge(n_free)
    return [judge.judge(frame, covariance) for frame in frames]


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
        ([BLIND, GOOD, BLIND, GOOD], "NTNT"),
        ([GOOD, GOOD, GOOD, BAD, GOOD], "TTTDD"),  # one image alone does not decide: a person walked through
        ([BAD] * 3 + [GOOD] * 8, "LLLL" + "D" * 7),  # what was lost is not tracked for agreeing as well as usual
        ([BAD] * 3 + [VERY_GOOD] * 6 + [GOOD], "LLLDDDDTTT"),  # two frames until the mean is good, three good in a row
        ([BAD] * 3 + [BLIND] * 9 + [GOOD] * 3, "LLL" + "N" * 9 + "D" * 3),  # blind frames do not heal
        ([agreeing(1.0, pixels=3)] * 4 + [BAD], "DDDDL"),  # a few stray returns are no view
    ],
)
def test_the_papers_filter_is_judged_frame_by_frame_without_looking_ahead(frames, expected):
    for count in range(len(frames) + 1):
        assert "".join(one[0].upper() for one in judged(frames[:count])) == expected[:count]


@pytest.mark.parametrize(
    ("sigma", "n_free", "expected"), [(0.19, 3, "tracked"), (0.21, 3, "doubtful"), (0.09, 6, "doubtful")]
)
def test_a_good_image_of_a_pose_that_is_not_known_is_doubtful(sigma, n_free, expected):
    assert judged([VERY_GOOD], np.diag([sigma**2] * 3 + [1e-4] * 3), n_free) == [expected]
    assert judged([VERY_GOOD], SURE, n_free) == ["tracked"]


def test_with_more_than_three_components_the_frame_itself_must_agree_well():
    assert judged([VERY_GOOD, VERY_GOOD, GOOD], n_free=6) == ["tracked", "tracked", "doubtful"]
