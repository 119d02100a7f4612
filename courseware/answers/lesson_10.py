"""Exercises of lesson 10: draws from free cells, injected particles, sampling until it is enough, distinct places."""

import functools

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.lesson_10 import adaptive_count

kld_count = functools.cache(adaptive_count.kld_count)  # a check asks for thousands


def free_places(free, cell, u):
    """Places (n, 2) in metres, evenly from the free cells of a grid (rows, columns); u (n, 3) in [0, 1)."""
    rows, columns = np.nonzero(free)
    chosen = (u[:, 0] * len(rows)).astype(int)
    return cell * np.column_stack([columns[chosen] + u[:, 1], rows[chosen] + u[:, 2]])


def grids(rng):
    """Oblong grids, a fifth to two thirds free; one in four has a single free cell."""
    free = rng.random((rng.integers(3, 6), rng.integers(7, 11))) < rng.uniform(0.3, 0.7) * (rng.random() > 0.25)
    free[-1, 0] = True
    return free, float(rng.choice([0.1, 0.25, 0.5])), rng.random((rng.integers(5, 12), 3))


def new_shares(scores, short, long):
    """Share (T,) of particles to draw from anywhere, for every frame; NaN scores change nothing."""
    s = L = scores[0]
    shares = []
    for score in scores:
        if not np.isnan(score):
            s, L = s + short * (score - s), L + long * (score - L)
        shares.append(max(0, 1 - s / L))
    return np.array(shares)


def falling_scores(rng):
    """A level score, a fall, and a rise, with frames in the dark before the fall and in it."""
    level, low = rng.uniform(0.7, 0.95), rng.uniform(0.1, 0.5)
    scores = np.repeat([level, low, level], [rng.integers(5, 9), 8, 10])
    scores += rng.uniform(-0.03, 0.03, len(scores))
    scores[[3, 9, 10, -2]] = np.nan
    return scores, float(rng.uniform(0.3, 0.6)), float(rng.uniform(0.02, 0.1))


def draws_needed(bins, least):
    """How many draws KLD-sampling makes; bins (T,): where each draw would land."""
    seen = set()
    for n, one in enumerate(bins, start=1):
        seen.add(int(one))
        if n >= kld_count(len(seen), least, 10**6):
            return n
    return len(bins)


def landings(rng):
    """Bins of 400 draws from few or many places, the last draws from elsewhere; bin numbers are no indices."""
    numbers, k = rng.choice(10_000, 50, replace=False) - 500, int(rng.choice([1, 3, 8, 40]))
    early = rng.choice(numbers[:k], 350, p=rng.dirichlet(np.full(k, 0.7)))
    return np.append(early, rng.choice(numbers[40:], 50)), int(rng.choice([20, 150]))


def distinct_places(states, scores, metres, radians):
    """Indices of the best state of every place, best first; states (n, 3) are [x, y, yaw]."""
    kept = []
    for i in np.argsort(-scores):
        apart = np.hypot(*(states[kept, :2] - states[i, :2]).T) if kept else np.array([])
        turned = np.abs(wrap_angle(states[kept, 2] - states[i, 2])) if kept else np.array([])
        if not ((apart < metres) & (turned < radians)).any():
            kept.append(int(i))
    return np.array(kept)


def clouds_of_states(rng):
    """Clouds about places of which two share a position, two share a heading, and one looks along the seam."""
    offsets = np.array([[0, 0, 0.3], [0, 0, 2.0], [4, 0, 0.3], [0, 5, np.pi], [9, 9, -1.0]])
    places = np.repeat(offsets + np.append(rng.uniform(0, 10, 2), 0), int(rng.integers(5, 9)), axis=0)
    states = places + rng.uniform(-1, 1, places.shape) * [0.5, 0.5, 0.25]
    states[:, 2] = wrap_angle(states[:, 2])
    return rng.permutation(states), rng.permutation(np.linspace(0.2, 0.95, len(states))), 0.6, 0.35


def search_numbers(bins, miss, probability):
    """Least number of even draws, and the KLD error [nats], for a building of so many equally likely bins."""
    from scipy.stats import norm

    # The camera's bin gets none of n draws with probability (1 - 1 / bins)^n; (10.3) is solved for the error.
    least = int(np.ceil(np.log(miss) / np.log(1 - 1 / bins)))
    share = 2 / (9 * (bins - 1))
    bracket = 1 - share + np.sqrt(share) * norm.ppf(probability)
    return least, (bins - 1) / (2 * least) * bracket**3


# fmt: off
EXERCISES = [
    Exercise("10.1", free_places, grids, "warm-up", cases={
        # The numbers are at the very start of four free cells: cutting off differs from rounding up.
        "numbers on the borders": lambda rng: (np.array([[False, True, True], [True, False, True]]), 0.5,
                                               np.column_stack([[0.0, 0.25, 0.5, 0.75], rng.random((4, 2))])),
    }, example=(([[False, True], [True, True]], 0.5, [[0.1, 0.5, 0.0], [0.9, 0.5, 0.5]]), [[0.75, 0.0], [0.75, 0.75]])),
    Exercise("10.2", new_shares, falling_scores, cases={
        "the example of the task": lambda rng: (np.array([0.8, 0.8, np.nan, 0.4]), 0.5, 0.1),
    }, example=(([0.8, 0.8, np.nan, 0.4], 0.5, 0.1), [0, 0, 0, 0.211])),
    Exercise("10.3", draws_needed, landings, cases={
        "two bins only": lambda rng: (np.array([7, 7, 7, *[2, 7] * 48, 2]), 20),
        "a new bin at the bound": lambda rng: (np.array([5] * 19 + [9, 5] * 40), 20),
        "fewer draws than the least": lambda rng: (np.array([3, 3, 8, 3, 1]), 20),
        # More draws than the lesson's upper bound, and still they are not enough.
        "ever new bins": lambda rng: (np.arange(3_200) % 400, 20),
    }),
    Exercise("10.4", distinct_places, clouds_of_states, cases={
        "headings at the seam": lambda rng: (np.array([[0, 0, 3.1], [0.1, 0, -3.1], [0, 0, 0], [5, 0, 3.1]]),
                                             np.array([0.7, 0.9, 0.5, 0.6]), 0.5, 0.3),
        "exactly at the limit": lambda rng: (np.array([[1.0, 2.0, 0.4], [1.5, 2.0, 0.4], [1.5, 2.25, 0.4]]),
                                             np.array([0.9, 0.5, 0.4]), 0.5, 0.3),
        "ahead and back": lambda rng: (np.column_stack([np.zeros((4, 2)), [0.1, -0.1, 3.1, -3.1]]),
                                       rng.permutation([0.9, 0.8, 0.6, 0.5]), 0.5, 0.3),
        "one state alone": lambda rng: (np.array([[1.0, 2.0, 3.0]]), np.array([0.7]), 0.5, 0.3),
    }, example=(([[0, 0, 3.1], [0.1, 0, -3.1], [0, 0, 0], [5, 0, 3.1]], [0.7, 0.9, 0.5, 0.6], 0.5, 0.3), [1, 3, 2])),
    Exercise("10.5", search_numbers, lambda rng: (
        int(10 ** rng.uniform(0.7, 4)), float(10 ** rng.uniform(-3, -0.7)), float(rng.uniform(0.9, 0.999)),
    ), "challenge", cases={
        "two bins with a whole number": lambda rng: (2, 0.25, 0.99),
    }, example=((500, 0.05, 0.99), (1497, 0.1922))),
]
