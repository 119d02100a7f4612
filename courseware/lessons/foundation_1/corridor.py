"""The toy world of F1: a wagon in a corridor with three niches that look alike, and two filters for it.

The wagon rolls about 0.2 m along the corridor in each frame. A sensor measures the depth to the left wall: 1.0 m, or
1.3 m in a niche. The start is anywhere in the first 10 m. On a fine grid the Bayes filter is exact.
"""

import functools
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl import effective_sample_size, resample

NICHES, HALF_WIDTH = np.array([2.0, 4.0, 8.0]), 0.4  # [m]; lesson 07 has its doors at the same places
WALL, NICHE = 1.0, 1.3  # depth [m]
STEP, SIGMA_STEP, SIGMA_DEPTH = 0.2, 0.05, 0.1  # [m]
START, FRAMES = 10.0, 30  # the start is anywhere in the first 10 m
CELL = 0.02  # [m]; the grid is long enough for 30 frames
GRID = np.arange(0, 18, CELL) + CELL / 2
BINS = np.arange(0, 18.1, 0.5)
WHEN = {"never": 0.0, "below N / 2": 0.5, "every frame": np.inf}
"""When a filter resamples -> the share of N below which the effective sample size must fall."""


class Run(NamedTuple):
    """One run of the particle filter: sizes (T,), resampled (T,) and, for each frame, the weight in each of BINS."""

    sizes: np.ndarray
    resampled: np.ndarray
    shares: np.ndarray


def depth(x: np.ndarray) -> np.ndarray:
    """Return the depth to the left wall [m] at the places x [m]."""
    in_a_niche = np.any(np.abs(np.asarray(x)[..., None] - NICHES) < HALF_WIDTH, axis=-1)
    return np.where(in_a_niche, NICHE, WALL)


def likelihood(z: float, x: np.ndarray, sigma: float = SIGMA_DEPTH) -> np.ndarray:
    """Return p(z | x) for a measured depth z [m] at the places x [m], without its constant factor."""
    return np.exp(-((z - depth(x)) ** 2) / (2 * sigma**2))


def move(x: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Draw from p(x_t | x_{t-1}) for each place x [m]."""
    return x + STEP + rng.normal(0, SIGMA_STEP, np.shape(x))


@functools.lru_cache(maxsize=200)
def record(seed: int, sigma: float = SIGMA_DEPTH) -> tuple[np.ndarray, np.ndarray]:
    """Return the true places (T,) and the measured depths (T,) of one wagon [m], which starts at 1 m."""
    rng, x = np.random.default_rng(seed), np.array(1.0)
    x = np.array([x := move(x, rng) for _ in range(FRAMES)])
    return x, depth(x) + rng.normal(0, 1, FRAMES) * sigma


@functools.lru_cache(maxsize=200)
def exact_beliefs(seed: int, sigma: float = SIGMA_DEPTH) -> np.ndarray:
    """Return the exact belief (T, cells) after each frame of `record`, by the Bayes filter on the grid."""
    belief, beliefs = (GRID < START) / np.sum(GRID < START), []
    step = np.arange(0, STEP + 6 * SIGMA_STEP, CELL)
    p_step = np.exp(-((step - STEP) ** 2) / (2 * SIGMA_STEP**2))
    for z in record(seed, sigma)[1]:
        moved = np.convolve(belief, p_step / p_step.sum())[: len(GRID)]
        belief = likelihood(z, GRID, sigma) * moved
        belief /= belief.sum()
        beliefs.append(belief)
    return np.array(beliefs)


@functools.lru_cache(maxsize=500)
def run(seed: int, n: int, share: float, sigma: float = SIGMA_DEPTH, forgets: bool = False) -> Run:
    """Run the particle filter on `record`. It resamples where N_eff < share N. forgets: drop the weights each frame."""
    rng, found = np.random.default_rng([seed, n]), []
    x, w = rng.uniform(0, START, n), np.full(n, 1 / n)
    for z in record(seed, sigma)[1]:
        x = move(x, rng)
        w = (1 if forgets else w) * likelihood(z, x, sigma)
        w /= w.sum()
        size = effective_sample_size(w)
        found.append((size, size < share * n, np.histogram(x, BINS, weights=w)[0]))
        if size < share * n:
            x, w = x[resample(w, rng)], np.full(n, 1 / n)
    return Run(*map(np.array, zip(*found, strict=True)))


def misplaced(shares: np.ndarray, seed: int, sigma: float = SIGMA_DEPTH) -> np.ndarray:
    """Return for each frame the part of the belief that the particles have in a wrong half metre, 0 to 1."""
    return np.abs(shares - binned(exact_beliefs(seed, sigma))).sum(axis=1) / 2


def binned(beliefs: np.ndarray) -> np.ndarray:
    """Return beliefs (T, cells) as shares in each half metre (T, bins)."""
    return beliefs.reshape(len(beliefs), len(BINS) - 1, -1).sum(axis=2)


def trials(n: int, share: float, forgets: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return sizes, resamplings and misplaced parts of 20 runs, each (20, T)."""
    runs = {seed: run(seed, n, share, forgets=forgets) for seed in range(100, 120)}
    wrong = [misplaced(one.shares, seed) for seed, one in runs.items()]
    return np.array([r.sizes for r in runs.values()]), np.array([r.resampled for r in runs.values()]), np.array(wrong)
