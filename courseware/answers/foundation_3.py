"""Exercises of F3: many independent estimates, a filter with gaps, two estimates that err together."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise


def fuse(means, covariances):
    """Mean (d,) and covariance (d, d) of n independent estimates (n, d) with covariances (n, d, d)."""
    # Certainties add, and so do certainties times means.
    certainties = np.linalg.inv(covariances)
    covariance = np.linalg.inv(certainties.sum(axis=0))
    return covariance @ np.einsum("nij,nj->i", certainties, means), covariance


def spread(rng: np.random.Generator, d: int) -> np.ndarray:
    """Make a covariance (d, d) with long and short axes and with correlations."""
    A = rng.normal(size=(d, d)) * rng.uniform(0.3, 2, d)
    return A @ A.T + 0.1 * np.eye(d)


def several(rng: np.random.Generator) -> tuple:
    n, d = int(rng.integers(2, 5)), int(rng.integers(2, 4))
    return rng.normal(0, 3, (n, d)), np.array([spread(rng, d) for _ in range(n)])


def track(z, x, P, F, Q, H, R):
    """Means (T, d) and covariances (T, d, d) after each frame of the measurements z (T, m); a row of nan is a gap.

    x (d,), P (d, d): the estimate before the first frame, which begins with a prediction.
    """
    means, covariances = [], []
    for one in z:
        x, P = F @ x, F @ P @ F.T + Q
        if not np.isnan(one).any():  # without a measurement the prediction stands
            K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
            x, P = x + K @ (one - H @ x), P - K @ H @ P
        means.append(x)
        covariances.append(P)
    return np.array(means), np.array(covariances)


def drive(rng: np.random.Generator, gaps: float = 0.3) -> tuple:
    """Make measurements of a place, with gaps, and a model of place and speed."""
    z = np.where(rng.random((5, 1)) < gaps, np.nan, rng.normal(0, 2, (5, 1)))
    step = np.array([[1, rng.uniform(0.2, 1)], [0, 1]])
    return z, rng.normal(size=2), spread(rng, 2), step, spread(rng, 2) / 9, np.eye(2)[:1], rng.uniform(0.1, 1, (1, 1))


def fuse_correlated(x0, P0, x1, P1, C):
    """Best mean (d,) and covariance (d, d) of two estimates whose errors have the cross covariance C (d, d).

    C = E[e0 e1^T]. Both estimates are of the same state: x = x0 + K (x1 - x0), with the K of the least covariance.
    """
    # The derivative of the covariance with respect to K vanishes where K S = P0 - C.
    S = P0 + P1 - C - C.T
    K = (P0 - C) @ np.linalg.inv(S)
    return x0 + K @ (x1 - x0), P0 - K @ (P0 - C).T


def dependent(rng: np.random.Generator) -> tuple:
    d = int(rng.integers(2, 4))
    both = spread(rng, 2 * d)
    return rng.normal(0, 2, d), both[:d, :d], rng.normal(0, 2, d), both[d:, d:], both[:d, d:]


# fmt: off
EXERCISES = [
    Exercise("F3.1", fuse, several, "warm-up", cases={
        "one alone": lambda rng: (rng.normal(size=(1, 2)), spread(rng, 2)[None]),
        "nearly useless beside good": lambda rng: (rng.normal(size=(2, 2)), np.array([np.eye(2), 1e4 * np.eye(2)])),
    }),
    Exercise("F3.2", track, drive, cases={
        "a gap first": lambda rng: (np.array([[np.nan], [1.0], [0.5]]), *drive(rng)[1:]),
        "gaps only": lambda rng: (np.full((3, 1), np.nan), *drive(rng)[1:]),
        "no gap": lambda rng: drive(rng, 0.0),
    }),
    Exercise("F3.3", fuse_correlated, dependent, "challenge", cases={
        "independent": lambda rng: (np.zeros(2), spread(rng, 2), np.ones(2), spread(rng, 2), np.zeros((2, 2))),
        "the second made from the first": lambda rng: (
            np.zeros(2), (P := spread(rng, 2)) + spread(rng, 2), np.ones(2), P, P),
    }),
]
