"""Right answers to lesson 05 by other ways than its solutions."""

from functools import partial

import numpy as np
from scipy.optimize import brentq
from scipy.stats import norm

from course_lib.geometry import wrap_angle


def by_complex_numbers(particles, sigma_forward, sigma_left, draws):
    step = draws @ [sigma_forward, 1j * sigma_left] * np.exp(1j * particles[:, 5])
    return particles + np.column_stack([step.real, step.imag, np.zeros((len(step), 4))])


def by_matrices(particles, sigma_forward, sigma_left, draws):
    turns = [np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]) for yaw in particles[:, 5]]
    steps = [turn @ (draw * [sigma_forward, sigma_left]) for turn, draw in zip(turns, draws, strict=True)]
    return [[*(p[:2] + step), *p[2:]] for p, step in zip(particles, steps, strict=True)]


def near(p, s, r):
    return ((p[..., :2] - s[:2]) ** 2).sum(axis=-1) <= r**2


def bayes_by(moved, bel, moves, doors, seen, hit, false_alarm):
    """`moved(bel, moves)` is the prediction; then the sensor."""
    chance = [hit if door else false_alarm for door in doors]
    after = [m * (c if seen else 1 - c) for m, c in zip(moved(bel, moves), chance, strict=True)]
    return [one / sum(after) for one in after]


def cell_by_cell(bel, moves):
    moved = [0.0] * len(bel)
    for start, k in np.ndindex(len(bel), len(moves)):
        moved[min(start + k, len(bel) - 1)] += bel[start] * moves[k]
    return moved


def by_matrix(bel, moves):
    ends = [np.minimum(np.arange(len(bel)) + k, len(bel) - 1) for k in range(len(moves))]
    return bel @ sum(p * np.eye(len(bel))[end] for p, end in zip(moves, ends, strict=True))


def convolved(bel, moves):
    whole = np.convolve(bel, moves)
    return np.append(whole[: len(bel) - 1], whole[len(bel) - 1 :].sum())


RIGHT = [
    ("05.1", lambda start, sigma, t: np.hypot(start, np.sqrt(t) * sigma)),
    ("05.1", lambda start, sigma, t: [(a * a + t * b * b) ** 0.5 for a, b in zip(start, sigma, strict=True)]),
    ("05.2", by_complex_numbers),
    ("05.2", by_matrices),
    ("05.3", lambda p, s, r, a: np.count_nonzero(near(p, s, r) & (np.cos(p[:, 5] - s[5]) >= np.cos(a))) / len(p)),
    ("05.3", lambda p, s, r, a: [np.mean([near(q, s, r) and abs(wrap_angle(q[5] - s[5])) <= a for q in p])]),
    *[("05.4", partial(bayes_by, moved)) for moved in (cell_by_cell, by_matrix, convolved)],
    ("05.4", lambda *given: np.array(bayes_by(convolved, *given))),
    ("05.5", lambda s, n, frames, p: s / norm.isf(1 - (1 - p ** (1 / frames)) ** (1 / n))),
    ("05.5", lambda s, n, frames, p: brentq(lambda sigma: (1 - norm.cdf(s / sigma) ** n) ** frames - p, s / 9, 9 * s)),
]
