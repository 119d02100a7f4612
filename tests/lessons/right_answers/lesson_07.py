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


def error_by_parts(w, x):
    return np.sqrt(np.sum(np.maximum(strata(w) @ x**2 - (strata(w) @ x) ** 2, 0))) / len(w)


RIGHT = [
    ("07.1", lambda y, w: (np.angle(w @ np.exp(1j * y)), abs(w @ np.exp(1j * y)))),
    ("07.1", lambda y, w: [np.array([np.angle(w @ np.exp(1j * y))]), np.float32(abs(w @ np.exp(1j * y)))]),
    ("07.2", lambda w: [(len(w) * w).astype(int), (len(w) * w % 1) / np.sum(len(w) * w % 1)]),
    ("07.2", lambda w: ([int(len(w) * share) for share in w], np.modf(len(w) * w)[0] / sum(np.modf(len(w) * w)[0]))),
    ("07.3", lambda w: len(w) - sum((1 - share) ** len(w) for share in w)),
    ("07.3", lambda w: np.array([np.sum(1 - np.prod(np.tile(1 - w, (len(w), 1)), axis=0))])),
    ("07.3", lambda w: binom.sf(0, len(w), w).sum()),
    ("07.4", error_by_parts),
    # From the covariance of the numbers of copies.
    ("07.4", lambda w, x: (x @ sum(np.diag(p) - np.outer(p, p) for p in strata(w)) @ x) ** 0.5 / len(w)),
    ("07.4", lambda w, x: np.float32([error_by_parts(w, x)])),
]
