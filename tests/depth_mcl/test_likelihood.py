"""Laws of likelihood and weights, eqs (8) to (11), and of Fallon's scoring."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import quad
from scipy.stats import truncnorm

from course_lib.depth_mcl.fallon import (
    COARSE_HEIGHT,
    COARSE_WIDTH,
    depth_log_likelihood,
    disparity_log_likelihood,
    fallon_weighting,
    normalized_disparity,
    weights_from_log_likelihood,
)
from course_lib.depth_mcl.likelihood import (
    ALPHA,
    BETA,
    DepthImageError,
    compiled_likelihood,
    likelihood,
    normalize_likelihood,
    weights,
)

finite_likelihoods = arrays(float, st.integers(1, 60), elements=st.floats(-1e6, 1e6))


def test_alpha_and_beta_are_the_papers():
    assert (ALPHA, BETA) == (0.1, 0.01), "what follows alpha: CONTRIBUTING.md, 'Another default of alpha'"


@pytest.fixture(params=[likelihood, compiled_likelihood], ids=["eq. (8) as one reads it", "its compiled twin"])
def eq_8(request):
    return request.param


def test_the_sum_is_the_papers_and_a_miss_adds_the_limit_of_its_term_and_stays_in_the_count(eq_8, rng):
    z, simulated = rng.uniform(1, 5, (6, 7)), rng.uniform(1, 5, (9, 6, 7))
    difference = np.abs(z - simulated)
    assert eq_8(z, simulated, 0.1) == pytest.approx((1 - difference / (0.1 + difference)).sum(axis=(1, 2)), rel=1e-5)
    assert eq_8(z, z[None] + 0.1, 0.1) == pytest.approx([21.0], rel=1e-5)  # a difference of alpha counts half
    z = np.full((1, 3), 2.0)
    at_miss, far_away = eq_8(z, np.array([[[2.0, 2.0, np.inf]], [[2.0, 2.0, 1e9]]]))
    assert at_miss == 2.0
    assert far_away == pytest.approx(at_miss, abs=1e-6)


@pytest.mark.parametrize("no_return", [np.nan, 0.0, np.inf, -1.0])
def test_pixels_that_the_camera_did_not_measure_are_left_out_for_all_particles_alike(eq_8, no_return, rng):
    z, simulated = rng.uniform(1, 5, (6, 7)), rng.uniform(1, 5, (3, 6, 7))
    unmeasured = rng.random((6, 7)) < 0.4
    z[unmeasured] = no_return
    elsewhere = simulated.copy()
    elsewhere[:, unmeasured] = rng.uniform(1, 5, (3, unmeasured.sum()))
    elsewhere[1, unmeasured] = np.inf
    assert np.array_equal(eq_8(z, simulated), eq_8(z, elsewhere))
    assert np.isfinite(eq_8(z, simulated)).all()
    assert eq_8(np.full((2, 3), no_return), np.ones((4, 2, 3))).tolist() == [0.0] * 4


@pytest.mark.parametrize("shape", [(1, 1), (3, 7), (144, 176)])
@pytest.mark.parametrize("alpha", [0.01, 0.1, 3.0])
def test_the_compiled_twin_gives_the_same_numbers(shape, alpha, rng):
    measured = rng.uniform(0.5, 9, shape)
    measured[rng.random(shape) < 0.2] = np.nan
    simulated = np.abs(np.nan_to_num(measured, nan=5.0) + rng.normal(0, 0.3, (12, *shape))).astype(np.float32)
    simulated[rng.random(simulated.shape) < 0.1] = np.inf
    expected = likelihood(measured, simulated, alpha)
    assert compiled_likelihood(measured, simulated, alpha) == pytest.approx(expected, rel=2e-6, abs=1e-9)


@pytest.mark.parametrize(
    ("measured", "simulated", "alpha", "said"),
    [
        (np.ones((2, 3)), np.ones((4, 3, 2)), 0.1, "shape"),
        (np.ones(6), np.ones((1, 6)), 0.1, "shape"),
        (np.ones((2, 3)), np.full((4, 2, 3), np.nan), 0.1, "inf"),
        *((np.ones((2, 3)), np.ones((4, 2, 3)), alpha, "alpha") for alpha in (0.0, -0.1, np.nan, np.inf)),
    ],
)
def test_what_eq_8_cannot_compare_is_named(eq_8, measured, simulated, alpha, said):
    with pytest.raises(ValueError, match=said) as told:
        eq_8(measured, simulated, alpha)
    assert isinstance(told.value, DepthImageError) == (said != "alpha")


@given(finite_likelihoods, st.floats(1e-3, 10))
def test_likelihoods_are_spread_from_zero_to_one_and_weights_sum_to_one_with_the_best_first(values, beta):
    normalized = normalize_likelihood(values)
    assert normalized.max() == 1
    assert normalized.min() == (0 if values.max() > values.min() else 1)
    assert (np.diff(normalized[np.argsort(values)]) >= 0).all()
    w = weights(normalized, beta)
    assert w.sum() == pytest.approx(1)
    assert (w >= 0).all()
    assert w[values.argmax()] == w.max()


def test_weights_are_the_papers_never_nan_and_what_is_no_number_is_refused():
    """Likelihoods that all agree (0/0) give equal weights; a tiny beta leaves the best particle all the weight."""
    assert weights(normalize_likelihood(np.full(8, 123.4))) == pytest.approx(np.full(8, 1 / 8))
    assert weights(np.array([0.0, 0.5]), 1e-200) == pytest.approx([0, 1])
    formula = np.exp(-((np.array([0.0, 0.985, 0.99, 1.0]) - 1) ** 2) / 0.01**2)
    assert weights(np.array([0.0, 0.985, 0.99, 1.0]), 0.01) == pytest.approx(formula / formula.sum())
    assert weights_from_log_likelihood([-1e5, -1e5 - np.log(3)]) == pytest.approx([0.75, 0.25])
    for beta in (0, -1, np.nan):
        with pytest.raises(ValueError, match="beta"):
            weights(np.array([0.0, 1.0]), beta)
    for values in ([], [np.nan, 1.0], [[1.0]]):
        with pytest.raises(ValueError, match="likelihoods"):
            normalize_likelihood(np.asarray(values))


def test_fallons_half_normal_and_truncated_normal_are_densities_and_the_score_a_mean_over_what_it_compares():
    def density(x):
        log_value = depth_log_likelihood(np.full((1, 1), 4.0), np.full((1, 1, 1), 4.0 + x))[0]
        return np.exp(log_value)

    assert quad(density, 0, 3, points=[0.5, 1])[0] == pytest.approx(1, abs=1e-6)
    assert density(0.0) == pytest.approx(0.99 / 3 + 0.01 * 2 / (0.5 * np.sqrt(2 * np.pi)))
    assert density(5.0) == density(np.inf) == pytest.approx(0.33)  # a miss gets the uniform part alone
    with pytest.raises(ValueError, match="disparity"):
        fallon_weighting("squares")
    assert 176 * 144 // (COARSE_WIDTH * COARSE_HEIGHT) == 84  # times as many terms at full size, as the module says
    scores = [
        fallon_weighting("disparity").score(np.array([z]), np.array([[[2.0] * len(z)]]))[0]
        for z in ([2.0], [2.0, np.nan], [2.0, 0.0, 0.3])
    ]
    assert scores == pytest.approx([scores[0]] * 3)
    simulated, s = 1.4, 0.025
    d = float(normalized_disparity(np.array(simulated)))
    for measured in (1.2, 1.4, 1.5, 2.5):
        value = float(normalized_disparity(np.array(measured)))
        density = truncnorm.pdf(value, -d / s, (1 - d) / s, loc=d, scale=s)
        got = disparity_log_likelihood(np.full((1, 1), measured), np.full((1, 1, 1), simulated))[0]
        assert got == pytest.approx(np.log(0.999 + 0.001 * density))
    assert normalized_disparity(np.array([0.7, 20.0, 0.1, np.inf])) == pytest.approx([0, 1, 0, 1])
    step = normalized_disparity(np.array([3.15])) - normalized_disparity(np.array([2.85]))
    assert step == pytest.approx(0.025, rel=0.05)  # 0.3 m at 3 m
    alone = disparity_log_likelihood(np.array([[2.0]]), np.array([[[2.0]]]))
    for outside in (0.5, 20.5, np.nan):
        pair = disparity_log_likelihood(np.array([[2.0, outside]]), np.array([[[2.0, 3.0]]]))
        assert pair == pytest.approx(alone)
