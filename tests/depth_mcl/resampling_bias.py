"""Does a resampler draw every particle n w_i times in the mean? A chi-square over seeds, and biased ones that fail it.

A bias of a tenth of the weights is found whatever the scheme, one of a fiftieth is lost in multinomial draws.
"""

from collections.abc import Callable

import numpy as np
from scipy.stats import chi2

Draw = Callable[[np.ndarray, np.random.Generator, int], np.ndarray]
"""A resampler: weights (N,), a generator and n to indices (n,)."""

SEEDS, DRAWS = 40, 400
ERROR = 1e-4  # probability on either side with which a right resampler would be called biased


def z_score(draw: Draw, w: np.ndarray, n: int, rng: np.random.Generator, n_draws: int = DRAWS) -> float:
    """How many standard errors the mean of a random sum of the copies lies from what n w says.

    The sum of all particles' copies, each times a random number, is one number a draw; over independent draws its mean
    is normal whatever the scheme, and its spread is measured, not assumed. A scheme without any spread must be exact.
    """
    counts = np.array([np.bincount(draw(w, rng, n), minlength=len(w)) for _ in range(n_draws)])
    direction = rng.normal(size=len(w))
    sums, expected = counts @ direction, n * (w @ direction)
    off, error = sums.mean() - expected, sums.std(ddof=1) / np.sqrt(n_draws)
    if error < 1e-9:
        return 0.0 if abs(off) < 1e-9 else np.inf
    return off / error


def chi_square(draw: Draw, n_seeds: int = SEEDS) -> float:
    """Sum of the squares of `n_seeds` independent z-scores: other weights, another number of particles each."""
    total = 0.0
    for seed in range(n_seeds):
        rng = np.random.default_rng([20260, seed])
        n_particles = int(rng.integers(2, 13))
        w = rng.dirichlet(np.ones(n_particles)) + 0.01
        w[0] *= seed % 3 != 0  # in a third of them one has no weight
        w /= w.sum()
        n = n_particles if seed % 2 else int(rng.integers(2, 30))  # half as many live on as were, half another number
        total += z_score(draw, w, n, rng) ** 2
    return total


def is_unbiased(draw: Draw) -> bool:
    """Whether the chi-square lies where a right resampler's would but for one time in 5,000; too small is wrong, too:
    its draws are then not independent of each other."""
    low, high = chi2.ppf([ERROR, 1 - ERROR], SEEDS)
    return low < chi_square(draw) < high


def _pick(w: np.ndarray, points: np.ndarray) -> np.ndarray:
    return np.minimum(np.searchsorted(np.cumsum(w), points, side="right"), len(w) - 1)


def _one_in_ten_from_anywhere(w: np.ndarray, rng: np.random.Generator, n: int) -> np.ndarray:
    anywhere = rng.random(n) < 0.1
    return np.where(anywhere, rng.integers(len(w), size=n), _pick(w, rng.random(n)))


def _residual_of_filterpy(w: np.ndarray, rng: np.random.Generator, n: int) -> np.ndarray:
    copies = np.floor(n * w).astype(int)
    rest = w - copies  # n w - copies is meant
    rest = np.clip(rest, 0, None) if (rest > 0).any() else w
    more = _pick(rest / rest.sum(), rng.random(n - copies.sum()))
    return np.concatenate([np.repeat(np.arange(len(w)), copies), more])


BIASED: dict[str, Draw] = {
    "systematic, its offset always one half": lambda w, rng, n: _pick(w, (np.arange(n) + 0.5) / n),
    "systematic, its offset below one half": lambda w, rng, n: _pick(w, (np.arange(n) + rng.random() / 2) / n),
    "systematic, steps of 1 / (n - 1) from zero": lambda w, rng, n: _pick(w, np.arange(n) / max(n - 1, 1)),
    "systematic, the neighbour of each": lambda w, rng, n: (_pick(w, (np.arange(n) + rng.random()) / n) + 1) % len(w),
    "systematic, no more than the first n - 1 steps": lambda w, rng, n: _pick(
        w, np.minimum((np.arange(n) + rng.random()) / n, (n - 1) / n)
    ),
    "stratified, the middle of each stratum": lambda w, rng, n: _pick(w, (np.arange(n) + rng.random(n) / 2 + 0.25) / n),
    "multinomial, of the squares": lambda w, rng, n: _pick(w**2 / (w**2).sum(), rng.random(n)),
    "multinomial, all weights alike": lambda w, rng, n: rng.integers(len(w), size=n),
    "multinomial, one particle in ten from anywhere": _one_in_ten_from_anywhere,
    "residual, the rest from w - floor(n w)": _residual_of_filterpy,
    "residual, no rest": lambda w, rng, n: np.resize(np.repeat(np.arange(len(w)), np.ceil(n * w).astype(int)), n),
    "always the same draw": lambda w, rng, n: _pick(w, np.random.default_rng(5).random(n)),
}
