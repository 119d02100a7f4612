"""The likelihood that a textbook starts with: every pixel has a Gaussian error, and none is ever an outlier.

It stands here to be compared with paper 1's likelihood, which was chosen so as not to behave like this one.
"""

import numpy as np

from course_lib.depth_mcl.likelihood import paired_pixels

GAUSSIAN_SIGMA = 0.1  # metres, as large as the paper's alpha, so that both forms have one scale
MISS_DEPTH = 11.0  # metres, what a simulated miss counts as: just beyond the 10 m that an SR4000 measures


def gaussian_log_likelihood(
    measured: np.ndarray, simulated: np.ndarray, sigma: float = GAUSSIAN_SIGMA, miss_depth: float = MISS_DEPTH
) -> np.ndarray:
    """Log-likelihood `(N,)` of every particle for independent Gaussian errors of depth, without its constant.

    sum_j -(z_t^j - z_(i)^j)^2 / (2 sigma^2)

    measured: `(H, W)` metres, NaN = no measurement, left out. simulated: `(N, H, W)` metres. A simulated miss (`inf`)
    would make the sum -inf for every particle that sees one hole of the map; it counts as a surface at `miss_depth`.
    sigma: metres. Raises `ValueError` for sigma or miss_depth not positive, `DepthImageError` for images that do not
    fit. Source: Thrun, Burgard, Fox, Probabilistic Robotics (2005), section 6.3.1, p_hit.
    """
    for name, value in (("sigma", sigma), ("miss_depth", miss_depth)):
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} must be a positive number of metres; got {value!r}")
    valid, simulated = paired_pixels(measured, simulated)
    z = np.asarray(measured, dtype=np.float64)[valid]
    differences = (z - np.minimum(image[valid], miss_depth) for image in simulated)
    return np.array([-np.sum(d**2) / (2 * sigma**2) for d in differences], dtype=np.float64)
