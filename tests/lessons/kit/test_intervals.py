"""The bootstrap of a median covers as often as it says; medians and shares are printed with their intervals."""

import numpy as np
import pytest

from course_lib.lessons.kit.intervals import bootstrap_median, median_text, share_text


def test_it_covers_the_true_median_in_about_95_of_100_samples():
    rng = np.random.default_rng(0)
    covered = [low <= 0 <= high for low, high in (bootstrap_median(rng.normal(size=40)) for _ in range(200))]
    assert 0.90 <= np.mean(covered) <= 0.99


def test_it_shrinks_with_the_root_of_the_number_of_values():
    rng = np.random.default_rng(1)
    widths = [np.ptp(bootstrap_median(rng.normal(5, 1, n))) for n in (100, 10_000)]
    assert widths[0] / widths[1] == pytest.approx(10, rel=0.5)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (median_text([1.0, 1.0], digits=1, unit="degrees"), "1.0 degrees (1.0 to 1.0)"),
        (median_text([0.04, 0.04, 0.04]), "0.040 m (0.040 to 0.040)"),
        (median_text([0.04]), "0.040 m (one value)"),
        (median_text(np.array([])), "no number (of no values)"),
        (share_text(5, 11), "5 of 11 = 45 % (21 to 72 %)"),
        (share_text(2902, 2908, 1), "2902 of 2908 = 99.8 % (99.6 to 99.9 %)"),
        (share_text(0, 3), "0 of 3 = 0 % (0 to 56 %)"),
    ],
)
def test_medians_and_shares_are_said_with_unit_and_interval(text, expected):
    assert text == expected


@pytest.mark.parametrize(("hits", "n"), [(0, 0), (-1, 4), (5, 4)])
def test_what_has_no_interval_is_refused(hits, n):
    with pytest.raises(ValueError, match=f"got {hits} of {n}"):
        share_text(hits, n)
    with pytest.raises(ValueError, match="at least two"):
        bootstrap_median([0.3])
