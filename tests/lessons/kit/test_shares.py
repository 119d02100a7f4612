"""A share is printed with its trials and Wilson's interval."""

from __future__ import annotations

import pytest

from course_lib.lessons.kit.shares import share_text


def test_a_share_says_hits_trials_and_interval():
    assert share_text(5, 11) == "5 of 11 = 45 % (21 to 72 %)"
    assert share_text(2902, 2908, 1) == "2902 of 2908 = 99.8 % (99.6 to 99.9 %)"
    assert share_text(0, 3) == "0 of 3 = 0 % (0 to 56 %)"


@pytest.mark.parametrize(("hits", "n"), [(0, 0), (-1, 4), (5, 4)])
def test_what_is_no_share_is_refused(hits, n):
    with pytest.raises(ValueError, match=f"got {hits} of {n}"):
        share_text(hits, n)
