"""Compute how far off the estimate may be, from the particles and raw scores that a frame has anyway.

The paper's weights cannot say it, because with beta = 0.01 they leave about one particle. A likelihood of independent
pixels cannot either, because a displaced door moves thousands of pixels at once. So we weigh the particles a second
time, by exp(kappa l/m), as if the whole image were worth kappa independent pixels. That is one frame's share of the
error; `carried_covariance` takes the earlier ones along, as a Kalman filter would.

kappa was calibrated on a wagon in the corridor of seed 10,001. No such covariance can say that the filter is lost
(status.py).
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from course_lib.depth_mcl.particle_filter import effective_sample_size

SHARPEST = 1e4  # kappa at most: scores that differ by 1e-4 are then told apart; sharper only tells rounding apart

# Both chosen on tuning worlds: see above.
INDEPENDENT_PIXELS = 50.0  # kappa: how many an image is worth; chosen with eq. (8)'s alpha = 0.1 m
SPARE_PARTICLES = 2  # how many effective particles beyond the number of moving components are left at least
_NO_VARIANCE = 1e-18  # a nanometre's, or a nanoradian's: what is less is rounding
_MIN_SHARE = 1e-9  # of a cloud's variance: what is less is rounding, and the cloud is flat there


class Tempered(NamedTuple):
    """Weights and how sharp they are."""

    weights: np.ndarray  # `(N,)`, summing to one
    sharpness: float  # kappa: how many independent pixels the image would be worth if they were its likelihood
    ess: float  # effective sample size of the weights


def temper(scores: np.ndarray, sample_size: float, sharpest: float = SHARPEST) -> Tempered:
    """Return weights of exponential form, so sharp that `sample_size` effective particles survive.

    w_i ~ exp(kappa s_i), kappa in [0, `sharpest`] such that 1 / sum w_i^2 = sample_size

    scores: `(N,)` raw scores s, means over pixels.
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


def error_covariance(deviations: np.ndarray, scores: np.ndarray) -> np.ndarray:
    """Return the covariance `(6, 6)` that a frame leaves: the particles' mean square deviation, tempered weights.

    C = sum_i v_i d_i d_i',    v_i ~ exp(kappa s_i)

    kappa is `INDEPENDENT_PIXELS`, or less where that leaves fewer than d + `SPARE_PARTICLES` effective particles of
    the d components that move.
    deviations: `(N, 6)` of the particles from the estimate (`Motion.deviations`), metres and radians; scores: `(N,)`,
    raw, equal where nothing was measured. Components that no particle moved in have a variance of 0: they are given,
    not estimated.
    """
    deviations = np.asarray(deviations, dtype=np.float64)
    moving = np.ptp(deviations, axis=0) > 0
    deviations = np.where(moving, deviations, 0.0)  # the mean of equal numbers may differ from them by rounding
    v = temper(scores, np.count_nonzero(moving) + SPARE_PARTICLES, sharpest=INDEPENDENT_PIXELS).weights
    return (v[:, None] * deviations).T @ deviations


def carried_covariance(covariance: np.ndarray, deviations: np.ndarray, earlier: np.ndarray) -> np.ndarray:
    """Return the covariance `(6, 6)` of the estimate's error, with what is left of the error of the frame before.

    P = C + A E A',    A = C Q^-1

    C: what this frame leaves of the cloud's own covariance Q, that of `deviations` `(N, 6)`. A is the share of an
    earlier error E that the frame did not correct, a Kalman filter's I - K: 0 along what the image shows, 1 along a
    bare wall and along what the particles do not span; no eigenvalue is above 1.
    """
    deviations = np.asarray(deviations, dtype=np.float64)
    scale = np.std(deviations, axis=0)
    scale[scale == 0] = 1.0  # metres and radians, in units of the cloud's own widths
    values, axes = np.linalg.eigh(np.cov(deviations / scale, rowvar=False, bias=True))
    spanned = values > _MIN_SHARE
    width, axes = np.sqrt(values[spanned]), axes[:, spanned]
    whiten, unwhiten = (axes / width).T / scale, (axes * width) * scale[:, None]
    shares, directions = np.linalg.eigh(whiten @ covariance @ whiten.T)
    lessened = (directions * (np.clip(shares, 0.0, 1.0) - 1.0)) @ directions.T  # A - 1, where the cloud is round
    kept = np.eye(6) + unwhiten @ lessened @ whiten
    return covariance + kept @ earlier @ kept.T


def positive_part(matrix: np.ndarray) -> np.ndarray:
    """Return a symmetric matrix without its negative eigenvalues: a difference of covariances as a covariance.

    Components without a variance stay exactly without: what rounding gave them would add up from frame to frame.
    """
    block = np.ix_(*2 * (np.flatnonzero(np.diag(matrix) > _NO_VARIANCE),))
    result = np.zeros_like(matrix)
    values, axes = np.linalg.eigh(matrix[block])
    result[block] = (axes * np.clip(values, 0.0, None)) @ axes.T
    return result


def normalized_error(deviation: np.ndarray, covariance: np.ndarray) -> float:
    """Return the squared error in units of its covariance, e' C^-1 e / d: 1 in the mean if the covariance is right.

    deviation: e `(6,)`, the true state's from the estimate (`Motion.deviations`); covariance: C `(6, 6)`, whose
    components without a variance, given and not estimated, are left out; d is the number of the others. NaN where C is
    singular: fewer particles than that many components need, or all of them at one place, do not say how far off.
    """
    estimated = np.flatnonzero(np.diag(covariance) > _NO_VARIANCE)
    c = np.asarray(covariance, dtype=np.float64)[np.ix_(estimated, estimated)]
    sigma = np.sqrt(np.diag(c))  # metres and radians, in units of their own spread
    correlation = c / np.outer(sigma, sigma)
    if not len(c) or np.linalg.eigvalsh(correlation)[0] < _MIN_SHARE:
        return float("nan")
    e = np.asarray(deviation, dtype=np.float64)[estimated] / sigma
    return float(e @ np.linalg.solve(correlation, e)) / len(estimated)
