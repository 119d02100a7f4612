"""Exercises of F1: weights that are carried, resampling on demand, how fast a weighted set wears out."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise


def carry(w, likelihood):
    """New weights (N,), which sum to one, and their effective sample size, from old weights and likelihoods (N,)."""
    # Multiply, divide by the sum, and only then count.
    product = w * likelihood
    new = product / product.sum()
    return new, 1 / np.sum(new**2)


def uneven(rng: np.random.Generator, n: int) -> np.ndarray:
    """Make n weights that sum to one, sometimes nearly equal, sometimes very uneven."""
    w = rng.uniform(0.1, 1, n) ** rng.choice([0.3, 1, 4])
    return w / w.sum()


def weighted(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 9))
    return uneven(rng, n), rng.uniform(0.1, 1, n) ** rng.choice([0.3, 3])


def correct(x, w, likelihood, offset, share):
    """Particles (N,) and weights (N,) after one correction, resampled if N_eff is below share times N.

    offset: the random number of the comb, 0 to 1. share: 0 for never, 0.5 for N / 2, above 1 for every frame.
    """
    # Carry the weights first. The new weights decide whether the set is drawn anew.
    n, w = len(w), w * likelihood / np.sum(w * likelihood)
    if 1 / np.sum(w**2) >= share * n:
        return x, w
    indices = np.searchsorted(np.cumsum(w), (np.arange(n) + offset) / n, side="right")
    return x[indices], np.full(n, 1 / n)


def on_demand(rng: np.random.Generator) -> tuple:
    w, likelihood = weighted(rng)
    return rng.normal(5, 2, len(w)), w, likelihood, rng.uniform(0.05, 0.95), rng.choice([0.5, 0.8])


def share_left(variance, innovation, r):
    """Mean share N_eff / N after one measurement of sigma r, for particles of this variance around a mean.

    innovation: how far the measurement lies from the particles' mean.
    """
    # The square of the mean weight over the mean of the squared weight: a bell of r^2, and one of r^2 / 2.
    one, two = r**2 + variance, r**2 + 2 * variance
    return r * np.sqrt(two) / one * np.exp(-(innovation**2) * variance / (one * two))


def bell(variance, innovation, squared_width):
    """Return the mean of a bell over particles of this variance, whose mean lies `innovation` off its middle."""
    total = squared_width + variance
    return np.sqrt(squared_width / total) * np.exp(-(innovation**2) / (2 * total))


# fmt: off
EXERCISES = [
    Exercise("F1.1", carry, weighted, "warm-up", cases={
        "one fits": lambda rng: (uneven(rng, 4), np.array([0, 0.3, 0, 0])),
        "all fit alike": lambda rng: (uneven(rng, 5), np.full(5, 0.2)),
    }, example=(([0.5, 0.25, 0.25], [0.1, 0.4, 0.2]), ([0.25, 0.5, 0.25], 2.667))),
    Exercise("F1.2", correct, on_demand, cases={
        "all equal": lambda rng: (rng.normal(size=4), np.full(4, 0.25), np.full(4, 0.3), 0.4, 0.5),
        "one has nearly all": lambda rng: (rng.normal(size=5), np.full(5, 0.2), 10.0 ** -np.arange(5), 0.3, 0.5),
        "never": lambda rng: (rng.normal(size=5), uneven(rng, 5), 10.0 ** -np.arange(5), 0.3, 0.0),
        "every frame": lambda rng: (rng.normal(size=6), uneven(rng, 6), rng.uniform(0.2, 1, 6), 0.6, 1.1),
        "the old weights decide": lambda rng: (rng.normal(size=4), np.array([9, 1, 1, 1]) / 12, np.ones(4), 0.5, 0.5),
    }, example=(
        ([1, 2, 3, 4], [0.25, 0.25, 0.25, 0.25], [0.1, 0.1, 0.1, 0.7], 0.5, 0.5),
        ([2, 4, 4, 4], [0.25, 0.25, 0.25, 0.25]),
    )),
    Exercise("F1.3", share_left, lambda rng: (
        rng.uniform(0.2, 2) ** 2, rng.normal(0, 2), rng.uniform(0.2, 1.5),
    ), "challenge", cases={
        "in the middle": lambda rng: (rng.uniform(0.2, 2) ** 2, 0.0, rng.uniform(0.2, 1.5)),
        "a sharp sensor": lambda rng: (1.0, rng.normal(0, 0.2), 0.01),
        "all at one place": lambda rng: (0.0, 1.0, 0.5),
    }, example=((1, 2, 1), 0.4446)),
]
