"""Exercises of lesson 05: spread, noise along own axes, who is near, a step of the Bayes filter, the least noise."""

import numpy as np

from course_lib.geometry import wrap_angle
from courseware.lessons.kit.exercise import Exercise


def spread_after(spread0, sigma, t):
    """Standard deviations (6,) after t frames of noise sigma (6,), from spread0 (6,) at the start."""
    # Variances add, that of the start once, that of a step t times.
    return np.sqrt(spread0**2 + t * sigma**2)


def propagate_own_axes(particles, sigma_forward, sigma_left, draws):
    """Particles (N, 6) moved by noise along each one's own forward and left axes."""
    # Turn each step by the particle's own yaw.
    forward, left, yaw = sigma_forward * draws[:, 0], sigma_left * draws[:, 1], particles[:, 5]
    moved = particles.copy()
    moved[:, 0] += forward * np.cos(yaw) - left * np.sin(yaw)
    moved[:, 1] += forward * np.sin(yaw) + left * np.cos(yaw)
    return moved


def particles_and_draws(rng: np.random.Generator) -> tuple:
    n = int(rng.integers(4, 9))
    least, greatest = [5, -1, 0.8, -0.3, -0.3, -np.pi], [15, 1, 1.2, 0.3, 0.3, np.pi]
    return rng.uniform(least, greatest, (n, 6)), rng.uniform(0.1, 0.3), rng.uniform(0.02, 0.09), rng.normal(size=(n, 2))


def four_headings(rng: np.random.Generator) -> tuple:
    """Make headings along the axes and at the seam, one step forward and one to the left."""
    particles = np.tile([10.0, 0.5, 1.0, 0.1, -0.2, 0.0], (8, 1))
    particles[:, 5] = np.tile(np.deg2rad([0, 90, -90, -180]), 2)
    return particles, 0.2, 0.05, np.repeat(np.eye(2), 4, axis=0)


def share_near(particles, state, radius, angle):
    """Share of particles (N, 6) within radius [m] and angle [rad] of a state (6,)."""
    # Near on the floor, and near on the circle.
    near = np.hypot(particles[:, 0] - state[0], particles[:, 1] - state[1]) <= radius
    turned = np.abs(wrap_angle(particles[:, 5] - state[5])) <= angle
    return np.mean(near & turned)


def cloud_and_state(rng: np.random.Generator) -> tuple:
    """Make a cloud about as wide as radius and angle, mostly about the wrap. At times one is just `radius` away."""
    # Eighths of a metre are exact in floating point, so that a distance can equal the radius.
    radius, angle = rng.choice([0.125, 0.25]), np.deg2rad(rng.uniform(5, 15))
    yaw = rng.choice([np.pi, rng.uniform(-2, 2)], p=[0.8, 0.2])
    middle = np.array([*rng.integers(40, 121, 2) / 8, 1.0, 0, 0, yaw])
    scatter = [0.8 * radius, 0.8 * radius, 0.8 * radius, 2 * angle, 2 * angle, angle]
    particles = middle + rng.standard_normal((int(rng.integers(40, 81)), 6)) * scatter
    particles[:3, 5] += np.pi
    state = middle + np.array([0, 0, 0.3 * radius, 0, 0, -0.3 * angle])
    if rng.random() < 0.5:
        particles[-1] = state + np.array([radius, 0, 0, 0, 0, 0])
    particles[:, 5], state[5] = wrap_angle(particles[:, 5]), wrap_angle(state[5])
    return particles, state, radius, angle


def a_radius_and_an_angle_of_0(rng: np.random.Generator) -> tuple:
    """Only the two particles at the state itself are near."""
    particles = np.tile([10.0, 0.5, 1.0, 0, 0, 0.5], (4, 1))
    particles[1, 0] += 0.25
    particles[2, 5] += 0.25
    return particles, particles[0].copy(), 0.0, 0.0


