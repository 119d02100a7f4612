"""Right answers to project 1 by other ways than its solutions."""

import math

import numpy as np


def by_rotation_matrices(particles, sigma, noise):
    moved = particles + sigma * noise
    for row, particle, step in zip(moved, particles, sigma * noise, strict=True):
        c, s = math.cos(particle[5]), math.sin(particle[5])
        row[:2] = particle[:2] + np.array([[c, -s], [s, c]]) @ step[:2]
    return moved.tolist()


def by_complex_numbers(particles, sigma, noise):
    step = sigma * noise
    xy = particles[:, 0] + 1j * particles[:, 1] + (step[:, 0] + 1j * step[:, 1]) * np.exp(1j * particles[:, 5])
    return np.column_stack([xy.real, xy.imag, particles[:, 2:] + step[:, 2:]])


def with_wrapped_yaw(*given):
    moved = by_complex_numbers(*given)
    return np.column_stack([moved[:, :5], np.mod(moved[:, 5] + np.pi, 2 * np.pi) - np.pi])


def by_loops(measured, simulated, alpha):
    pixels = [k for k, z in enumerate(measured.flat) if not math.isnan(z)]
    apart = [[abs(measured.flat[k] - image.flat[k]) for k in pixels] for image in simulated]
    return [sum(0.0 if math.isinf(d) else 1 - d / (alpha + d) for d in row) for row in apart]


def by_nansum(measured, simulated, alpha):
    return np.nansum(alpha / (alpha + np.abs(measured[None] - simulated)), axis=(1, 2))


def weights_by_loops(values, beta):
    spread = max(values) - min(values)
    terms = [math.exp(-(((v - max(values)) / spread / beta) ** 2)) if spread else 1.0 for v in values]
    return [term / sum(terms) for term in terms]


def by_arrows(particles, w):
    arrows = (w[:, None] * np.exp(1j * particles[:, 3:])).sum(axis=0)
    return [*np.average(particles[:, :3], axis=0, weights=w), *np.angle(arrows)]


def walking_along(w, u):
    """A pointer that only moves on."""
    found, i, reached = [], 0, 0.0
    for k in range(len(w)):
        while reached + w[i] <= (k + u) / len(w) and i < np.flatnonzero(w)[-1]:
            reached, i = reached + w[i], i + 1
        found.append(i)
    return found


def one_round(particles, measured, render, sigma, beta, noise, u):
    moved = np.array(by_rotation_matrices(particles, sigma, noise))
    w = np.array(weights_by_loops(by_nansum(measured, render(moved), 0.1), beta))
    return by_arrows(moved, w), moved[walking_along(w, u)]


RIGHT = [
    ("P1.1", lambda state0, n: np.repeat(state0[None], n, axis=0)),
    ("P1.2", by_rotation_matrices),
    ("P1.2", by_complex_numbers),
    ("P1.2", with_wrapped_yaw),
    ("P1.3", by_loops),
    ("P1.4", weights_by_loops),
    ("P1.5", by_arrows),
    ("P1.6", walking_along),
    ("P1.7", one_round),
]
