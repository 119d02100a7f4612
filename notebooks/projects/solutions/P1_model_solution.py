"""A model solution of project P1, in NumPy alone: one of many ways, and not the best.

Try the project first. The stages are what the equations say. `localize` does three things that the paper does not: it
expects the camera as far forward as it has been moving, it draws twice a frame (the second time closer about the
best), and it lets more than one particle count in the estimate.

    python3 course.py score P1 notebooks/projects/solutions/P1_model_solution.py
"""

import numpy as np


def initial_particles(state0, n):
    """Eqs (3), (4): all particles at the start."""
    return np.tile(state0, (n, 1)).astype(float)


def propagate(particles, sigma, noise):
    """Eq. (5), forward and left along each particle's own axes."""
    step = sigma * noise
    cosine, sine = np.cos(particles[:, 5]), np.sin(particles[:, 5])
    moved = particles + step
    moved[:, 0] = particles[:, 0] + cosine * step[:, 0] - sine * step[:, 1]
    moved[:, 1] = particles[:, 1] + sine * step[:, 0] + cosine * step[:, 1]
    return moved


def likelihood(measured, simulated, alpha):
    """Eq. (8): pixels that were not measured are left out; a simulated miss counts 0."""
    valid = np.isfinite(measured)
    difference = np.abs(measured[valid] - simulated[:, valid])
    return (alpha / (alpha + difference)).sum(axis=1)


def particle_weights(values, beta):
    """Eqs (9), (10), (11)."""
    spread = values.max() - values.min()
    normalized = (values - values.min()) / spread if spread > 0 else np.ones(len(values))
    w = np.exp(-((normalized - 1) ** 2) / beta**2)
    return w / w.sum()


def estimate(particles, w):
    """Eq. (12), angles as points on the circle."""
    angles = particles[:, 3:]
    return np.concatenate([w @ particles[:, :3], np.arctan2(w @ np.sin(angles), w @ np.cos(angles))])


def resample(w, u):
    """Section 3.4, systematic: N equal steps through the summed weights."""
    cumulative = np.cumsum(w)
    cumulative[np.flatnonzero(w)[-1] :] = 1.0  # rounding must not draw a particle that weighs nothing
    return np.searchsorted(cumulative, (np.arange(len(w)) + u) / len(w), side="right")


def one_round(particles, measured, render, sigma, beta, noise, u):
    """Figure 1: move, render, weigh, estimate, resample."""
    moved = propagate(particles, sigma, noise)
    w = particle_weights(likelihood(measured, render(moved), 0.1), beta)
    return estimate(moved, w), moved[resample(w, u)]


def localize(renderer, camera, frames, start, n_particles, rng):
    """Estimates (T, 6): as far forward as in the frames before, a wide round, a close one."""
    wide = np.array([0.15, 0.05, 0, 0, 0, np.deg2rad(2.0)])
    first = 3 * n_particles // 5
    second = n_particles - first
    last, speed = np.array(start, dtype=float), 0.1
    found = []
    for measured in frames:
        expected = last + speed * np.array([np.cos(last[5]), np.sin(last[5]), 0, 0, 0, 0])
        particles = propagate(initial_particles(expected, first), wide, rng.standard_normal((first, 6)))
        w = particle_weights(likelihood(measured, renderer.render(particles), 0.1), 0.1)
        parents = rng.permutation(particles[resample(w, rng.random())])[:second]
        close = propagate(parents, 0.3 * wide, rng.standard_normal((second, 6)))
        state = estimate(close, particle_weights(likelihood(measured, renderer.render(close), 0.1), 0.2))
        forward = np.hypot(*(state - last)[:2])
        speed = 0.7 * speed + 0.3 * forward  # one step alone is as noisy as two estimates
        last = state
        found.append(state)
    return np.array(found)
