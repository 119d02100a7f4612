"""Right answers to project 1 by other ways than its solutions."""

import math

import numpy as np


def by_rotation_matrices(particles, sigma, noise):
    moved = []
    for particle, n in zip(particles, noise, strict=True):
        step = sigma * n
        c, s = math.cos(particle[5]), math.sin(particle[5])
        x, y = np.array([[c, -s], [s, c]]) @ step[:2]
        moved.append([particle[0] + x, particle[1] + y, *(particle[2:] + step[2:])])
    return moved


def by_complex_numbers(particles, sigma, noise):
    step = sigma * noise
    xy = particles[:, 0] + 1j * particles[:, 1] + (step[:, 0] + 1j * step[:, 1]) * np.exp(1j * particles[:, 5])
    return np.column_stack([xy.real, xy.imag, particles[:, 2:] + step[:, 2:]])


def wrapped_into_the_circle(particles, sigma, noise):
    moved = np.array(by_rotation_matrices(particles, sigma, noise))
    moved[:, 5] = np.mod(moved[:, 5] + np.pi, 2 * np.pi) - np.pi
    return moved


def by_loops(measured, simulated, alpha):
    found = []
    for image in simulated:
        total = 0.0
        for z, s in zip(measured.ravel(), image.ravel(), strict=True):
            if not math.isnan(z):
                total += 0.0 if math.isinf(s) else 1 - abs(z - s) / (alpha + abs(z - s))
        found.append(total)
    return found


def by_nansum(measured, simulated, alpha):
    return np.nansum(alpha / (alpha + np.abs(measured[None] - simulated)), axis=(1, 2))


def weights_by_logarithms(values, beta):
    spread = max(values) - min(values)
    if spread == 0:
        return [1 / len(values)] * len(values)
    logs = [-(((v - max(values)) / spread / beta) ** 2) for v in values]
    total = sum(math.exp(x) for x in logs)
    return [math.exp(x) / total for x in logs]


def by_arrows(particles, w):
    arrows = (w[:, None] * np.exp(1j * particles[:, 3:])).sum(axis=0)
    return [*np.average(particles[:, :3], axis=0, weights=w), *np.angle(arrows)]


def walking_along(w, u):
    """A pointer that only moves on."""
    found, i, reached = [], 0, 0.0
    heavy = np.flatnonzero(w)
    for k in range(len(w)):
        point = (k + u) / len(w)
        while reached + w[i] <= point and i < heavy[-1]:
            reached += w[i]
            i += 1
        found.append(i)
    return found


def by_counting(w, u):
    ends = np.cumsum(w)
    ends[np.flatnonzero(w)[-1] :] = 1.0
    upto = np.ceil(len(w) * ends - u).astype(int).clip(0, len(w))
    return np.repeat(np.arange(len(w)), np.diff(upto, prepend=0))


def one_round_in_one_breath(particles, measured, render, sigma, beta, noise, u):
    moved = np.array(by_rotation_matrices(particles, sigma, noise))
    w = np.array(weights_by_logarithms(by_nansum(measured, render(moved), 0.1), beta))
    return by_arrows(moved, w), moved[walking_along(w, u)]


def drawn_without_weightless(w, u):
    heavy = np.flatnonzero(w)
    ends = np.cumsum(w[heavy])
    return heavy[np.searchsorted(ends / ends[-1], (np.arange(len(w)) + u) / len(w))]


RIGHT = [
    ("P1.1", lambda state0, n: [list(state0) for _ in range(n)]),
    ("P1.1", lambda state0, n: np.repeat(state0[None], n, axis=0)),
    ("P1.1", lambda state0, n: np.ones((n, 1)) * state0),
    ("P1.2", by_rotation_matrices),
    ("P1.2", by_complex_numbers),
    ("P1.2", wrapped_into_the_circle),
    ("P1.3", by_loops),
    ("P1.3", by_nansum),
    ("P1.3", lambda m, s, a: by_nansum(m, s, a).astype(np.float32)),
    ("P1.4", weights_by_logarithms),
    ("P1.4", lambda v, b: np.array(weights_by_logarithms(v, b), np.float32)),
    ("P1.5", by_arrows),
    ("P1.5", lambda p, w: np.array(by_arrows(p, w), np.float32)),
    ("P1.6", walking_along),
    ("P1.6", by_counting),
    ("P1.6", drawn_without_weightless),
    ("P1.7", one_round_in_one_breath),
    ("P1.7", lambda *given: list(one_round_in_one_breath(*given))),
]
