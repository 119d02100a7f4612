"""Intervals of shares and medians hold what they say."""

import numpy as np
import pytest
from scipy.stats import norm

from courseware.experiments.intervals import bootstrap_percent, median_interval, wilson_percent


@pytest.mark.parametrize(("hits", "n"), [(13, 20), (0, 20), (20, 20), (200, 400)])
def test_wilsons_interval_holds_the_shares_that_the_count_does_not_contradict(hits, n):
    """p is inside if and only if |hits / n - p| <= z sqrt(p (1 - p) / n)."""
    low, high = (value / 100 for value in wilson_percent(hits, n))
    z = norm.ppf(0.975)
    for bound in {low, high} - {0.0, 1.0}:
        assert abs(hits / n - bound) == pytest.approx(z * np.sqrt(bound * (1 - bound) / n), abs=1e-9)
    assert low <= hits / n <= high


def test_rooms_that_agree_leave_nothing_open_and_one_room_says_nothing():
    assert bootstrap_percent(np.full(10, 0.5)) == [50.0, 50.0]
    assert np.ptp(bootstrap_percent(np.repeat([0.0, 1.0], 5))) > 50
    assert bootstrap_percent(np.array([0.5])) is None


def test_the_interval_of_a_median_holds_it_for_whatever_distribution():
    """The ends are order statistics: over skewed draws the true median lies between them in at least 95 of 100."""
    rng = np.random.default_rng(5)
    told = [median_interval(rng.exponential(size=20)) for _ in range(400)]
    assert 0.94 < np.mean([one["low"] <= np.log(2) <= one["high"] for one in told]) < 0.99
    assert all(one["low"] <= one["median"] <= one["high"] for one in told)
    assert median_interval([1.0, 2.0]) == {"median": 1.5, "low": None, "high": None}
