"""Answers to the stages of projects P1 and P4."""

from __future__ import annotations

import math

import numpy as np

from course_lib.lessons.project_1 import exercises as p1


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


def left_is_right(particles, sigma, noise):
    return by_rotation_matrices(particles, sigma, noise * [1, -1, 1, 1, 1, 1])


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


def as_printed(measured, simulated, alpha):
    difference = np.abs(measured - simulated)
    return np.nansum(1 - difference / (alpha + difference), axis=(1, 2)) * 1.0 + np.isinf(difference).sum(axis=(1, 2))


def weights_by_logarithms(values, beta):
    spread = max(values) - min(values)
    if spread == 0:
        return [1 / len(values)] * len(values)
    logs = [-(((v - max(values)) / spread / beta) ** 2) for v in values]
    total = sum(math.exp(x) for x in logs)
    return [math.exp(x) / total for x in logs]


def min_max_only_where_it_can(values, beta):
    w = np.exp(-(((values - values.min()) / (np.ptp(values) + 1e-300) - 1) ** 2) / beta**2)
    return w / w.sum()


def with_nan_to_num(values, beta):
    with np.errstate(all="ignore"):
        normalized = np.nan_to_num((values - values.min()) / np.ptp(values))
    w = np.exp(-((normalized - 1) ** 2) / beta**2)
    return w / w.sum()


def by_arrows(particles, w):
    arrows = (w[:, None] * np.exp(1j * particles[:, 3:])).sum(axis=0)
    return [*np.average(particles[:, :3], axis=0, weights=w), *np.angle(arrows)]


def about_the_first(particles, w):
    off = (particles - particles[0] + [0, 0, 0, *[math.pi] * 3]) % (2 * math.pi) - [0, 0, 0, *[math.pi] * 3]
    mean = particles[0] + np.concatenate([w @ (particles - particles[0])[:, :3], w @ off[:, 3:]])
    mean[3:] = (mean[3:] + np.pi) % (2 * np.pi) - np.pi
    return mean


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


def noise_forgotten_twice(particles, measured, render, sigma, beta, noise, u):
    found, kept = p1.one_round(particles, measured, render, sigma, beta, noise, u)
    return found, p1.propagate(kept, sigma, noise)


def raw_likelihoods_as_weights(particles, measured, render, sigma, beta, noise, u):
    moved = p1.propagate(particles, sigma, noise)
    w = p1.likelihood(measured, render(moved), 0.1)
    w = w / w.sum()
    return p1.estimate(moved, w), moved[p1.resample(w, u)]


WRONG = [
    ("P1.1", lambda state0, n: np.array([state0] * n).T, "column a particle"),
    ("P1.1", lambda state0, n: np.zeros((n, 6)), "differ on every input"),
    ("P1.1", lambda state0, n: [state0] * (n + 1), "one particle too many"),
    ("P1.2", left_is_right, "Left and right"),
    ("P1.2", lambda p, s, n: p + s * n, "world's axes"),
    ("P1.2", lambda p, s, n: by_complex_numbers(p * [1, 1, 1, 1, 1, np.pi / 180], s, n), "radians already"),
    ("P1.3", as_printed, "counts as perfect"),
    ("P1.3", lambda m, s, a: by_nansum(m, s, a) / m.size, "all pixels"),
    ("P1.3", lambda m, s, a: by_nansum(np.nan_to_num(m), s, a), "not a wall at 0 m"),
    ("P1.4", min_max_only_where_it_can, "0/0"),
    ("P1.4", with_nan_to_num, "0/0"),
    ("P1.4", lambda v, b: np.exp(v / b) / np.exp(v / b).sum(), "NaN"),
    ("P1.4", lambda v, b: p1.particle_weights(v, b) * len(v), "sum to one"),
    ("P1.5", lambda p, w: np.average(p, axis=0, weights=w), "as printed"),
    ("P1.5", lambda p, w: p[np.argmax(w)], "heaviest"),
    ("P1.5", lambda p, w: by_arrows(p, w)[:3], "shape (6,)"),
    ("P1.6", lambda w, u: np.sort(np.argsort(-w, kind="stable")), "whatever it weighs"),
    ("P1.6", lambda w, u: np.searchsorted(np.cumsum(w), np.arange(len(w)) / len(w), side="right"), "start at 0"),
    ("P1.6", lambda w, u: np.repeat(np.arange(len(w)), np.floor(len(w) * w).astype(int)), "shape"),
    ("P1.7", noise_forgotten_twice, "move twice"),
    ("P1.7", raw_likelihoods_as_weights, "likelihoods"),
    ("P1.7", lambda p, m, render, s, b, n, u: p1.one_round(p, m, render, s, 0.01, n, u), "beta"),
]
RIGHT = [
    ("P1.1", lambda state0, n: [list(state0) for _ in range(n)]),
    ("P1.1", lambda state0, n: np.repeat(state0[None], n, axis=0)),
    ("P1.1", lambda state0, n: np.ones((n, 1)) * state0),
    ("P1.2", by_rotation_matrices),
    ("P1.2", by_complex_numbers),
    ("P1.3", by_loops),
    ("P1.3", by_nansum),
    ("P1.3", lambda m, s, a: by_nansum(m, s, a).astype(np.float32)),
    ("P1.4", weights_by_logarithms),
    ("P1.4", lambda v, b: np.array(weights_by_logarithms(v, b), np.float32)),
    ("P1.5", by_arrows),
    ("P1.5", lambda p, w: np.array(by_arrows(p, w), np.float32)),
    ("P1.6", walking_along),
    ("P1.6", by_counting),
    ("P1.6", lambda w, u: np.searchsorted(np.cumsum(w), (np.arange(len(w)) + u) / len(w))),
    ("P1.7", one_round_in_one_breath),
    ("P1.7", lambda *given: list(one_round_in_one_breath(*given))),
]
