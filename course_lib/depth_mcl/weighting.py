"""How particles are weighed: a part of the filter that is exchanged as the motion is (paper 1, section 3.3.3, A-2).

A rule says two things: how well each simulated image agrees with the measured one, its *score*, and what the scores of
all particles make of their weights. They are apart because images are many and large: they are rendered, scored and
dropped a batch at a time, and only the scores are kept.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from course_lib.depth_mcl.compiled_likelihood import likelihood
from course_lib.depth_mcl.likelihood import ALPHA, BETA, normalize_likelihood, valid_pixels, weights


class Weighting(NamedTuple):
    """A rule for weighing particles; both functions are pure."""

    score: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """(measured `(H, W)`, simulated `(n, H, W)`) -> `(n,)`: a mean over pixels, larger is better, of each image by
    itself, so that it may be compared from frame to frame."""
    weigh: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """(measured `(H, W)`, scores `(N,)` of all particles) -> weights `(N,)`, summing to one."""


def paper_weighting(alpha: float = ALPHA, beta: float = BETA) -> Weighting:
    """The paper's weighting: likelihood, min-max normalization, weight, one after the other.

    The score is l_(i) divided by the number of pixels compared: 1 for perfect agreement, whatever the camera saw. That
    it is divided changes no weight: the normalization cancels every common factor.
    """
    return Weighting(partial(_score, alpha), partial(_weigh, beta))


def _score(alpha: float, measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    return likelihood(measured, simulated, alpha) / max(1, valid_pixels(measured).sum())


def _weigh(beta: float, measured: np.ndarray, scores: np.ndarray) -> np.ndarray:
    return weights(normalize_likelihood(scores), beta)
