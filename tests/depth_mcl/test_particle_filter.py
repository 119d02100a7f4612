"""Laws of the particle filter's steps: eqs (3), (4), (12), and resampling (3.4)."""

from typing import get_args

import numpy as np
import pytest
from filterpy import monte_carlo
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.stats import chi2

from course_lib.depth_mcl.particle_filter import (
    Scheme,
    effective_sample_size,
    initial_particles,
    resample,
    weighted_mean_pose,
    weighted_mean_state,
)
from course_lib.geometry import pose_matrix, rotation_angle, state_from_matrix

SCHEMES = get_args(Scheme)
STATE = np.array([1.0, -2.0, 0.5, 0.1, -0.2, 3.1])


def random_weights(n, rng):
    w = rng.random(n)
    return w / w.sum()


def test_all_particles_start_at_the_initial_state_and_the_effective_sample_size_runs_from_one_to_n():
    assert (initial_particles(STATE, 7) == np.tile(STATE, (7, 1))).all()
    for n in (0, -1, 2.5):
        with pytest.raises(ValueError, match="number of particles"):
            initial_particles(STATE, n)
    assert effective_sample_size(np.full(50, 0.02)) == pytest.approx(50)
    assert effective_sample_size(np.eye(50)[3]) == pytest.approx(1)


def test_the_mean_is_the_papers_sum_but_for_angles_at_the_wrap_and_moves_with_the_world_even_into_gimbal_lock(rng):
    particles, w = rng.normal(0, 0.01, (200, 6)), random_weights(200, rng)
    assert np.allclose(weighted_mean_state(particles, w), w @ particles, atol=1e-6)
    across = np.zeros((2, 6))
    across[:, 5] = np.deg2rad([179, -179])
    assert np.isclose(abs(weighted_mean_state(across, [0.5, 0.5])[5]), np.pi)
    particles, w = STATE + rng.normal(0, 0.1, (80, 6)), random_weights(80, rng)
    move = pose_matrix([3.0, -1.0, 2.0, 0.4, np.pi / 2 - 0.2, 1.0])
    moved = state_from_matrix(move @ pose_matrix(particles))
    expected, got = move @ pose_matrix(weighted_mean_pose(particles, w)), pose_matrix(weighted_mean_pose(moved, w))
    assert np.allclose(got[:3, 3], expected[:3, 3], atol=1e-9)
    assert rotation_angle(got[:3, :3].T @ expected[:3, :3]) < 1e-9


def chi_square(draw, n_seeds=40, n_draws=400):
    """Sum of squared z-scores over seeds: is particle i drawn n w_i times in the mean, as `draw(w, rng, n)` draws?

    The sum of all particles' copies, each times a random number, is one number a draw; over independent draws its mean
    is normal whatever the scheme, and its spread is measured, not assumed. A scheme without any spread must be exact.
    """
    total = 0.0
    for seed in range(n_seeds):
        rng = np.random.default_rng([20260, seed])
        w = rng.dirichlet(np.ones(int(rng.integers(2, 13)))) + 0.01
        w[0] *= seed % 3 != 0  # in a third of them one has no weight
        w /= w.sum()
        n = len(w) if seed % 2 else int(rng.integers(2, 30))  # half as many live on as were, half another number
        counts = np.array([np.bincount(draw(w, rng, n), minlength=len(w)) for _ in range(n_draws)])
        direction = rng.normal(size=len(w))
        sums = counts @ direction
        off, error = sums.mean() - n * (w @ direction), sums.std(ddof=1) / np.sqrt(n_draws)
        total += (off / error) ** 2 if error > 1e-9 else (0.0 if abs(off) < 1e-9 else np.inf)
    return total


def pick(w, points):
    return np.minimum(np.searchsorted(np.cumsum(w), points, side="right"), len(w) - 1)


def residual_of_filterpy(w, rng, n):
    copies = np.floor(n * w).astype(int)
    rest = w - copies  # n w - copies is meant
    rest = np.clip(rest, 0, None) if (rest > 0).any() else w
    return np.concatenate([np.repeat(np.arange(len(w)), copies), pick(rest / rest.sum(), rng.random(n - copies.sum()))])


BIASED = {
    "systematic, its offset always one half": lambda w, rng, n: pick(w, (np.arange(n) + 0.5) / n),
    "systematic, steps of 1 / (n - 1) from zero": lambda w, rng, n: pick(w, np.arange(n) / max(n - 1, 1)),
    "systematic, the neighbour of each": lambda w, rng, n: (pick(w, (np.arange(n) + rng.random()) / n) + 1) % len(w),
    "multinomial, all weights alike": lambda w, rng, n: rng.integers(len(w), size=n),
    "residual, the rest from w - floor(n w)": residual_of_filterpy,
    "always the same draw": lambda w, rng, n: pick(w, np.random.default_rng(5).random(n)),
}


def test_resampling_is_unbiased_by_a_test_that_finds_what_is_biased():
    """Copies are n w in the mean; a right resampler fails one time in 5,000, and too evenly spread draws fail, too."""
    low, high = chi2.ppf([1e-4, 1 - 1e-4], 40)
    for scheme in SCHEMES:
        assert low < chi_square(lambda w, rng, n, scheme=scheme: resample(w, rng, scheme, n)) < high, scheme
    for name, draw in BIASED.items():
        assert not low < chi_square(draw) < high, name


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
    if scheme in ("systematic", "residual"):
        assert (np.bincount(indices, minlength=len(w)) >= np.floor(len(w) * w / w.sum() * (1 - 1e-9))).all()


class Greatest(np.random.Generator):
    """Draws 1 - 2^-53, the largest number that a generator draws from [0, 1), and all else as any generator."""

    def random(self, size=None):
        return np.full(() if size is None else size, np.nextafter(1.0, 0.0))


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("n", [1, 3, 7, 200])
def test_the_greatest_random_number_names_a_particle_with_weight(scheme, n):
    """Neither one behind the last, nor the last, which has no weight here."""
    indices = resample(np.append(np.linspace(0.3, 1.0, n), 0.0), Greatest(np.random.PCG64(1)), scheme)
    assert len(indices) == n + 1
    assert indices.max() < n


@pytest.mark.parametrize("scheme", ["systematic", "stratified", "multinomial"])
def test_filterpy_draws_the_same_particles_from_the_same_random_numbers(scheme, monkeypatch, rng):
    w, numbers = random_weights(200, rng), np.random.default_rng(9)
    monkeypatch.setattr(monte_carlo.resampling, "random", lambda *n: numbers.random(*n))
    theirs = getattr(monte_carlo, f"{scheme}_resample")(w)
    assert np.array_equal(np.sort(theirs), resample(w, np.random.default_rng(9), scheme))


def test_bad_weights_and_unknown_schemes_are_refused(rng):
    for w in ([0.5, 0.6], [0.2, 0.3], [1.5, -0.5], [np.nan, 1.0], [1.0]):
        with pytest.raises(ValueError, match="weights"):
            weighted_mean_state(np.zeros((2, 6)), w)
    for w in ([], [0.0, 0.0], [np.nan, 1.0], [-0.1, 1.1], [[0.5, 0.5]]):
        with pytest.raises(ValueError, match="weights"):
            resample(np.asarray(w), rng)
    with pytest.raises(ValueError, match="systematic"):
        resample(np.ones(3), rng, "roulette")
