"""Stages of project P1: the filter's steps one by one, then one round of figure 1 in the right order."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.project_1.recordings import wall_ahead


def initial_particles(state0, n):
    """Particles (n, 6), all at the start (6,)."""
    return np.tile(state0, (n, 1)).astype(float)


def propagate(particles, sigma, noise):
    """Particles (N, 6) after system noise sigma * noise, along each particle's own axes."""
    step = sigma * noise
    cosine, sine = np.cos(particles[:, 5]), np.sin(particles[:, 5])
    moved = particles + step
    moved[:, 0] = particles[:, 0] + cosine * step[:, 0] - sine * step[:, 1]
    moved[:, 1] = particles[:, 1] + sine * step[:, 0] + cosine * step[:, 1]
    return moved


def wrapped(moved, first):
    """Particles whose angles from component `first` on are wrapped: the task allows it."""
    return np.column_stack([moved[:, :first], wrap_angle(moved[:, first:])])


def cloud(rng: np.random.Generator) -> tuple:
    """Particles that look every way, and the noise of a wagon, which neither rises nor tilts."""
    n = int(rng.integers(3, 9))
    particles = np.column_stack([rng.uniform(-9, 9, (n, 3)), rng.uniform(-np.pi, np.pi, (n, 3))])
    sigma = np.array([rng.uniform(0.1, 0.4), rng.uniform(0.02, 0.08), 0.0, 0.0, 0.0, rng.uniform(0.2, 0.6)])
    return particles, sigma, rng.standard_normal((n, 6))


def likelihood(measured, simulated, alpha):
    """Likelihood (N,) of simulated depth images (N, H, W) for a measured one (H, W)."""
    valid = np.isfinite(measured)
    difference = np.abs(measured[valid] - simulated[:, valid])
    return (alpha / (alpha + difference)).sum(axis=1)


def images(rng: np.random.Generator) -> tuple:
    """Images with holes on both sides."""
    n, height, width = (int(k) for k in rng.integers(2, 6, 3))
    measured = rng.uniform(1, 9, (height, width))
    simulated = measured + rng.normal(0, 0.2, (n, height, width))
    simulated[rng.random(simulated.shape) < 0.15] = np.inf
    measured[rng.random(measured.shape) < 0.2] = np.nan
    measured.flat[:2], simulated[0].flat[1] = (np.nan, 3.0), np.inf
    return measured, simulated, float(rng.uniform(0.05, 0.5))


def particle_weights(values, beta):
    """Weights (N,), summing to one, of likelihoods (N,)."""
    spread = values.max() - values.min()
    normalized = (values - values.min()) / spread if spread > 0 else np.ones(len(values))
    w = np.exp(-((normalized - 1) ** 2) / beta**2)
    return w / w.sum()


def likelihoods(rng: np.random.Generator) -> tuple:
    return rng.uniform(100, 900) + rng.uniform(0, 50, int(rng.integers(3, 9))), float(rng.uniform(0.1, 0.8))


def estimate(particles, w):
    """Weighted mean state (6,) of particles (N, 6) with weights (N,)."""
    angles = particles[:, 3:]
    return np.concatenate([w @ particles[:, :3], np.arctan2(w @ np.sin(angles), w @ np.cos(angles))])


def weighted_cloud(rng: np.random.Generator) -> tuple:
    """A cloud about one state, whose yaw is often near the seam, and uneven weights."""
    n = int(rng.integers(4, 9))
    centre = np.concatenate([rng.uniform(-9, 9, 3), rng.uniform(-0.2, 0.2, 2), [rng.choice([np.pi, 0.0, 2.0])]])
    w = rng.uniform(0.1, 1, n)
    return wrapped(centre + rng.normal(0, [0.3, 0.3, 0.1, 0.05, 0.05, 0.3], (n, 6)), 3), w / w.sum()


def resample(w, u):
    """Indices (N,) of the particles that live on, ascending, for weights (N,) and an offset u in [0, 1)."""
    cumulative = np.cumsum(w)
    cumulative[-1] = 1.0  # rounding must not leave the last point beyond the sum
    return np.searchsorted(cumulative, (np.arange(len(w)) + u) / len(w), side="right")


