"""Exercises of lesson 08: the paper's error, a row of its table 1, noticing a loss, what frames that are alike say."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise


def nearest_distances(estimated, path):
    """Horizontal distance in metres (T,) from estimates (T, 3) to the nearest point of a path (P, 3)."""
    # Distances from each estimate to all points of the path; keep the least.
    distances = [np.linalg.norm(path[:, :2] - p, axis=1) for p in estimated[:, :2]]
    return np.min(distances, axis=1)


def track_and_path(rng):
    """The floor is uneven and the camera bobs: the nearest point in space need not be the nearest on the floor."""
    n, p = int(rng.integers(4, 8)), int(rng.integers(9, 15))
    path = np.column_stack([np.linspace(0, 6, p), 0.3 * rng.normal(size=p), 0.2 * rng.normal(size=p)])
    return np.column_stack([rng.uniform(0, 6, n), rng.normal(0, 0.3, n), rng.uniform(0.8, 1.2, n)]), path


def above_the_path(rng):
    """Estimates above points of the path, in another order."""
    path = np.column_stack([np.arange(6.0), rng.normal(size=6), np.zeros(6)])
    return path[[4, 0, 2]] + [0.0, 0.0, 1.0], path


def table_row(errors):
    """Median [m], sigma about zero [m], and share of errors of at most 0.30 m."""
    # Median, root mean square about zero, share within three of the paper's sigma.
    return np.median(errors), np.sqrt(np.mean(errors**2)), np.mean(errors <= 0.30)


def errors_of_a_run(rng):
    errors = np.abs(rng.normal(0.1, 0.2, rng.integers(12, 30))) + 0.05
    errors[rng.integers(errors.size)] = 0.30  # exactly at the gate: "at most" lets it in
    return (errors,)


def lost_since(scores, limit, patience):
    """Frame at which `patience` scores in a row are below `limit` for the first time; -1 if never."""
    # Count low scores in a row; a good score starts the count again.
    in_a_row = 0
    for frame, score in enumerate(scores):
        in_a_row = in_a_row + 1 if score < limit else 0
        if in_a_row == patience:
            return frame
    return -1


def scores_with_dips(rng):
    """Scores with two short dips and, mostly, a long one: at the start, in the middle, at the end, or cut off there."""
    patience, n, limit = int(rng.integers(2, 6)), int(rng.integers(40, 61)), rng.uniform(0.3, 0.6)
    scores = limit + rng.uniform(0.01, 0.2, size=n)
    low = limit - rng.uniform(0.01, 0.2, size=n)
    start = rng.choice([0, 30, n - patience, n - patience + 1, n], p=[0.2, 0.2, 0.3, 0.2, 0.1])
    for first, length in ((8, patience - 1), (18, patience - 1), (start, patience + int(rng.integers(0, 3)))):
        scores[first : first + length] = low[first : first + length]
    scores[8 + patience - 1] = limit  # which is not below it
    return scores, limit, patience


def effective_frames(n, a):
    """Number of independent errors whose mean is as sure as that of n errors of correlation a^k at k frames apart."""
    # Sum the correlations of all n^2 pairs. For our runs: 164 frames of 304 for ours, about 2 for Fallon's.
    pairs = sum((n - k) * a**k for k in range(1, n))  # those k apart, each once
    return n**2 / (n + 2 * pairs)


def length_and_likeness(rng, low=0.05, high=0.95):
    return int(rng.integers(3, 60)), float(rng.uniform(low, high))


# fmt: off
EXERCISES = [
    Exercise("08.1", nearest_distances, track_and_path, "warm-up", cases={
        "all errors zero": above_the_path,
        "a single estimate": lambda rng: (rng.normal(size=(1, 3)), rng.normal(size=(2, 3))),
        # The nearest point in space, on the hump, is not the nearest on the floor plan.
        "a hump in the floor": lambda rng: (np.array([[1.3, 0.1, 1]]), np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0.9]])),
    }, example=(([[1.0, 0.4, 1.0]], [[0, 0, 0], [1, 0, 0], [2, 0, 0]]), [0.4])),
    Exercise("08.2", table_row, errors_of_a_run, tolerance=1e-9, cases={
        # No scatter, and yet an error: just the limit.
        "all errors equal": lambda rng: (np.full(int(rng.integers(3, 9)), 0.30),),
    }, example=(([0.1, 0.1, 0.1, 0.5],), (0.1, 0.265, 0.75))),
    Exercise("08.3", lost_since, scores_with_dips, cases={
        # Rows that are one too short, with single good scores between them: nothing may be carried over.
        "short dips only": lambda rng: (np.array([0.2 if c == "l" else 0.7 for c in "llllhllllhhhllhlllh"]), 0.5, 5),
        # First not for long enough, later long enough.
        "low in the first frames": lambda rng: (np.array([2, 3, 9, 8, 9, 1, 2, 1, 2, 9]) / 10, 0.5, 3),
        "lost twice": lambda rng: (np.array([9, 2, 2, 2, 9, 9, 1, 2, 1]) / 10, 0.5, 2),
        "fewer scores than patience": lambda rng: (np.array([0.1, 0.2]), 0.5, 4),
        "lost from the start": lambda rng: (np.full(6, 0.1), 0.5, 3),
        "never low": lambda rng: (np.full(8, 0.9), 0.5, 2),
    }, example=(([0.6, 0.4, 0.6, 0.4, 0.3, 0.3], 0.45, 2), 4)),
    Exercise("08.4", effective_frames, length_and_likeness, "challenge", cases={
        "independent frames": lambda rng: length_and_likeness(rng, 0, 0),
        "all the same": lambda rng: length_and_likeness(rng, 1, 1),
        # Errors that tend to change their sign: their mean is surer than the mean of independent ones.
        "a below zero": lambda rng: length_and_likeness(rng, -0.8, -0.2),
        "four frames": lambda rng: (4, 0.5),
        "a long run": lambda rng: (304, 0.99),
    }, example=((4, 0.5), 1.939)),
]
