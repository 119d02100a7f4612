"""Exercises of F1: weights that are carried, resampling on demand, how fast a weighted set wears out."""

import numpy as np

from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        product = w * likelihood => product = likelihood
        You have forgotten the old weights. They hold all that was seen before: multiply by them.
        product = w * likelihood => product = w + likelihood
        You add. Independent measurements multiply their probabilities.
        product / product.sum() => product
        product / product.sum() => w * likelihood / likelihood.sum()
        product / product.sum() => product / np.linalg.norm(product)
        Your weights do not sum to one. Divide by their sum before you count.
        product / product.sum() => product / product.max()
        Your largest weight is one. The *sum* of all weights must be one.
        1 / np.sum(new**2) => 1 / np.sum(w**2)
        Your weights are right. You count with the old ones: take the new ones.
        1 / np.sum(new**2) => np.sum(new**2)
        1 / np.sum(new**2) => len(new) * np.sum(new**2)
        Your weights are right. The effective sample size is one *over* the sum of their squares.
        1 / np.sum(new**2) => 1 / np.sum(new) ** 2
        Square each weight first, then add. Yours is the square of the sum, which is always one.
        1 / np.sum(new**2) => 1 / np.sum(new**2) / len(new)
        1 / np.sum(new**2) => 1 / np.mean(new**2)
        Your weights are right. The effective sample size is a number of particles: add squares, divide by no N.
        1 / np.sum(new**2) => np.count_nonzero(new)
        You count the weights that are not zero. A tiny weight must count less than a large one.
        1 / np.sum(new**2) => 1 / np.max(new)
        One over the largest weight looks at one particle only. All weights take part: add their squares.
    """),
    Exercise("F1.2", correct, on_demand, cases={
        "all equal": lambda rng: (rng.normal(size=4), np.full(4, 0.25), np.full(4, 0.3), 0.4, 0.5),
        "one has nearly all": lambda rng: (rng.normal(size=5), np.full(5, 0.2), 10.0 ** -np.arange(5), 0.3, 0.5),
        "never": lambda rng: (rng.normal(size=5), uneven(rng, 5), 10.0 ** -np.arange(5), 0.3, 0.0),
        "every frame": lambda rng: (rng.normal(size=6), uneven(rng, 6), rng.uniform(0.2, 1, 6), 0.6, 1.1),
        "the old weights decide": lambda rng: (rng.normal(size=4), np.array([9, 1, 1, 1]) / 12, np.ones(4), 0.5, 0.5),
    }, mistakes="""
        w * likelihood => likelihood
        You have forgotten the old weights. Without resampling they hold all that was seen before: multiply.
        share * n => np.inf
        You resample in every frame. Do it only where the effective sample size is below share times N.
        share * n => 0
        share * n => share
        Yours hardly ever resamples. N_eff is a number of particles: compare it with share *times N*.
        >= share * n => < share * n
        The decision is the wrong way round: resample where the effective sample size is *small*.
        np.full(n, 1 / n) => w
        np.full(n, 1 / n) => w[indices]
        np.full(n, 1 / n) => w[indices] / np.sum(w[indices])
        After resampling each copy weighs 1/N. You keep the weights, so they count twice: once as copies.
        np.full(n, 1 / n) => np.ones(n)
        After resampling all your weights are 1. They must sum to one, so each is 1/N.
        / np.sum(w * likelihood) =>
        Your weights do not sum to one. Divide by their sum before you decide.
        n, w = len(w), w * => n, old, w = len(w), w, w * and also 1 / np.sum(w**2) => 1 / np.sum(old**2)
        You decide by the weights before this frame. Its measurement is what makes them uneven.
        1 / np.sum(w**2) => np.sum(likelihood) ** 2 / np.sum(likelihood**2)
        You decide by this frame's likelihood alone. The carried weights say how many particles take part.
        np.cumsum(w) => np.cumsum(likelihood / np.sum(likelihood))
        You draw by this frame's likelihood. Draw by the carried weights.
        return x[indices] => return indices
        You give back the numbers of the drawn particles. The task asks for the particles themselves.
        return x[indices] => return x
        Your weights are right. These are the old particles: take the drawn ones.
        1 / np.sum(w**2) => 1 / np.max(w)
        One over the largest weight is not the effective sample size. Add the squares of all weights.
        + offset) => + 0.5)
        `offset` says where in its field each tooth of the comb stands. Yours always stands in the middle.
    """),
    Exercise("F1.3", share_left, lambda rng: (
        rng.uniform(0.2, 2) ** 2, rng.normal(0, 2), rng.uniform(0.2, 1.5),
    ), "challenge", cases={
        "in the middle": lambda rng: (rng.uniform(0.2, 2) ** 2, 0.0, rng.uniform(0.2, 1.5)),
        "a sharp sensor": lambda rng: (1.0, rng.normal(0, 0.2), 0.01),
        "all at one place": lambda rng: (0.0, 1.0, 0.5),
    }, mistakes="""
        ... => return bell(variance, innovation, r**2)
        That is the mean weight. N_eff / N is its *square*, divided by the mean of the squared weight.
        ... => return bell(variance, innovation, r**2) ** 2
        That is the square of the mean weight. Divide it by the mean of the squared weight.
        ... => return bell(variance, innovation, r**2 / 2)
        That is the mean of the squared weight. It belongs below the line.
        ... => return bell(variance, innovation, r**2) / bell(variance, innovation, r**2 / 2)
        The mean weight, above the line, enters squared.
        ... => return bell(variance, innovation, r**2) ** 2 / bell(variance, innovation, 2 * r**2)
        The squared bell is *narrower* than the bell: its variance is half of r^2.
        * np.exp(-(innovation**2) * variance / (one * two)) =>
        Yours holds for a measurement in the middle of the particles. How far off it lies counts, too.
        * variance / (one * two) => * variance / (2 * one * two)
        Your exponent is half of the right one: the mean weight enters squared, so its exponent doubles.
        r * np.sqrt(two) / one => 1
        The exponent is right. Each integral also has a factor in front, a ratio of two widths.
        r * np.sqrt(two) / one * => one / (r * np.sqrt(two)) *
        ... => return 1 / share_left(variance, innovation, r)
        Something is upside down: a share is at most one.
        + variance => + variance**2 and also 2 * variance => 2 * variance**2 and also * variance / => * variance**2 /
        `variance` is squared already. It adds to r^2 as it is.
        (innovation**2) => np.abs(innovation)
        The exponent of a bell has the *square* of the distance.
    """),
]
