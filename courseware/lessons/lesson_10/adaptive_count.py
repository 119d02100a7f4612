"""How many particles does a distribution need? KLD-sampling (Fox, Adapting the sample size in particle filters, 2003).

A distribution that is spread over many places needs many particles, one that is gathered in one place needs few. With
n samples of a distribution over k bins, the Kullback-Leibler divergence between the samples and the distribution is
below epsilon with the probability of quantile z if

    n = (k - 1) / (2 epsilon) (1 - 2 / (9 (k - 1)) + sqrt(2 / (9 (k - 1))) z)^3
"""

import numpy as np
from scipy.stats import norm

ERROR = 0.05  # epsilon, nats (Fox's choice)
PROBABILITY = 0.99


def kld_count(bins: int, least: int, most: int, error: float = ERROR, probability: float = PROBABILITY) -> int:
    """Return the number of particles, from `least` to `most`, for a distribution that occupies so many bins."""
    if not 1 <= least <= most:
        raise ValueError(f"least and most must be in order, at least 1; got {least} and {most}")
    if not (error > 0 and 0 < probability < 1):
        raise ValueError(f"error must be positive and probability in (0, 1); got {error} and {probability}")
    if bins < 2:
        return least
    share = 2 / (9 * (bins - 1))
    n = (bins - 1) / (2 * error) * (1 - share + np.sqrt(share) * norm.ppf(probability)) ** 3
    return int(np.clip(np.ceil(n), least, most))


def occupied_bins(poses: np.ndarray, size: float, angle: float) -> int:
    """Return how many bins poses `(N, 4, 4)` fall into: cubes of `size` metres, and of `angle` for the forward axis."""
    if len(poses) == 0:
        return 0
    cells = np.floor(np.concatenate([poses[:, :3, 3] / size, poses[:, :3, 2] / angle], axis=1)).astype(int)
    return len(np.unique(cells, axis=0))
