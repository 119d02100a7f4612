"""How far off may the estimate be: a covariance that covers, from the particles and raw scores that a frame has anyway.

The paper's weights cannot say it. With beta = 0.01 they leave about one particle in 200, and the spread of one particle
is nothing: a median of 2e-7 m was reported where the error was 0.024 m. Nor can a likelihood of independent pixels: its
exponent is a sum over 25,000 of them, and the best particle takes all again. Pixels are not independent, since a
displaced door or a bias of the map moves thousands at once.

So the particles are weighed a second time, by exp(kappa l/m), as if the whole image were worth kappa independent
pixels; and kappa is lowered where it would leave too few particles to span the space they move in, which happens where
particles are sparse, so that the spacing between them, an error too, is in the answer. What counts is their spread
about the estimate that the filter gives, whatever its own weights were.

Calibrated where nothing is reported from: a wagon's run of the corridor of seed 10,001 with 50, 200 and 800 particles,
and the shipped run by hand, six degrees of freedom, with 1,000. There the normalized error e' C^-1 e / d, d the number
of components that move, is 1.2, 0.7 and 1.3 in the mean of a run, and 1.2 by hand.
What it cannot say: particles lie within a frame's noise of where the last frame left them, and so does this covariance.
A filter that has fallen behind by more than that is more wrong than it knows (six degrees of freedom in the kitchen
recording: 1.6 to 3.8 in the mean of 60 frames), and one that is lost has all its particles in the wrong place.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from course_lib.depth_mcl.particle_filter import effective_sample_size

# How many independent pixels an image is worth, kappa, and how many effective particles beyond the number of moving
# components are left at least. Both chosen on tuning worlds: see above.
INDEPENDENT_PIXELS = 50.0
SPARE_PARTICLES = 2


def tempered_weights(scores: np.ndarray, least_sample_size: float) -> np.ndarray:
    """Weights `(N,)` proportional to exp(kappa s), summing to one.

    scores: `(N,)` raw scores s, a mean over pixels. kappa is `INDEPENDENT_PIXELS`, or the smaller number at which the
    effective sample size is `least_sample_size`; N where that is more than N.
    """
    below = np.asarray(scores, dtype=np.float64) - np.max(scores)

    def at(kappa: float) -> np.ndarray:
        w = np.exp(kappa * below)
        return w / w.sum()

    def missing(kappa: float) -> float:
        return effective_sample_size(at(kappa)) - least_sample_size

    if len(below) <= least_sample_size:
        return at(0.0)
    if missing(INDEPENDENT_PIXELS) >= 0:
        return at(INDEPENDENT_PIXELS)
    return at(brentq(missing, 0.0, INDEPENDENT_PIXELS))


def error_covariance(deviations: np.ndarray, scores: np.ndarray) -> np.ndarray:
    """Covariance `(6, 6)` of the estimate's error: the mean square deviation of the particles under tempered weights.

    C = sum_i v_i d_i d_i',    v_i ~ exp(kappa s_i)

    deviations: `(N, 6)` of the particles from the estimate (`Motion.deviations`), metres and radians; scores: `(N,)`,
    raw, equal where nothing was measured. Components that no particle moved in have a variance of 0: they are given,
    not estimated.
    """
    deviations = np.asarray(deviations, dtype=np.float64)
    n_moving = np.count_nonzero(np.ptp(deviations, axis=0))
    v = tempered_weights(scores, n_moving + SPARE_PARTICLES)
    return (v[:, None] * deviations).T @ deviations
