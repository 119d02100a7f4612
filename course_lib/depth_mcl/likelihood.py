"""Compute likelihood and weight of every particle in the order of paper 1 (sections 3.3.3 and 3.3.4, step A-2).

likelihood            eq. (8), as one reads it; `compiled_likelihood` gives the same numbers faster
normalize_likelihood  eq. (9)
weights               eqs (10), (11)
paper_weighting       all of them as one part of the filter, which can be exchanged (fallon.py has another)
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.compiled import compiled

# Metres, paper 1, section 4. No status follows it: their limits have `status.AGREES_WITHIN`. Another default shifts the
# raw scores, so choose these again: `uncertainty.INDEPENDENT_PIXELS`, `simplification.TOLERANCE`, and, in the annealed
# filter, which scores with the default, `SEEN` and `RIVAL_WITHIN`. Then compute again: lessons 00, 06 to 10, 19 and 20,
# project P1 (its rivals and courseware/answers/project_1.json), data/*/results and the tables of RESULTS.md. Lessons
# 00, 04 and 06 write 0.1 m into their text.
ALPHA = 0.1
BETA = 0.01  # no unit (a normalized likelihood), paper 1, section 4
MAX_DEPTH = 100.0  # metres, which no depth camera reaches. A larger value means millimetres: 10 cm reads as 100


class DepthImageError(ValueError):
    """Depth images do not fit each other or the camera."""


def checked_image(depth: np.ndarray, camera: DepthCamera) -> np.ndarray:
    """Return a depth image `(H, W)` as an array.

    Raises `DepthImageError` if it has another size than the camera's, if it does not hold floating-point numbers, or if
    more than half of what it measured lies beyond `MAX_DEPTH`. One image cannot show whether it holds depth along the
    optical axis, as it must, or the length of each ray. You have to know: depth is that length divided by
    `np.linalg.norm(camera.rays(), axis=-1)`.
    """
    depth = np.asarray(depth)
    if depth.shape != camera.shape:
        raise DepthImageError(
            f"the depth image has shape {depth.shape}; the camera gives {camera.shape} (height, width)"
        )
    if depth.dtype.kind != "f":
        raise DepthImageError(
            f"the depth image holds {depth.dtype}; metres as float are expected. Whole numbers look like millimetres: "
            "divide them by 1000"
        )
    limit = max(MAX_DEPTH, camera.far)
    measured = depth[valid_pixels(depth)]
    if 2 * np.count_nonzero(measured > limit) > len(measured):
        raise DepthImageError(
            f"more than half of the depth image lies beyond {limit:g} m; metres are expected. These look like "
            "millimetres: divide them by 1000"
        )
    return depth


def valid_pixels(measured: np.ndarray) -> np.ndarray:
    """Return which pixels of a measured image were measured at all: finite and in front of the camera."""
    measured = np.asarray(measured)
    return np.isfinite(measured) & (np.nan_to_num(measured, posinf=0.0, neginf=0.0) > 0)


def paired_pixels(measured: np.ndarray, simulated: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mask of measured pixels `(H, W)` and the simulated images `(N, H, W)`, both checked."""
    measured, simulated = np.asarray(measured), np.asarray(simulated)
    if measured.ndim != 2 or simulated.ndim != 3 or simulated.shape[1:] != measured.shape:
        raise DepthImageError(
            f"measured must have shape (H, W) and simulated (N, H, W); got {measured.shape} and {simulated.shape}"
        )
    if simulated.size and not simulated.min() >= 0:  # NaN is neither
        raise DepthImageError("simulated images must not hold NaN or negative values; where nothing is hit is inf")
    return valid_pixels(measured), simulated


def checked_alpha(alpha: float) -> float:
    """Return alpha, in metres; `ValueError` unless it is positive."""
    if not (np.isfinite(alpha) and alpha > 0):
        raise ValueError(f"alpha must be a positive number of metres; got {alpha!r}")
    return float(alpha)


def likelihood(measured: np.ndarray, simulated: np.ndarray, alpha: float = ALPHA) -> np.ndarray:
    """Return the likelihood `(N,)` of every particle: how well its simulated depth image agrees with the measured one.

    l_(i) = sum_j ( 1 - |z_t^j - z_(i)^j| / (alpha + |z_t^j - z_(i)^j|) )

    measured: `(H, W)` metres, NaN = no measurement. simulated: `(N, H, W)` metres, `inf` = nothing hit. alpha: metres,
    the difference at which a pixel counts half. Result between 0 and the number of pixels compared.
    The paper is silent on empty pixels. Those that the camera did not measure are left out, for all particles alike. A
    simulated miss contributes 0, the limit of its term, and stays in the count. If it were left out, a particle that
    looks into holes of the map would pay nothing for them.
    Raises `ValueError` for alpha not positive, `DepthImageError` for images that do not fit.
    Source: paper 1, eq. (8).
    """
    alpha = checked_alpha(alpha)
    valid, simulated = paired_pixels(measured, simulated)
    z = np.asarray(measured, dtype=np.float32)[valid]
    result = np.empty(len(simulated))
    for i, image in enumerate(simulated):
        # 1 - d / (alpha + d) = alpha / (alpha + d), which is 0, not NaN, at d = inf.
        difference = np.abs(z - image[valid])
        result[i] = np.sum(alpha / (alpha + difference), dtype=np.float64)
    return result


