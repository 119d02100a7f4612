"""Every resampler of the library is unbiased by a test that finds resamplers which are not."""

from typing import get_args

import numpy as np
import pytest

from course_lib.depth_mcl.particle_filter import Scheme, resample
from tests.depth_mcl.resampling_bias import BIASED, chi_square, is_unbiased


@pytest.mark.parametrize("scheme", get_args(Scheme))
def test_copies_are_n_w_in_the_mean_by_a_chi_square_over_seeds(scheme):
    assert is_unbiased(lambda w, rng, n: resample(w, rng, scheme, n))


@pytest.mark.parametrize("name", BIASED)
def test_a_biased_resampler_is_found(name):
    assert not is_unbiased(BIASED[name])


def test_every_scheme_that_resample_knows_is_among_those_tested():
    """The error for an unknown one lists them: a fifth scheme would be named there, and must be in `Scheme`."""
    with pytest.raises(ValueError, match="scheme must be") as told:
        resample(np.ones(3), np.random.default_rng(0), "roulette")
    words = str(told.value).split("scheme must be ")[1].split(";")[0].replace(" or ", ", ").split(", ")
    assert sorted(words) == sorted(get_args(Scheme))


def test_draws_that_are_spread_too_evenly_are_not_independent():
    """An offset that walks through [0, 1) in equal steps has the right mean, and no randomness."""
    steps = iter(np.arange(0, 1e6) * 0.0025 % 1.0)
    evenly = chi_square(lambda w, rng, n: np.searchsorted(np.cumsum(w)[:-1], (np.arange(n) + next(steps)) / n, "right"))
    assert evenly < 1.0
