"""The comparison partner of paper 1's table 1: the scoring of Fallon, Johannsson and Leonard (ICRA 2012).

"Efficient Scene Simulation for Robust Monte Carlo Localization using an RGB-D Camera", reference [2] of the paper. The
formulas and constants are those published with the Point Cloud Library's simulation module, written from their
statement as formulas. Both forms give a log-likelihood, a sum over pixels; weights are its exponential, normalized.

The constants were made for 20 x 15 pixels. At full size the same sum has 84 times as many terms, none of them
independent of its neighbours: differences between particles grow in proportion, and the weights collapse onto one.
"""

from functools import partial
from typing import Literal

import numpy as np
from scipy.special import softmax
from scipy.stats import norm

from course_lib.depth_mcl.likelihood import Weighting, paired_pixels, valid_pixels

COARSE_WIDTH, COARSE_HEIGHT = 20, 15  # pixels, the size the constants below were made for

DEPTH_SIGMA = 0.5  # metres, of the half-normal
DEPTH_CUT = 3.0  # metres, where the half-normal ends and over which the uniform part is spread
DEPTH_UNIFORM_WEIGHT = 0.99  # rho of the depth form

DISPARITY_NEAR = 0.7  # metres, the scorer's own n, whatever the renderer's planes are
DISPARITY_FAR = 20.0  # metres, the scorer's own f
DISPARITY_SIGMA = 0.025  # normalized disparity; 0.3 m at 3 m, with this n and f only
DISPARITY_UNIFORM_WEIGHT = 0.999  # rho of the disparity form


def depth_log_likelihood(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    """Log-likelihood `(N,)` from differences of depth.

    sum_j log[ rho / 3 + (1 - rho) h(|z_t^j - z_(i)^j|) ],
    h(x) = 2 / (s sqrt(2 pi)) exp(-x^2 / (2 s^2)) up to 3 m, then 0

    s = 0.5 m, rho = 0.99 the weight of the *uniform* part. measured `(H, W)`, simulated `(N, H, W)`, metres. Pixels
    without measurement are left out; a simulated miss gets the uniform part alone.
    Source: Point Cloud Library, module simulation, scoring by a table of a half-normal.
    """
    valid, simulated = paired_pixels(measured, simulated)
    z = np.asarray(measured, dtype=np.float64)[valid]
    result = np.empty(len(simulated))
    for i, image in enumerate(simulated):
        difference = np.abs(z - image[valid])
        half_normal = np.where(difference <= DEPTH_CUT, 2 * norm.pdf(difference, scale=DEPTH_SIGMA), 0.0)
        result[i] = np.log(DEPTH_UNIFORM_WEIGHT / DEPTH_CUT + (1 - DEPTH_UNIFORM_WEIGHT) * half_normal).sum()
    return result


def normalized_disparity(z: np.ndarray) -> np.ndarray:
    """Normalized disparity d = f / (f - n) - f n / ((f - n) z) of depths in metres: 0 at n = 0.7 m, 1 at f = 20 m.

    What lies outside [n, f], a miss (`inf`) included, is held at 0 or 1, as the depth buffer of a renderer with these
    planes would hold it.
    """
    n, f = DISPARITY_NEAR, DISPARITY_FAR
    with np.errstate(divide="ignore"):
        return np.clip(f / (f - n) - f * n / ((f - n) * np.asarray(z, dtype=np.float64)), 0.0, 1.0)


def disparity_pixels(measured: np.ndarray) -> np.ndarray:
    """Which pixels of a measured image the disparity form compares: measured, and within [n, f]."""
    z = np.nan_to_num(np.asarray(measured, dtype=np.float64))
    return valid_pixels(measured) & (z >= DISPARITY_NEAR) & (z <= DISPARITY_FAR)


def disparity_log_likelihood(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    """Log-likelihood `(N,)` from differences of normalized disparity.

    sum_j log[ rho + (1 - rho) N(D_j; 0, s) / (Phi((1 - d_j) / s) - Phi(-d_j / s)) ]

    d the simulated normalized disparity, D the measured minus the simulated one, N a density (1/s inside), s = 0.025,
    rho = 0.999. Measured depths outside [n, f] = [0.7, 20] m are masked. Shapes as in `depth_log_likelihood`.
    Source: Point Cloud Library, module simulation, scoring in disparity with a truncated normal.
    """
    _, simulated = paired_pixels(measured, simulated)
    valid = disparity_pixels(measured)
    measured_disparity = normalized_disparity(np.asarray(measured)[valid])
    result = np.empty(len(simulated))
    s = DISPARITY_SIGMA
    for i, image in enumerate(simulated):
        d = normalized_disparity(image[valid])
        inside = norm.cdf((1 - d) / s) - norm.cdf(-d / s)
        density = norm.pdf(measured_disparity - d, scale=s) / inside
        result[i] = np.log(DISPARITY_UNIFORM_WEIGHT + (1 - DISPARITY_UNIFORM_WEIGHT) * density).sum()
    return result


def weights_from_log_likelihood(log_likelihood: np.ndarray) -> np.ndarray:
    """Weights `(N,)` proportional to exp(log-likelihood), summing to one; the greatest is subtracted first."""
    return softmax(np.asarray(log_likelihood, dtype=np.float64))


# Form -> (log-likelihood of every particle, which pixels it compares).
_FORMS = {"depth": (depth_log_likelihood, valid_pixels), "disparity": (disparity_log_likelihood, disparity_pixels)}


def fallon_weighting(form: Literal["depth", "disparity"] = "depth") -> Weighting:
    """Weighting for `MonteCarloLocalizer`: "depth" or "disparity". The score is the log-likelihood a pixel."""
    if form not in _FORMS:
        raise ValueError(f"form must be 'depth' or 'disparity'; got {form!r}")
    return Weighting(partial(_score, form), partial(_weigh, form))


def _score(form: str, measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    log_likelihood, compared_pixels = _FORMS[form]
    return log_likelihood(measured, simulated) / max(1, compared_pixels(measured).sum())


def _weigh(form: str, measured: np.ndarray, scores: np.ndarray) -> np.ndarray:
    compared_pixels = _FORMS[form][1]
    return weights_from_log_likelihood(scores * max(1, compared_pixels(measured).sum()))
