"""KLD-sampling."""

import numpy as np
import pytest

from course_lib.beyond.lost_and_found.adaptive_count import kld_count, occupied_bins
from course_lib.geometry import optical_pose


def test_the_count_is_the_chi_square_quantile_that_it_approximates():
    from scipy.stats import chi2

    for bins in (2, 10, 100, 1000):
        exact = chi2.ppf(0.99, bins - 1) / (2 * 0.05)
        assert kld_count(bins, 1, 10**7) == pytest.approx(exact, rel=0.02)


def test_more_bins_and_smaller_errors_need_more_within_bounds():
    counts = [kld_count(bins, 50, 5_000) for bins in (0, 1, 3, 30, 300, 3_000)]
    assert counts == sorted(counts)
    assert (counts[0], counts[1], counts[-1]) == (50, 50, 5_000)
    assert kld_count(30, 1, 10**6, error=0.01) > 4 * kld_count(30, 1, 10**6, error=0.05)


@pytest.mark.parametrize("wrong", [{"least": 0}, {"least": 9, "most": 5}, {"error": 0.0}, {"probability": 1.0}])
def test_bad_bounds_are_named(wrong):
    with pytest.raises(ValueError, match="must be"):
        kld_count(**{"bins": 5, "least": 1, "most": 10, **wrong})


def test_poses_are_counted_by_where_they_are_and_where_they_look():
    states = np.zeros((5, 6))
    states[:, :3] = 0.1
    states[1, 0], states[2, 0], states[3, 5] = 0.2, 3.0, np.pi / 2
    assert occupied_bins(optical_pose(states), 0.5, 0.5) == 3
    assert occupied_bins(np.empty((0, 4, 4)), 0.5, 0.5) == 0
