"""Laws of likelihood and weights, eqs (8) to (11), and of Fallon's scoring."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import quad
from scipy.stats import truncnorm

from course_lib.depth_mcl.fallon import (
    depth_log_likelihood,
    disparity_log_likelihood,
    fallon_weighting,
    normalized_disparity,
    weights_from_log_likelihood,
)
from course_lib.depth_mcl.likelihood import DepthImageError, likelihood, normalize_likelihood, paper_weighting, weights


def weigh(rule, measured, simulated):
    """Weights of all particles at once."""
    return rule.weigh(measured, rule.score(measured, simulated))


finite_likelihoods = arrays(float, st.integers(1, 60), elements=st.floats(-1e6, 1e6))


def test_perfect_agreement_counts_every_pixel():
    image = np.full((4, 5), 2.0)
    assert likelihood(image, image[None]) == pytest.approx([20])


def test_a_difference_of_alpha_counts_half():
    assert likelihood(np.full((1, 1), 2.0), np.full((1, 1, 1), 2.1), alpha=0.1) == pytest.approx([0.5])


def test_the_sum_is_the_papers_sum(rng):
    z, simulated = rng.uniform(1, 5, (6, 7)), rng.uniform(1, 5, (9, 6, 7))
    difference = np.abs(z - simulated)
    expected = (1 - difference / (0.1 + difference)).sum(axis=(1, 2))
    assert likelihood(z, simulated, 0.1) == pytest.approx(expected, rel=1e-5)


def test_pixels_that_the_camera_did_not_measure_are_left_out_for_all_particles_alike(rng):
    z, simulated = rng.uniform(1, 5, (6, 7)), rng.uniform(1, 5, (3, 6, 7))
    unmeasured = rng.random((6, 7)) < 0.4
    z[unmeasured] = np.nan
    elsewhere = simulated.copy()
    elsewhere[:, unmeasured] = rng.uniform(1, 5, (3, unmeasured.sum()))
    elsewhere[1, unmeasured] = np.inf
    assert np.array_equal(likelihood(z, simulated), likelihood(z, elsewhere))
    assert np.isfinite(likelihood(z, simulated)).all()


@pytest.mark.parametrize("no_return", [np.nan, 0.0, np.inf, -1.0])
def test_every_mark_for_no_return_is_left_out(no_return):
    z = np.array([[2.0, no_return]])
    assert likelihood(z, np.array([[[2.0, 7.0]]])) == pytest.approx([1.0])


def test_a_simulated_miss_contributes_the_limit_of_the_term_and_stays_in_the_count():
    z = np.full((1, 3), 2.0)
    simulated = np.array([[[2.0, 2.0, np.inf]], [[2.0, 2.0, 1e9]]])
    at_miss, far_away = likelihood(z, simulated)
    assert at_miss == 2.0
    assert far_away == pytest.approx(at_miss, abs=1e-6)


def test_looking_into_a_hole_of_the_map_does_not_pay():
    """Left out of the count, the misses would lift the mean agreement of the second particle above the first's."""
    z = np.full((10, 10), 2.0)
    sees_the_wall = np.full((10, 10), 2.05)
    looks_into_the_hole = np.full((10, 10), np.inf)
    looks_into_the_hole[:, 0] = 2.0
    through_all, into_hole = likelihood(z, np.stack([sees_the_wall, looks_into_the_hole]))
    assert through_all > 5 * into_hole
    w = weigh(paper_weighting(), z, np.stack([sees_the_wall, looks_into_the_hole]))
    assert w == pytest.approx([1, 0])


@pytest.mark.parametrize("alpha", [0.0, -0.1, np.nan, np.inf])
def test_a_bad_alpha_is_named(alpha):
    with pytest.raises(ValueError, match="alpha"):
        likelihood(np.ones((2, 2)), np.ones((1, 2, 2)), alpha)


@pytest.mark.parametrize("shapes", [((2, 3), (1, 3, 2)), ((2, 3), (2, 3)), ((6,), (1, 6))])
def test_images_of_other_sizes_are_named(shapes):
    with pytest.raises(DepthImageError, match="shape"):
        likelihood(np.ones(shapes[0]), np.ones(shapes[1]))


@given(finite_likelihoods)
def test_normalized_likelihoods_span_zero_to_one(values):
    normalized = normalize_likelihood(values)
    assert normalized.max() == 1
    assert normalized.min() == (0 if values.max() > values.min() else 1)
    assert (np.argsort(normalized, kind="stable") == np.argsort(values, kind="stable")).all() or len(
        np.unique(normalized)
    ) < len(np.unique(values))


def test_likelihoods_that_all_agree_give_equal_weights_not_nan():
    assert weights(normalize_likelihood(np.full(8, 123.4))) == pytest.approx(np.full(8, 1 / 8))


@given(finite_likelihoods, st.floats(1e-3, 10))
def test_weights_sum_to_one_and_the_best_particle_weighs_most(values, beta):
    w = weights(normalize_likelihood(values), beta)
    assert w.sum() == pytest.approx(1)
    assert (w >= 0).all()
    assert w[values.argmax()] == w.max()


def test_the_weight_is_the_papers_formula():
    normalized = np.array([0.0, 0.985, 0.99, 1.0])
    expected = np.exp(-((normalized - 1) ** 2) / 0.01**2)
    assert weights(normalized, 0.01) == pytest.approx(expected / expected.sum())