def compiled_likelihood(measured: np.ndarray, simulated: np.ndarray, alpha: float = ALPHA) -> np.ndarray:
    """Return what `likelihood` returns, computed in a compiled loop: 200 images in a few milliseconds, not in forty.

    The filter uses this one. Arguments and errors are those of `likelihood`; a test holds the two together.
    """
    alpha = checked_alpha(alpha)
    valid, simulated = paired_pixels(measured, simulated)
    z = np.where(valid, measured, 0.0).astype(np.float32)
    images = np.ascontiguousarray(simulated, dtype=np.float32).reshape(len(simulated), valid.size)
    return _sums(z.ravel(), valid.ravel().astype(np.float32), images, np.float32(alpha))


# Sums may be taken in any order, several pixels at a time; infinity keeps its meaning (a miss counts 0).
@compiled(fastmath={"reassoc", "nsz", "contract", "arcp"})
def _sums(z, counts, images, alpha):
    """Return sum_j counts_j alpha / (alpha + |z_j - image_j|) of each image."""
    result = np.empty(len(images))
    for i in range(len(images)):
        image = images[i]
        total = 0.0
        # In pieces: a float32 sum of few terms rounds little, and several are added at once.
        for start in range(0, len(z), 128):
            piece = slice(start, start + 128)
            z_piece, image_piece, counts_piece = z[piece], image[piece], counts[piece]
            subtotal = np.float32(0)
            for j in range(len(z_piece)):
                subtotal += counts_piece[j] * alpha / (alpha + abs(z_piece[j] - image_piece[j]))
            total += subtotal
        result[i] = total
    return result


def normalize_likelihood(l: np.ndarray) -> np.ndarray:  # noqa: E741 - the paper's letter
    """Return likelihoods `(N,)` spread over [0, 1]: 0 for the worst particle, 1 for the best.

    l~_(i) = (l_(i) - l_min) / (l_max - l_min)

    Where all likelihoods agree this is 0/0, and all particles get 1.
    Raises `ValueError` for no likelihoods or values that are not finite.
    Source: paper 1, eq. (9).
    """
    values = np.asarray(l, dtype=np.float64)
    if values.ndim != 1 or len(values) == 0 or not np.isfinite(values).all():
        raise ValueError(f"likelihoods must be a non-empty array (N,) of finite numbers; got shape {values.shape}")
    spread = values.max() - values.min()
    return np.ones_like(values) if spread == 0 else (values - values.min()) / spread


def weights(l_normalized: np.ndarray, beta: float = BETA) -> np.ndarray:
    """Return the weights `(N,)` of the particles, which sum to one.

    w_(i) = exp( -(l~_(i) - 1)^2 / beta^2 ),    w~_(i) = w_(i) / sum_i w_(i)

    l_normalized: `(N,)` in [0, 1], from `normalize_likelihood`. beta: how far below the best a particle may be and
    still count; with 0.01 those within about one hundredth of the spread. The best particle has w = 1 however badly it
    fits, so these weights cannot tell a lost filter from a found one: keep the raw likelihood for that.
    Raises `ValueError` for beta not positive or values outside [0, 1].
    Source: paper 1, eqs (10), (11).
    """
    values = np.asarray(l_normalized, dtype=np.float64)
    if not (np.isfinite(beta) and beta > 0):
        raise ValueError(f"beta must be a positive number; got {beta!r}")
    if values.ndim != 1 or len(values) == 0 or not ((values >= 0) & (values <= 1)).all():
        raise ValueError("l_normalized must be a non-empty array (N,) of numbers from 0 to 1 (normalize_likelihood)")
    # Relative to the best particle, because exp() of all of them could vanish: (a^2 - b^2) / beta^2.
    below, best = 1 - values, 1 - values.max()
    with np.errstate(over="ignore"):
        w = np.exp(-(below - best) / beta * ((below + best) / beta))
    return w / w.sum()


class Weighting(NamedTuple):
    """How particles are weighed: a part of the filter that can be exchanged, of two pure functions.

    There are two because images are many and large. They are scored a batch at a time, and only the scores are kept.
    """

    score: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """(measured `(H, W)`, simulated `(n, H, W)`) -> `(n,)`: how well each image agrees, a mean over pixels, so that it
    may be compared from frame to frame. Larger is better."""
    weigh: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """(measured `(H, W)`, scores `(N,)` of all particles) -> weights `(N,)`, summing to one."""


def paper_weighting(alpha: float = ALPHA, beta: float = BETA) -> Weighting:
    """Return the paper's weighting: eqs (8) to (11) one after the other.

    The score is l_(i) divided by the number of pixels compared: 1 for perfect agreement, whatever the camera saw. The
    division changes no weight, because the normalization cancels every common factor.
    """
    return Weighting(partial(_score, alpha), partial(_weigh, beta))


def _score(alpha: float, measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
    return compiled_likelihood(measured, simulated, alpha) / max(1, valid_pixels(measured).sum())


def _weigh(beta: float, measured: np.ndarray, scores: np.ndarray) -> np.ndarray:
    return weights(normalize_likelihood(scores), beta)
