"""The bootstrap of a median covers as often as it says, and is said in words."""

from __future__ import annotations

import numpy as np
import pytest

from course_lib.lessons.kit.intervals import bootstrap_median, median_text


def test_it_covers_the_true_median_in_about_95_of_100_samples():
    rng = np.random.default_rng(0)
    covered = [low <= 0 <= high for low, high in (bootstrap_median(rng.normal(size=40)) for _ in range(200))]
    assert 0.90 <= np.mean(covered) <= 0.99


def test_it_shrinks_with_the_number_of_values_and_holds_the_median():
    rng = np.random.default_rng(1)
    few, many = rng.normal(5, 1, 20), rng.normal(5, 1, 2000)
    width = [high - low for low, high in (bootstrap_median(few), bootstrap_median(many))]
    assert width[1] < 0.3 * width[0]
    low, high = bootstrap_median(few)
    assert low <= np.median(few) <= high


def test_it_is_said_with_its_unit():
    assert median_text([0.04, 0.04, 0.04]) == "0.040 m (0.040 to 0.040)"
    assert median_text([1.0, 1.0], digits=1, unit="degrees") == "1.0 degrees (1.0 to 1.0)"


def test_the_text_of_too_few_values_says_so():
    """As a lesson prints them of a reader's recording with a single frame, or of panoramas without boxes."""
    assert median_text([0.04]) == "0.040 m (one value)"
    assert median_text(np.array([])) == "no number (of no values)"


def test_one_value_has_no_interval():
    with pytest.raises(ValueError, match="at least two"):
        bootstrap_median([0.3])