def yaws_at_the_seam(rng: np.random.Generator) -> tuple:
    state = np.array([10.0, 0.5, 1.0, 0, 0, np.deg2rad(-179)])
    return state[None] * [1, 1, 1, 1, 1, -1], state, 0.1, np.deg2rad(5)


def bayes_step(bel, moves, doors, seen, hit, false_alarm):
    """Belief (n,) over the cells of a corridor with an end, after one move and one look."""
    predicted = np.zeros(len(bel))
    for k, p in enumerate(moves):
        target = np.minimum(np.arange(len(bel)) + k, len(bel) - 1)  # whoever would pass the end stops there
        np.add.at(predicted, target, p * bel)
    p_door = np.where(doors, hit, false_alarm)
    corrected = (p_door if seen else 1 - p_door) * predicted
    return corrected / corrected.sum()


def corridor_with_doors(rng: np.random.Generator, n_moves: int = 3) -> tuple:
    n = int(rng.integers(8, 15))
    doors, moves = rng.permutation(np.arange(n) < 3), rng.dirichlet(np.array([2, 5, 2])[:n_moves])
    return rng.dirichlet(np.ones(n)), moves, doors, rng.random() < 0.5, rng.uniform(0.6, 0.95), rng.uniform(0.05, 0.3)


def min_sigma(step, n, frames, p):
    """Least sigma [m] at which in each frame, with probability p for all, one of n particles makes the step."""
    # p = (1 - Phi(step / sigma)^n)^frames. For the wagon 0.056 m: 0.035 m keeps up in the mean only, 0.15 m has room.
    from scipy.stats import norm

    one_frame = p ** (1 / frames)
    return step / norm.ppf((1 - one_frame) ** (1 / n))


# fmt: off
EXERCISES = [
    Exercise("05.1", spread_after, lambda rng: (*rng.uniform(0, 0.6, (2, 6)), rng.integers(2, 60)), "warm-up", cases={
        "no frame": lambda rng: (*rng.uniform(0.1, 0.5, (2, 6)), 0),
        "no noise in yaw": lambda rng: (rng.uniform(0.1, 0.5, 6), rng.uniform(0.1, 0.5, 6) * [1, 1, 1, 1, 1, 0], 9),
    }, example=((0.3, 0.1, 16), 0.5)),
    Exercise("05.2", propagate_own_axes, particles_and_draws, cases={"four headings": four_headings}),
    Exercise("05.3", share_near, cloud_and_state, cases={
        "yaws at the seam": yaws_at_the_seam,
        "nobody near": lambda rng: (rng.normal([10, 0, 1, 0, 0, 0], 0.2, (12, 6)), np.eye(6)[0] * 20, 0.5, 0.2),
        "a radius and an angle of 0": a_radius_and_an_angle_of_0,
    }),
    Exercise("05.4", bayes_step, corridor_with_doors, cases={
        "nearly at the end": lambda rng: (*np.array([[0, 0.3, 0.7], [0.1, 0.9, 0]]), np.arange(3) == 2, True, 0.8, 0.1),
        "a sure sensor": lambda rng: (np.full(6, 1 / 6), np.array([0, 1.0]), np.arange(6) % 3 == 0, False, 1.0, 0.0),
        "more moves than cells": lambda rng: (np.ones(4) / 4, np.ones(7) / 7, np.arange(4) == 2, False, 0.9, 0.2),
        "at rest": lambda rng: corridor_with_doors(rng, n_moves=1),
    }, example=(([0.5, 0.5, 0], [0, 1], [False, True, False], True, 0.8, 0.2), [0, 0.8, 0.2])),
    Exercise("05.5", min_sigma, lambda rng: (
        rng.uniform(0.02, 0.3), int(rng.integers(50, 2000)), int(rng.integers(20, 500)), rng.uniform(0.6, 0.99),
    ), "challenge", cases={"one frame": lambda rng: (0.1, 20, 1, 0.9)}, example=((0.1, 20, 1, 0.9), 0.0811)),
]