def test_the_order_of_particles_does_not_matter(rng):
    values, order = rng.random(50), rng.permutation(50)
    assert weights(normalize_likelihood(values))[order] == pytest.approx(weights(normalize_likelihood(values[order])))


def test_a_simulated_nan_is_named_by_every_rule():
    measured, simulated = np.full((1, 2), 2.0), np.array([[[2.0, np.nan]]])
    for rule in (likelihood, depth_log_likelihood, disparity_log_likelihood):
        with pytest.raises(DepthImageError, match="inf"):
            rule(measured, simulated)


def test_a_tiny_beta_leaves_the_best_particle_all_the_weight():
    assert weights(np.array([0.0, 0.5, 1.0]), 1e-200) == pytest.approx([0, 0, 1])
    assert weights(np.array([0.0, 0.5]), 1e-200) == pytest.approx([0, 1])


def test_fallons_score_is_a_mean_over_the_pixels_that_it_compares():
    scores = [
        fallon_weighting("disparity").score(np.array([z]), np.array([[[2.0] * len(z)]]))[0]
        for z in ([2.0], [2.0, np.nan], [2.0, 0.0, 0.3])
    ]
    assert scores == pytest.approx([scores[0]] * 3)


def test_weighting_rules_can_be_sent_to_another_process():
    z, simulated = np.full((2, 2), 2.0), np.full((3, 2, 2), 2.1)
    for rule in (paper_weighting(0.2, 0.05), fallon_weighting("depth"), fallon_weighting("disparity")):
        again = pickle.loads(pickle.dumps(rule))
        assert np.array_equal(weigh(again, z, simulated), weigh(rule, z, simulated))


@pytest.mark.parametrize("beta", [0, -1, np.nan])
def test_a_bad_beta_is_named(beta):
    with pytest.raises(ValueError, match="beta"):
        weights(np.array([0.0, 1.0]), beta)


@pytest.mark.parametrize("values", [[], [np.nan, 1.0], [np.inf, 1.0], [[1.0]]])
def test_likelihoods_without_a_number_are_refused(values):
    with pytest.raises(ValueError, match="likelihoods"):
        normalize_likelihood(np.asarray(values))


def test_fallons_half_normal_is_a_density_on_zero_to_three_metres():
    def density(x):
        log_value = depth_log_likelihood(np.full((1, 1), 4.0), np.full((1, 1, 1), 4.0 + x))[0]
        return np.exp(log_value)

    assert quad(density, 0, 3, points=[0.5, 1])[0] == pytest.approx(1, abs=1e-6)
    assert density(0.0) == pytest.approx(0.99 / 3 + 0.01 * 2 / (0.5 * np.sqrt(2 * np.pi)))
    assert density(5.0) == pytest.approx(0.33)


def test_fallons_miss_gets_the_uniform_part_alone():
    z = np.full((1, 1), 2.0)
    assert depth_log_likelihood(z, np.full((1, 1, 1), np.inf))[0] == pytest.approx(np.log(0.33))


def test_normalized_disparity_runs_from_near_to_far():
    assert normalized_disparity(np.array([0.7, 20.0, 0.1, np.inf])) == pytest.approx([0, 1, 0, 1])
    step = normalized_disparity(np.array([3.15])) - normalized_disparity(np.array([2.85]))
    assert step == pytest.approx(0.025, rel=0.05)  # 0.3 m at 3 m


def test_fallons_disparity_form_is_a_truncated_normal_density():
    simulated, s = 1.4, 0.025
    d = float(normalized_disparity(np.array(simulated)))
    for measured in (1.2, 1.4, 1.5, 2.5):
        value = float(normalized_disparity(np.array(measured)))
        density = truncnorm.pdf(value, -d / s, (1 - d) / s, loc=d, scale=s)
        got = disparity_log_likelihood(np.full((1, 1), measured), np.full((1, 1, 1), simulated))[0]
        assert got == pytest.approx(np.log(0.999 + 0.001 * density))


@pytest.mark.parametrize("outside", [0.5, 20.5, np.nan])
def test_fallons_disparity_form_masks_measurements_outside_its_planes(outside):
    pair = disparity_log_likelihood(np.array([[2.0, outside]]), np.array([[[2.0, 3.0]]]))
    alone = disparity_log_likelihood(np.array([[2.0]]), np.array([[[2.0]]]))
    assert pair == pytest.approx(alone)


def test_log_likelihoods_far_below_zero_still_give_weights():
    assert weights_from_log_likelihood([-1e5, -1e5 - np.log(3)]) == pytest.approx([0.75, 0.25])


def test_fallons_sum_collapses_onto_one_particle_at_full_size_only(rng):
    """The same difference between two particles: 84 times the terms, the 84th power of the weights' ratio."""
    near, far = 2.0, 2.5
    for size, least, most in (((15, 20), 0.5, 0.999), ((144, 176), 1 - 1e-12, 1.0)):
        z = np.full(size, near)
        w = weigh(fallon_weighting("depth"), z, np.stack([z, np.full(size, far)]))
        assert least <= w[0] <= most


def test_an_unknown_form_is_named():
    with pytest.raises(ValueError, match="disparity"):
        fallon_weighting("squares")
