"""Copies that four resamplers make, a bug in one of them, and a stretch of the corridor that the filter follows."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.particle_filter import resample
from course_lib.lessons.lesson_07.filter_stepper import Settings, corridor_stretch, look, start, step

SCHEMES = ("systematic", "stratified", "multinomial", "residual")


@contextmanager
def numpy_global_seed(seed: int) -> Iterator[None]:
    """Seed NumPy's global generator inside the block, and leave it as it was: for libraries that draw from it."""
    before = np.random.get_state()  # noqa: NPY002 - filterpy knows no other
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002


def mean_copies(draw: Callable[[np.ndarray], np.ndarray], w: np.ndarray, repeats: int) -> np.ndarray:
    """How many copies each particle gets in the mean `(N,)`, over many draws of indices."""
    counts = [np.bincount(np.asarray(draw(w)), minlength=len(w)) for _ in range(repeats)]
    return np.mean(counts, axis=0)


def copies(scheme: str, w: np.ndarray, repeats: int, seed: int) -> np.ndarray:
    """How many copies each particle got in each of many resamplings `(repeats, N)`."""
    rng = np.random.default_rng(seed)
    return np.array([np.bincount(resample(w, rng, scheme), minlength=len(w)) for _ in range(repeats)])


def different_over_rounds(scheme: str, n: int, rounds: int, seed: int) -> np.ndarray:
    """How many of n equally weighted particles are still different after each round of resampling `(rounds + 1,)`."""
    rng, alive, w = np.random.default_rng(seed), np.arange(n), np.full(n, 1 / n)
    counts = [n]
    for _ in range(rounds):
        alive = alive[resample(w, rng, scheme)]
        counts.append(len(np.unique(alive)))
    return np.array(counts)


class FollowedStretch(NamedTuple):
    """What the stepper's filter made of its stretch, frame by frame."""

    errors: np.ndarray
    """`(T,)` distance of the estimate from the camera on the floor, metres."""
    ess: np.ndarray
    """`(T,)` effective sample size."""
    spread: float
    """Standard deviation of the particles along x in the last frame, metres."""


def follow(beta: float, n_particles: int = 50, seed: int = 1, resampled: bool = True) -> FollowedStretch:
    """The stepper's four steps over its whole stretch, with the resampling or without it."""
    stretch, settings = corridor_stretch(), Settings(0.1, beta, n_particles, 1.0, seed)
    state, errors, ess = start(stretch), [], []
    while True:
        view = look(state, settings, stretch)
        errors.append(np.linalg.norm(view.estimate[:2] - stretch.true[state.frame, :2]))
        ess.append(view.ess)
        if state.frame == len(stretch.true) - 1:
            return FollowedStretch(np.array(errors), np.array(ess), float(view.particles[:, 0].std()))
        state = step(state._replace(done="resample" if resampled else "estimate"), "propagate", view)
