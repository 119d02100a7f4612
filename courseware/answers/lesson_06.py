# ruff: noqa: E741, because l is the paper's letter
"""Exercises of lesson 06: a raw score, faults in given code, beta read backwards, the error bar of a weighted mean."""

import numpy as np
from scipy.stats import norm

from courseware.lessons.kit.exercise import Exercise


def raw_score(hidden, alpha):
    """Raw scores l / m (n,) where people hide shares (n,) of the measured pixels."""
    # A mean over the pixels: each share of them counts its own term.
    return (1 - hidden) * alpha / (alpha + 0.02) + hidden * alpha / (alpha + 2)


def weigh_rightly(measured, images, alpha, beta):
    """Weights (N,) of images (N, H, W) beside a measured one (H, W), by eqs (8) to (11)."""
    valid = np.isfinite(measured)  # 1. only these pixels, for all particles; a miss stays in, and counts 0
    l = np.sum(alpha / (alpha + np.abs(measured[valid] - images[:, valid])), axis=1)
    if l.max() == l.min():  # 2. the small number below the line gave 0 for all, and w underflows at a small beta
        return np.full(len(images), 1 / len(images))
    normalized = (l - l.min()) / (l.max() - l.min())  # a common factor of l, such as 1 / m, cancels here
    w = np.exp(-((normalized - 1) ** 2) / beta**2)  # 3. beta squared once
    return w / w.sum()


def given_code(measured, images, alpha, beta, mended=()):
    """Weigh as the code of the task does; "holes", "alike" and "exponent" name the faults that are mended."""
    with np.errstate(invalid="ignore", divide="ignore"):
        terms = alpha / (alpha + np.abs(measured - images))
        counted = np.isfinite(measured) & (np.isfinite(images) | ("holes" in mended))
        l = np.where(counted, terms, 0).sum(axis=(1, 2)) / (1 if "holes" in mended else counted.sum(axis=(1, 2)))
        if "alike" in mended and not np.ptp(l) > 0:
            return np.full(len(images), 1 / len(images))
        miss = (l - l.min()) / (np.ptp(l) + 1e-12) - 1
        w = np.exp(-(miss**2) / beta ** (2 if "exponent" in mended else 4))
        return w / w.sum()


def images_with_holes(rng: np.random.Generator) -> tuple:
    """Make images with pixels that were not measured, and particles that look into holes of different sizes."""
    n, shape = int(rng.integers(4, 8)), (4, 5)
    measured = rng.uniform(1, 6, shape)
    images = measured + rng.normal(0, 1, (n, 1, 1)) * 0.2 + rng.normal(0, 0.05, (n, *shape))
    measured.flat[rng.permutation(20)[:4]] = np.nan
    for image in images:
        image.flat[rng.permutation(20)[: rng.integers(1, 12)]] = np.inf
    return measured, images, rng.uniform(0.05, 0.3), rng.uniform(0.2, 0.6)


def a_lucky_pixel(rng: np.random.Generator) -> tuple:
    """Make a particle that is 2 cm off everywhere, one with a right pixel in a hole, and one that is far off."""
    images = np.stack([np.full((1, 6), 2.02), [[2.0] + [np.inf] * 5], np.full((1, 6), 2.3)])
    return np.full((1, 6), 2.0), images, 0.1, 0.3


def min_likelihood(likelihoods, beta):
    """The likelihood l at which w of eq. (10) is one half, below the best."""
    # Equation (10) solved for the normalized likelihood, then equation (9) solved for l.
    normalized = 1 - beta * np.sqrt(np.log(2))
    return likelihoods.min() + normalized * (likelihoods.max() - likelihoods.min())


def importance_mean(x, target, proposal):
    """Mean of the target and its standard error, from samples x (n,) of the proposal."""
    # mean - truth = sum of w (x - truth): variances add, each estimated by its own square.
    w = target / proposal
    w = w / w.sum()
    mean = np.sum(w * x)
    return mean, np.sqrt(np.sum((w * (x - mean)) ** 2))


def weighted_samples(rng: np.random.Generator) -> tuple:
    x = rng.normal(0, 1, int(rng.integers(20, 60)))
    target = norm.pdf(x, rng.uniform(-0.8, 0.8), rng.uniform(0.4, 0.9))
    return x + 10, rng.uniform(0.01, 100) * target, norm.pdf(x)


# fmt: off
EXERCISES = [
    Exercise("06.1", raw_score, lambda rng: (rng.uniform(0, 1, 5), rng.uniform(0.01, 1.0)), "warm-up", cases={
        "nobody or all hidden": lambda rng: (np.array([0.0, 1.0, 0.0, 0.5]), 0.1),
    }, example=(([0, 0.5, 1], 0.1), [0.833, 0.44, 0.048])),
    Exercise("06.2", weigh_rightly, images_with_holes, cases={
        "a lucky pixel": a_lucky_pixel,
        "all alike": lambda rng: (np.full((2, 3), 2.0), np.full((4, 2, 3), 2.1), 0.1, 0.01),
        "nothing measured": lambda rng: (np.full((2, 3), np.nan), rng.uniform(1, 6, (5, 2, 3)), 0.1, 0.3),
    }, example=(([[2, 2]], [[[2, np.inf]], [[2.1, 2.1]], [[2, 2.1]]], 0.1, 1), [0.212, 0.212, 0.576])),
    Exercise("06.3", min_likelihood, lambda rng: (
        rng.uniform(100, 900, int(rng.integers(5, 12))), rng.uniform(0.05, 0.6),
    ), cases={
        "the paper's beta": lambda rng: (rng.uniform(600, 900, 9), 0.01),
        "a large beta": lambda rng: (rng.uniform(100, 900, 6), 1.5),  # the worst particle has more than one half
    }, example=(([100, 300, 500], 0.5), 333.5)),
    Exercise("06.4", importance_mean, weighted_samples, "challenge", cases={
        "target is proposal": lambda rng: (x := rng.normal(0, 1, 30), norm.pdf(x), norm.pdf(x)),
        "one outweighs all": lambda rng: (x := np.linspace(-2, 2, 9), 1e-30 * norm.pdf(x, 1.5, 0.2), norm.pdf(x)),
    }, example=(([0, 1, 2], [1, 2, 1], [1, 1, 1]), (1.0, 0.354))),
]
