"""Whether a pose is known, from its image, its covariance and the frames before."""

import numpy as np
import pytest
from course_lib.beyond.six_dof.certainty import CONFIRMED, FALLEN, KNOWN, Certainty

from course_lib.beyond.being_lost import Agreement

SURE = np.diag([1e-4] * 6)


def agreeing(share, through=0.0, pixels=1000):
    return Agreement(pixels, share, share, through)


GOOD, BEHIND_THE_MAP = agreeing(0.95), agreeing(0.7, through=0.3)


def told(*frames):
    """Statuses of frames, each an agreement and, where they matter, a covariance and whether there are rivals."""
    certainty, statuses = Certainty(), []
    for frame in frames:
        agreement, covariance, rivals = (
            (*frame, SURE, False)[:3] if isinstance(frame[0], tuple) else (frame, SURE, False)
        )
        statuses.append(certainty.judge(certainty.judge_image(agreement), agreement, covariance, rivals))
    return statuses


def wide(axis, sigma):
    covariance = SURE.copy()
    covariance[axis, axis] = sigma**2
    return covariance


def test_an_image_that_cannot_be_right_is_lost_and_one_that_agrees_less_than_usual_doubtful():
    assert told(GOOD, BEHIND_THE_MAP) == ["tracked", "lost"]
    assert told(GOOD, agreeing(0.99 * FALLEN * 0.95)) == ["tracked", "doubtful"]
    assert told(GOOD, agreeing(1.01 * FALLEN * 0.95)) == ["tracked", "tracked"]


@pytest.mark.parametrize("axis", range(6))
def test_a_good_image_of_a_pose_that_is_not_known_is_lost(axis):
    limit = KNOWN[axis // 3]
    assert told((GOOD, wide(axis, 1.01 * limit))) == ["lost"]
    assert told((GOOD, wide(axis, 0.99 * limit))) == ["tracked"]


def test_after_lost_frames_as_many_good_ones_are_wanted_but_no_more_than_three():
    assert told(GOOD, BEHIND_THE_MAP, GOOD) == ["tracked", "lost", "tracked"]
    assert told(GOOD, *[BEHIND_THE_MAP] * 2, GOOD, GOOD)[-2:] == ["lost", "tracked"]
    assert told(GOOD, *[BEHIND_THE_MAP] * 9, *[GOOD] * CONFIRMED)[-CONFIRMED:] == ["lost"] * (CONFIRMED - 1) + [
        "tracked"
    ]


def test_a_good_frame_with_a_rival_confirms_nothing():
    after = told(GOOD, BEHIND_THE_MAP, (GOOD, SURE, True), (GOOD, SURE, True), GOOD)
    assert after == ["tracked", "lost", "lost", "lost", "tracked"]
    assert told(GOOD, (GOOD, SURE, True)) == ["tracked", "tracked"], "one that was never lost need not be confirmed"


def test_what_is_usual_is_learned_from_good_frames_only():
    poor = agreeing(0.7)
    assert told(GOOD, *[poor] * 40) == ["tracked"] + ["doubtful"] * 40


def test_a_doubtful_frame_after_a_lost_one_is_still_lost():
    assert told(GOOD, BEHIND_THE_MAP, agreeing(0.75)) == ["tracked", "lost", "lost"]
