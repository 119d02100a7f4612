"""What lesson 09 says about clouds, tracks, basins and bare corridors holds."""

import numpy as np
import pytest
from scipy.stats import chi2

from courseware.lessons.lesson_09.panel import descend
from courseware.lessons.lesson_09.trials import cloud_density, slide


def test_the_nearest_particle_is_as_far_as_its_distribution_says():
    nearest = cloud_density(200, 6, np.random.default_rng(3))[2]
    assert nearest == pytest.approx(np.sqrt(chi2.ppf(1 - 0.5 ** (1 / 200), 6)), rel=0.03)


def test_in_a_bare_corridor_the_error_stays_within_a_sigma_that_is_wide_along_the_axis_only():
    errors, sigmas, _ = slide()
    assert np.diff(errors[:, 0])[1:] == pytest.approx(-0.1, abs=0.03)
    assert (sigmas[:, 0] > 5 * sigmas[:, 1]).all()
    assert (np.abs(errors[:, 0]) < 3 * sigmas[:, 0]).all()


@pytest.mark.parametrize(("turned", "scale", "back"), [(6, 0.1, True), (40, 0.1, False), (0, 1e6, False)])
def test_gauss_newton_comes_back_from_a_small_turn_if_it_is_robust(turned, scale, back):
    _, _, position, rotation = descend(0.0, 0.0, turned, scale)
    assert rotation[0] == pytest.approx(turned, abs=1e-4)
    assert (position[-1] < 0.03) == back
