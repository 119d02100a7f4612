"""Right answers to lesson 05 by other ways than its solutions."""

import numpy as np
from scipy.optimize import brentq
from scipy.stats import norm


def by_complex_numbers(particles, sigma_forward, sigma_left, draws):
    step = draws @ [sigma_forward, 1j * sigma_left] * np.exp(1j * particles[:, 5])
    return particles + np.column_stack([step.real, step.imag, np.zeros((len(step), 4))])


def near(p, s, r):
    return ((p[..., :2] - s[:2]) ** 2).sum(axis=-1) <= r**2


def bayes_by(moved, bel, moves, doors, seen, hit, false_alarm):
    """`moved(bel, moves)` is the prediction; then the sensor."""
    chance = [hit if door else false_alarm for door in doors]
    after = [m * (c if seen else 1 - c) for m, c in zip(moved(bel, moves), chance, strict=True)]
    return [one / sum(after) for one in after]


def convolved(bel, moves):
    whole = np.convolve(bel, moves)
    return np.append(whole[: len(bel) - 1], whole[len(bel) - 1 :].sum())


RIGHT = [
    ("05.1", lambda start, sigma, t: np.hypot(start, np.sqrt(t) * sigma)),
    ("05.2", by_complex_numbers),
    ("05.3", lambda p, s, r, a: np.count_nonzero(near(p, s, r) & (np.cos(p[:, 5] - s[5]) >= np.cos(a))) / len(p)),
    ("05.4", lambda *given: np.array(bayes_by(convolved, *given))),
    ("05.5", lambda s, n, frames, p: brentq(lambda sigma: (1 - norm.cdf(s / sigma) ** n) ** frames - p, s / 9, 9 * s)),
]
