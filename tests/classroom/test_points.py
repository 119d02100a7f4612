"""Points of an answer: all, half or none."""

import pytest

from courseware.classroom.points import POINTS, earned


@pytest.mark.parametrize(("right", "share"), [
    ([True] * 4, 1), ([True, True, False, False], 0.5), ([True, False, False, False], 0), ([False] * 4, 0),
    ([True] * 25 + [False], 0.5),
])  # fmt: skip
def test_all_right_earns_all_half_right_earns_half(right, share):
    assert [earned(points, right) for points in POINTS.values()] == [share * points for points in POINTS.values()]
