"""Right answers to the exercises of lesson 07 by other ways than the solution's."""

import itertools

import numpy as np
from scipy.stats import binom


def strata(w):
    """For each part of the strip the probabilities (N,) of its draw, by cutting the strip at every border."""
    n, right = len(w), np.cumsum(w)
    parts = np.zeros((n, n))
    for left, end in itertools.pairwise(np.unique(np.r_[np.arange(n + 1) / n, np.clip(right, 0, 1)])):
        middle = (left + end) / 2
        parts[min(int(middle * n), n - 1), min(np.searchsorted(right, middle), n - 1)] += n * (end - left)
    return parts


RIGHT = [
    ("07.1", lambda y, w: (np.angle(w @ np.exp(1j * y)), abs(w @ np.exp(1j * y)))),
    ("07.2", lambda w: ([int(len(w) * share) for share in w], np.modf(len(w) * w)[0] / sum(np.modf(len(w) * w)[0]))),
    ("07.3", lambda w: binom.sf(0, len(w), w).sum()),
    # From the covariance of the numbers of copies.
    ("07.4", lambda w, x: (x @ sum(np.diag(p) - np.outer(p, p) for p in strata(w)) @ x) ** 0.5 / len(w)),
]