def weights_and_offset(rng: np.random.Generator) -> tuple:
    """Uneven weights, some of them zero; an offset."""
    n = int(rng.integers(4, 11))
    w = rng.uniform(0.02, 1, n) ** 3
    w[1:][rng.random(n - 1) < 0.2] = 0.0
    return w / w.sum(), float(rng.uniform(0.05, 0.95))


def one_round(particles, measured, render, sigma, beta, noise, u):
    """Estimate (6,) after one frame, and the particles (N, 6) that live on."""
    moved = propagate(particles, sigma, noise)
    w = particle_weights(likelihood(measured, render(moved), 0.1), beta)
    return estimate(moved, w), moved[resample(w, u)]


def a_frame(rng: np.random.Generator, spread: float = 1.0) -> tuple:
    """A cloud before a frame, and the image of a camera near it. spread: 0 for a cloud in one point."""
    n = int(rng.integers(6, 12))
    true = np.array([rng.uniform(1, 5), rng.uniform(-1, 1), 1.0, 0.0, 0.0, rng.uniform(-0.3, 0.3)])
    particles = true + spread * rng.normal(0, [0.1, 0.05, 0, 0, 0, 0.03], (n, 6))
    measured = wall_ahead(true)[0] + rng.normal(0, 0.01, (3, 5))
    measured.flat[int(rng.integers(15))] = np.nan
    sigma, beta = spread * np.array([0.15, 0.05, 0, 0, 0, 0.03]), float(rng.choice([0.01, rng.uniform(0.3, 0.8)]))
    return particles, measured, wall_ahead, sigma, beta, rng.standard_normal((n, 6)), float(rng.uniform(0.05, 0.95))


# fmt: off
EXERCISES = [
    Exercise("P1.1", initial_particles, lambda rng: (rng.uniform(-3, 3, 6), int(rng.integers(1, 9))), "warm-up",
             example=(([1, 2, 0, 0, 0, 3], 2), [[1, 2, 0, 0, 0, 3], [1, 2, 0, 0, 0, 3]])),
    Exercise("P1.2", propagate, cloud, cases={
        "facing back": lambda rng: (np.full((4, 6), np.pi), np.full(6, 0.3), rng.standard_normal((4, 6))),
        "a hand-held camera": lambda rng: (np.eye(5, 6), rng.uniform(0.02, 0.3, 6), rng.standard_normal((5, 6))),
    }, others=[lambda *given: wrapped(propagate(*given), 5), lambda *given: wrapped(propagate(*given), 3)]),
    Exercise("P1.3", likelihood, images, cases={
        "nothing measured": lambda rng: (np.full((2, 3), np.nan), rng.uniform(1, 9, (4, 2, 3)), 0.1),
        "a particle that hits nothing": lambda rng: (np.full((1, 2), 4.0), np.array([[[4.1, 4]], [[np.inf] * 2]]), 0.1),
    }, example=(([[2, np.nan, 3]], [[[2, 5, np.inf]], [[2.1, 5, 3]]], 0.1), [1.0, 1.5])),
    Exercise("P1.4", particle_weights, likelihoods, cases={
        "the paper's beta": lambda rng: (likelihoods(rng)[0], 0.01),
        "all alike": lambda rng: (np.full(int(rng.integers(2, 6)), rng.uniform(100, 900)), 0.01),
        "one alone": lambda rng: (rng.uniform(100, 900, 1), 0.01),
    }, example=(([300, 310, 320], 0.5), [0.013, 0.265, 0.721])),
    Exercise("P1.5", estimate, weighted_cloud, cases={
        "on both sides of the seam": lambda rng: (np.outer([1, -1], [1, 2, 3, 0.1, 0.1, 3.1]), np.array([0.3, 0.7])),
    }),
    Exercise("P1.6", resample, weights_and_offset, cases={
        "last ones without weight": lambda rng: (np.array([0.25, 0.25, 0.5, 0, 0, 0, 0, 0]), rng.uniform(0.05, 0.95)),
        "all weight on one": lambda rng: (np.eye(6)[rng.integers(6)], rng.uniform(0.05, 0.95)),
        "equal weights": lambda rng: (np.full(8, 0.125), rng.uniform(0.05, 0.95)),
    }, example=(([0.1, 0.6, 0.0, 0.3], 0.5), [1, 1, 1, 3])),
    Exercise("P1.7", one_round, a_frame, "challenge", cases={"all at one place": lambda rng: a_frame(rng, 0)}),
]
