"""Right answers to project 1 by other ways than its solutions."""

import math

import numpy as np


def by_complex_numbers(particles, sigma, noise):
    step = sigma * noise
    xy = particles[:, 0] + 1j * particles[:, 1] + (step[:, 0] + 1j * step[:, 1]) * np.exp(1j * particles[:, 5])
    return np.column_stack([xy.real, xy.imag, particles[:, 2:] + step[:, 2:]])


def with_wrapped_yaw(*given):
    moved = by_complex_numbers(*given)
    return np.column_stack([moved[:, :5], np.mod(moved[:, 5] + np.pi, 2 * np.pi) - np.pi])


def by_nansum(measured, simulated, alpha):
    return np.nansum(alpha / (alpha + np.abs(measured[None] - simulated)), axis=(1, 2))


def weights_by_loops(values, beta):
    spread = max(values) - min(values)
    terms = [math.exp(-(((v - max(values)) / spread / beta) ** 2)) if spread else 1.0 for v in values]
    return [term / sum(terms) for term in terms]


def by_arrows(particles, w):
    arrows = (w[:, None] * np.exp(1j * particles[:, 3:])).sum(axis=0)
    return [*np.average(particles[:, :3], axis=0, weights=w), *np.angle(arrows)]


def without_the_weightless(w, u):
    heavy = np.flatnonzero(w)
    return heavy[np.searchsorted(np.cumsum(w[heavy]) / w.sum(), (np.arange(len(w)) + u) / len(w))]


def one_round(particles, measured, render, sigma, beta, noise, u):
    moved = by_complex_numbers(particles, sigma, noise)
    w = np.array(weights_by_loops(by_nansum(measured, render(moved), 0.1), beta))
    return by_arrows(moved, w), moved[without_the_weightless(w, u)]


RIGHT = [
    ("P1.1", lambda state0, n: np.repeat(state0[None], n, axis=0)),
    ("P1.2", by_complex_numbers),
    ("P1.2", with_wrapped_yaw),
    ("P1.3", by_nansum),
    ("P1.4", weights_by_loops),
    ("P1.5", by_arrows),
    ("P1.6", without_the_weightless),
    ("P1.7", one_round),
]
