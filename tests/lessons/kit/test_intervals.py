"""The bootstrap of a median covers as often as it says; medians and shares are printed with their intervals."""

import numpy as np
import pytest

from courseware.lessons.kit.intervals import bootstrap_median, median_text, share_text


def test_it_covers_the_true_median_in_about_95_of_100_samples():
    rng = np.random.default_rng(0)
    covered = [low <= 0 <= high for low, high in (bootstrap_median(rng.normal(size=40)) for _ in range(200))]
    assert 0.90 <= np.mean(covered) <= 0.99


def test_medians_and_shares_are_said_with_unit_and_interval():
    assert median_text([1.0, 1.0], digits=1, unit="degrees") == "1.0 degrees (1.0 to 1.0)"
    assert median_text([0.04]) == "0.040 m (one value)"
    assert median_text(np.array([])) == "no number (of no values)"
    assert share_text(5, 11) == "5 of 11 = 45 % (21 to 72 %)"
    assert share_text(3, 3) == "3 of 3 = 100 % (44 to 100 %)"
    assert share_text(2902, 2908, 1) == "2902 of 2908 = 99.8 % (99.6 to 99.9 %)"


@pytest.mark.parametrize(("hits", "n"), [(0, 0), (-1, 4), (5, 4)])
def test_what_has_no_interval_is_refused(hits, n):
    with pytest.raises(ValueError, match=f"got {hits} of {n}"):
        share_text(hits, n)
    with pytest.raises(ValueError, match="at least two"):
        bootstrap_median([0.3])
