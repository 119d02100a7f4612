"""How sharply scores become weights: as sharply as leaves a wanted number of effective particles, and no sharper.

The paper's beta = 0.01 leaves about one particle in 200, whichever frame it is. In x, y and yaw that works, since 200
particles lie close together there; in six dimensions the best of 200 is far from the best place, and to copy it alone
is to throw the cloud away. Annealing asks the other way round: given the number of particles that shall survive, how
sharp may the weights be? In the first, wide layer of a frame the answer is "hardly", in the last "very".
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from course_lib.depth_mcl.particle_filter import effective_sample_size

SHARPEST = 1e4  # scores that differ by 1e-4 are then told apart; sharper only tells rounding apart


class Tempered(NamedTuple):
    """Weights of one layer and how sharp they are."""

    weights: np.ndarray
    """`(N,)`, summing to one."""
    sharpness: float
    """kappa: how many independent pixels the image would be worth if these weights were its likelihood."""
    ess: float
    """Effective sample size of the weights."""


def temper(scores: np.ndarray, sample_size: float, sharpest: float = SHARPEST) -> Tempered:
    """Weights of exponential form, as sharp as leaves `sample_size` effective particles.

    w_i ~ exp(kappa s_i),    kappa such that 1 / sum w_i^2 = sample_size

    scores: `(N,)` raw scores s, means over pixels. kappa is between 0, where all weigh the same (so few particles that
    they do not reach the sample size), and `sharpest` (so alike that even then more remain).
    Raises `ValueError` for no scores or scores that are not finite.
    """
    scores = np.asarray(scores, dtype=np.float64)
    if scores.ndim != 1 or len(scores) == 0 or not np.isfinite(scores).all():
        raise ValueError(f"scores must be a non-empty array (N,) of finite numbers; got shape {scores.shape}")
    below = scores - scores.max()

    def at(kappa: float) -> np.ndarray:
        w = np.exp(kappa * below)
        return w / w.sum()

    def missing(kappa: float) -> float:
        return effective_sample_size(at(kappa)) - sample_size

    if len(scores) <= sample_size:
        kappa = 0.0
    elif missing(sharpest) >= 0:
        kappa = sharpest
    else:
        kappa = brentq(missing, 0.0, sharpest)
    w = at(kappa)
    return Tempered(w, float(kappa), effective_sample_size(w))
