"""What the filter thinks of its own track: from images alone, causally, and never too sure."""

import numpy as np
import pytest

from course_lib.beyond.being_lost import (
    LOST_SUPPORT,
    RECOVERED_SUPPORT,
    TRACKED_SUPPORT,
    Agreement,
    agreement,
    judge_refined,
    judge_track,
)
from course_lib.depth_mcl.likelihood import DepthImageError, likelihood

MIDDLE = (TRACKED_SUPPORT + LOST_SUPPORT) / 2
VERY_GOOD, GOOD, MIDDLING, BAD = (
    Agreement(100, support, support, 0.0)
    for support in (RECOVERED_SUPPORT + 0.1, TRACKED_SUPPORT + 0.1, MIDDLE, LOST_SUPPORT - 0.15)
)
BLIND = Agreement(0, np.nan, np.nan, np.nan)


def test_every_pixel_counts_for_what_it_is():
    """Ten measured pixels: five agree, two see through the map, one is in front of it, two meet a hole in it."""
    measured = np.array([[1, 1, 1, 1.05, 0.95, 2, 9, 0.5, 3, 3, np.nan, 0]], float)
    simulated = np.array([[1, 1, 1, 1, 1, 1, 1, 1, np.inf, np.inf, 1, 1]], float)
    found = agreement(measured, simulated)
    assert found.pixels == 10
    assert (found.agreeing, found.through) == pytest.approx((0.5, 0.2))
    assert found.support == pytest.approx(0.3)
    assert found.score == pytest.approx(likelihood(measured, simulated[None])[0] / 10)


def test_a_person_in_front_weighs_less_than_a_wall_that_is_not_there():
    wall = np.full((4, 5), 3.0)
    nearer, farther = wall.copy(), wall.copy()
    nearer[:2], farther[:2] = 1.0, 5.0
    assert agreement(nearer, wall).support == pytest.approx(0.5)
    assert agreement(farther, wall).support == pytest.approx(0.0)


def test_an_image_without_measurement_says_nothing():
    found = agreement(np.full((2, 3), np.nan), np.ones((2, 3)))
    assert found.pixels == 0
    assert np.isnan([found.score, found.agreeing, found.through, found.support]).all()


def test_images_that_do_not_fit_are_named():
    with pytest.raises(DepthImageError, match="shape"):
        agreement(np.ones((2, 3)), np.ones((3, 2)))


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
        ([Agreement(3, 1.0, 1.0, 0.0)] * 4 + [BAD], "DDDDL"),  # a few stray returns are no view
        ([], ""),
    ],
)
def test_a_run_is_judged_frame_by_frame(frames, expected):
    assert "".join(status[0].upper() for status in judge_track(frames)) == expected


def test_a_judgement_does_not_change_with_what_comes_after(rng):
    run = [Agreement(50, share, share, 0.0) for share in np.repeat(rng.uniform(0.2, 0.9, 10), 9)]
    statuses = judge_track(run)
    assert set(statuses) == {"tracked", "doubtful", "lost"}
    for count in (1, 7, 30):
        assert judge_track(run[:count]) == statuses[:count]


@pytest.mark.parametrize(
    ("agreeing", "through", "expected"),
    [(0.9, 0.02, "tracked"), (0.72, 0.14, "lost"), (0.6, 0.01, "tracked"), (0.35, 0.0, "lost")],
)
def test_a_refined_pose_that_still_sees_through_walls_is_lost(agreeing, through, expected):
    assert judge_refined(Agreement(1000, 0.6, agreeing, through)) == expected


def test_a_refined_pose_with_hardly_a_pixel_is_doubtful():
    assert judge_refined(Agreement(5, 0.1, 0.0, 1.0)) == judge_refined(BLIND) == "doubtful"
