"""Right answers to the exercises of lesson 06 by other ways than the solution's."""

import numpy as np


def term(difference, alpha):
    return alpha / (alpha + difference)


def weigh_by_means(measured, images, alpha, beta):
    """By means over the measured pixels: (9) takes their number away again."""
    valid = np.isfinite(measured)
    means = term(np.abs(measured - images), alpha)[:, valid].mean(axis=1) if valid.any() else np.zeros(len(images))
    if not np.ptp(means) > 0:
        return [1 / len(means)] * len(means)
    w = np.exp(-((((means - means.min()) / np.ptp(means) - 1) / beta) ** 2))
    return w / np.sum(w)


def averaged(x, target, proposal):
    mean = np.average(x, weights=target / proposal)
    return [mean, np.sqrt(np.sum((target / proposal * (x - mean)) ** 2)) / np.sum(target / proposal)]


RIGHT = [
    ("06.1", lambda hidden, a: term(0.02, a) - hidden * (term(0.02, a) - term(2, a))),
    ("06.2", weigh_by_means),
    ("06.3", lambda v, beta: v.min() + (1 - beta * np.log(2) ** 0.5) * np.ptp(v)),
    ("06.4", averaged),
]
