"""A corridor of one dimension, in which the exact answer is known: a Kalman filter, particles, and doors alike."""

from collections import namedtuple

import numpy as np
from scipy.stats import norm

# The wagon: metres that it is told to roll a frame, standard deviations of its rolling and of its laser (chosen).
STEP, ROLLING, LASER = 0.30, 0.05, 0.20
START, FRAMES, RUNS = 1.0, 30, 40
# The corridor with doors that look alike: where they are, how well one is seen, how long the corridor is, metres.
DOORS, SEEN, LENGTH = (2.0, 4.0, 8.0), 0.20, 10.0
BesideKalman = namedtuple("BesideKalman", "from_kalman from_truth kalman_from_truth")


def wagon_and_laser(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """True places `(30,)` of a wagon that rolls from `START`, and what its laser measures of them `(30,)`, metres."""
    rng = np.random.default_rng(seed)
    true = START + np.cumsum(STEP + rng.normal(0, ROLLING, FRAMES))
    return true, true + rng.normal(0, LASER, FRAMES)


def beside_kalman(n_particles: int, kalman_step, particle_step) -> BesideKalman:
    """Root mean square distances `(RUNS,)` [m] of both filters from each other and the truth, on the same data."""
    rows = []
    for seed in range(1, RUNS + 1):
        true, measured = wagon_and_laser(seed)
        belief, particles, rng = (START, 0.0), np.full(n_particles, START), np.random.default_rng(1000 + seed)
        exact, found = np.empty((2, FRAMES))
        for t, z in enumerate(measured):
            belief = kalman_step(*belief, z)
            exact[t] = belief[0]
            found[t], particles = particle_step(particles, z, rng)
        rows.append([np.sqrt(np.mean((a - b) ** 2)) for a, b in ((found, exact), (found, true), (exact, true))])
    return BesideKalman(*np.array(rows).T)


def best_bells(moves: tuple[float, ...]) -> list:
    """After each move and each door seen, the normal distribution with the mean and the spread of the belief.

    A Kalman filter carries one bell. This is the best it could do: the exact product of its bell with the doors'
    likelihood, and of that the mean and the standard deviation. At first every place in the corridor is as likely.
    """
    x = np.linspace(-LENGTH, 2 * LENGTH, 6001)
    belief, bells = np.where((x >= 0) & (x <= LENGTH), 1.0, 0.0), []
    for move in moves:
        if bells:
            belief = norm.pdf(x, bells[-1].mean() + move, np.hypot(bells[-1].std(), ROLLING))
        belief = belief * door_likelihood(x)
        mean = np.average(x, weights=belief)
        bells.append(norm(mean, np.sqrt(np.average((x - mean) ** 2, weights=belief))))
    return bells


def door_likelihood(x: np.ndarray) -> np.ndarray:
    """p(a door is seen | x), up to a factor, for places `(N,)`."""
    return np.exp(-((np.asarray(x)[:, None] - DOORS) ** 2) / (2 * SEEN**2)).sum(axis=1)
