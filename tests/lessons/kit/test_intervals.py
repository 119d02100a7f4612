"""The bootstrap of a median covers as often as it says; medians and shares are printed with their intervals."""

import numpy as np
import pytest

from course_lib.lessons.kit.intervals import bootstrap_median, median_text, share_text


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


def test_a_share_says_hits_trials_and_interval():
    assert share_text(5, 11) == "5 of 11 = 45 % (21 to 72 %)"
    assert share_text(2902, 2908, 1) == "2902 of 2908 = 99.8 % (99.6 to 99.9 %)"
    assert share_text(0, 3) == "0 of 3 = 0 % (0 to 56 %)"


@pytest.mark.parametrize(("hits", "n"), [(0, 0), (-1, 4), (5, 4)])
def test_what_is_no_share_is_refused(hits, n):
    with pytest.raises(ValueError, match=f"got {hits} of {n}"):
        share_text(hits, n)
