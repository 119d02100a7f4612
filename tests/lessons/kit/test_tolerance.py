"""Numbers with a declared tolerance: the same text within it, another one beyond."""

from __future__ import annotations

import pytest

from course_lib.lessons.kit.tolerance import about


@pytest.mark.parametrize("value", [0.36, 0.40, 0.44])
def test_within_the_tolerance_the_text_is_the_same(value):
    assert about(value, 0.4, 0.05) == "0.40 +- 0.05"


@pytest.mark.parametrize(("value", "told"), [(0.46, "0.460"), (0.33, "0.330"), (float("nan"), "nan")])
def test_beyond_it_the_value_itself_is_told_and_what_it_is_elsewhere(value, told):
    assert about(value, 0.4, 0.05) == f"{told} (elsewhere 0.40 +- 0.05)"


def test_it_is_written_with_the_decimals_that_were_declared():
    assert about(381, 380, 15) == "380 +- 15"
    assert about(0.0113, 0.011, 0.002) == "0.011 +- 0.002"
