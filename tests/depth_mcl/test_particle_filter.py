"""Laws of the particle filter's steps: eqs (3) to (5), (12), and resampling."""

import numpy as np
import pytest
from filterpy import monte_carlo
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from course_lib.depth_mcl.particle_filter import (
    effective_sample_size,
    initial_particles,
    resample,
    weighted_mean_pose,
    weighted_mean_state,
)
from course_lib.geometry import pose_matrix, rotation_angle, state_from_matrix

SCHEMES = ["systematic", "stratified", "multinomial", "residual"]
STATE = np.array([1.0, -2.0, 0.5, 0.1, -0.2, 3.1])


def test_all_particles_start_at_the_initial_state():
    particles = initial_particles(STATE, 7)
    assert particles.shape == (7, 6)
    assert (particles == STATE).all()


@pytest.mark.parametrize("n", [0, -1, 2.5])
def test_no_particles_is_refused(n):
    with pytest.raises(ValueError, match="number of particles"):
        initial_particles(STATE, n)


def test_the_mean_of_angles_crosses_the_wrap():
    particles = np.zeros((2, 6))
    particles[:, 5] = np.deg2rad([179, -179])
    assert np.isclose(abs(weighted_mean_state(particles, [0.5, 0.5])[5]), np.pi)


def test_the_weighted_mean_is_the_papers_sum_away_from_the_wrap(rng):
    particles, w = rng.normal(0, 0.01, (200, 6)), rng.random(200)
    w /= w.sum()
    assert np.allclose(weighted_mean_state(particles, w), w @ particles, atol=1e-6)


def test_the_order_of_particles_does_not_matter(rng):
    particles, w = rng.normal(0, 1, (60, 6)), rng.random(60)
    w /= w.sum()
    order = rng.permutation(60)
    for mean in (weighted_mean_state, weighted_mean_pose):
        assert np.allclose(mean(particles, w), mean(particles[order], w[order]), atol=1e-12)


def test_the_mean_pose_moves_with_the_world_even_into_gimbal_lock(rng):
    particles = STATE + rng.normal(0, 0.1, (80, 6))
    w = rng.random(80)
    w /= w.sum()
    move = pose_matrix([3.0, -1.0, 2.0, 0.4, np.pi / 2 - 0.2, 1.0])
    moved = state_from_matrix(move @ pose_matrix(particles))
    expected, got = move @ pose_matrix(weighted_mean_pose(particles, w)), pose_matrix(weighted_mean_pose(moved, w))
    assert np.allclose(got[:3, 3], expected[:3, 3], atol=1e-9)
    assert rotation_angle(got[:3, :3].T @ expected[:3, :3]) < 1e-9


@pytest.mark.parametrize("w", [[0.5, 0.6], [1.5, -0.5], [np.nan, 1.0], [1.0]])
def test_weights_that_do_not_fit_are_refused(w):
    with pytest.raises(ValueError, match="weights"):
        weighted_mean_state(np.zeros((2, 6)), w)


def test_effective_sample_size_runs_from_one_to_n():
    assert effective_sample_size(np.full(50, 0.02)) == pytest.approx(50)
    assert effective_sample_size(np.eye(50)[3]) == pytest.approx(1)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_resampling_is_unbiased(scheme, rng):
    w = np.array([0.003, 0.4, 0.0, 0.21, 0.037, 0.35])
    n_trials = 20_000
    counts = sum(np.bincount(resample(w, rng, scheme), minlength=6) for _ in range(n_trials)) / n_trials
    # Multinomial counts have the greatest variance, n w (1 - w); five standard errors of the mean of the trials.
    tolerance = 5 * np.sqrt(6 * w * (1 - w) / n_trials) + 1e-12
    assert (np.abs(counts - 6 * w) <= tolerance).all()


@pytest.mark.parametrize("scheme", SCHEMES)
@settings(max_examples=60, deadline=None)
@given(w=arrays(float, st.integers(1, 40), elements=st.floats(0, 1)), seed=st.integers(0, 2**32))
def test_resampling_gives_n_ascending_indices_of_particles_with_weight(scheme, w, seed):
    if w.sum() <= 0:
        w = w + 1.0
    indices = resample(w, np.random.default_rng(seed), scheme)
    assert len(indices) == len(w)
    assert (np.diff(indices) >= 0).all()
    assert (w[indices] > 0).all()


class GreatestNumbers:
    """The largest numbers that a generator can draw from [0, 1): 1 - 2^-53."""

    def random(self, size=None):
        return np.full(() if size is None else size, np.nextafter(1.0, 0.0))


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("n", [1, 2, 3, 7, 200])
def test_the_greatest_random_number_names_the_last_particle_with_weight(scheme, n):
    w = np.append(np.linspace(0.3, 1.0, n), 0.0)
    assert resample(w, GreatestNumbers(), scheme).max() == n - 1


@pytest.mark.parametrize("scheme", ["systematic", "residual"])
def test_a_particle_is_copied_at_least_floor_n_w_times(scheme, rng):
    w = rng.random(100)
    w /= w.sum()
    counts = np.bincount(resample(w, rng, scheme), minlength=100)
    assert (counts >= np.floor(100 * w)).all()


@pytest.mark.parametrize(
    ("scheme", "theirs"),
    [("systematic", monte_carlo.systematic_resample), ("stratified", monte_carlo.stratified_resample)],
)
def test_filterpy_draws_the_same_indices_from_the_same_random_numbers(scheme, theirs, monkeypatch, rng):
    w = rng.random(200)
    w /= w.sum()
    numbers = np.random.default_rng(9)
    monkeypatch.setattr(monte_carlo.resampling, "random", lambda *n: numbers.random(*n))
    assert np.array_equal(theirs(w), resample(w, np.random.default_rng(9), scheme))


def test_filterpys_multinomial_resampling_draws_the_same_particles(monkeypatch, rng):
    w = rng.random(200)
    w /= w.sum()
    numbers = np.random.default_rng(9)
    monkeypatch.setattr(monte_carlo.resampling, "random", lambda *n: numbers.random(*n))
    theirs = np.sort(monte_carlo.multinomial_resample(w))
    assert np.array_equal(theirs, resample(w, np.random.default_rng(9), "multinomial"))


def test_filterpys_residual_resampling_starves_light_particles_and_ours_does_not(rng, monkeypatch):
    """The reason why it is no oracle here: it forms w - floor(N w) where N w - floor(N w) is meant."""
    w = np.array([0.55] + [0.45 / 9] * 9)
    monkeypatch.setattr(monte_carlo.resampling, "random", lambda *n: rng.random(*n))
    theirs = sum(np.bincount(monte_carlo.residual_resample(w), minlength=10) for _ in range(200)) / 200
    assert (theirs[1:] == 0).all()
    ours = sum(np.bincount(resample(w, rng, "residual"), minlength=10) for _ in range(4000)) / 4000
    assert np.allclose(ours, 10 * w, atol=0.1)


@pytest.mark.parametrize("w", [[], [0.0, 0.0], [np.nan, 1.0], [-0.1, 1.1], [[0.5, 0.5]]])
def test_resampling_refuses_bad_weights(w, rng):
    with pytest.raises(ValueError, match="weights"):
        resample(np.asarray(w), rng)


def test_an_unknown_scheme_is_named(rng):
    with pytest.raises(ValueError, match="systematic"):
        resample(np.ones(3), rng, "roulette")
