"""Eq. (8) in a compiled loop gives what the equation as one reads it gives."""

import numpy as np
import pytest

from course_lib.depth_mcl import compiled_likelihood
from course_lib.depth_mcl.likelihood import DepthImageError, likelihood


@pytest.mark.parametrize("shape", [(1, 1), (3, 7), (40, 50), (144, 176)])
@pytest.mark.parametrize("alpha", [0.01, 0.1, 3.0])
def test_both_give_the_same_numbers(shape, alpha, rng):
    measured = rng.uniform(0.5, 9, shape)
    measured[rng.random(shape) < 0.2] = np.nan
    measured[rng.random(shape) < 0.05] = np.inf
    measured[rng.random(shape) < 0.05] = 0.0
    simulated = np.abs(np.nan_to_num(measured, posinf=5.0) + rng.normal(0, 0.3, (12, *shape))).astype(np.float32)
    simulated[rng.random(simulated.shape) < 0.1] = np.inf
    assert compiled_likelihood.likelihood(measured, simulated, alpha) == pytest.approx(
        likelihood(measured, simulated, alpha), rel=2e-6, abs=1e-9
    )


def test_an_image_without_measurement_or_hit_counts_nothing():
    assert compiled_likelihood.likelihood(np.full((2, 3), np.nan), np.ones((4, 2, 3))).tolist() == [0.0] * 4
    assert compiled_likelihood.likelihood(np.ones((2, 3)), np.full((4, 2, 3), np.inf)).tolist() == [0.0] * 4
    assert compiled_likelihood.likelihood(np.ones((2, 3)), np.ones((0, 2, 3))).shape == (0,)


@pytest.mark.parametrize(
    ("measured", "simulated", "alpha", "error"),
    [
        (np.ones((2, 3)), np.ones((4, 3, 2)), 0.1, DepthImageError),
        (np.ones((2, 3)), np.full((4, 2, 3), np.nan), 0.1, DepthImageError),
        (np.ones((2, 3)), np.ones((4, 2, 3)), 0.0, ValueError),
    ],
)
def test_both_refuse_the_same(measured, simulated, alpha, error):
    for each in (likelihood, compiled_likelihood.likelihood):
        with pytest.raises(error):
            each(measured, simulated, alpha)
