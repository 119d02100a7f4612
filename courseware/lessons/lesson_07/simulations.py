"""What the lesson simulates: copies that four resamplers make, and a corridor of one dimension with an exact answer."""

from collections import namedtuple
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from scipy.stats import norm

from course_lib.depth_mcl.particle_filter import resample

SCHEMES = ("systematic", "stratified", "multinomial", "residual")
# The wagon: metres that it is told to roll a frame, standard deviations of its rolling and of its laser (chosen).
STEP, ROLLING, LASER = 0.30, 0.05, 0.20
START, FRAMES, RUNS = 1.0, 30, 40
# The corridor with doors that look alike: where they are, how well one is seen, how long the corridor is, metres.
DOORS, SEEN, LENGTH = (2.0, 4.0, 8.0), 0.20, 10.0
BesideKalman = namedtuple("BesideKalman", "from_kalman from_truth kalman_from_truth")


@contextmanager
def numpy_global_seed(seed: int) -> Iterator[None]:
    """Seed NumPy's global generator inside the block, and leave it as it was: for libraries that draw from it."""
    before = np.random.get_state()  # noqa: NPY002 - filterpy knows no other
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002


def copies(scheme: str, w: np.ndarray, repeats: int, seed: int) -> np.ndarray:
    """Return how many copies each particle got in each of many resamplings `(repeats, N)`."""
    rng = np.random.default_rng(seed)
    return np.array([np.bincount(resample(w, rng, scheme), minlength=len(w)) for _ in range(repeats)])


def different_over_rounds(scheme: str, n: int, rounds: int, seed: int) -> np.ndarray:
    """Return how many of n equally weighted particles still differ after each round of resampling `(rounds + 1,)`."""
    rng, alive = np.random.default_rng(seed), [np.arange(n)]
    for _ in range(rounds):
        alive.append(alive[-1][resample(np.full(n, 1 / n), rng, scheme)])
    return np.array([len(np.unique(particles)) for particles in alive])


def wagon_and_laser(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return true places `(30,)` [m] of a wagon that rolls from `START`, and what its laser measures of them."""
    rng = np.random.default_rng(seed)
    true = START + np.cumsum(STEP + rng.normal(0, ROLLING, FRAMES))
    return true, true + rng.normal(0, LASER, FRAMES)


def beside_kalman(n_particles: int, kalman_step, particle_step) -> BesideKalman:
    """Return root mean square distances `(RUNS,)` [m] of both filters from each other and from the truth."""
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
    """Return the best one bell, with mean and spread of the exact belief, after each move and each door seen.

    The belief is the product of the last bell, moved on, with the doors' likelihood. At first it is even.
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
    """Return p(a door is seen | x), up to a factor, for places `(N,)`."""
    return np.exp(-((np.asarray(x)[:, None] - DOORS) ** 2) / (2 * SEEN**2)).sum(axis=1)
