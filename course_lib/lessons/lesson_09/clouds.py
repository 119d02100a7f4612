"""How densely a cloud of particles fills its space, in one to six dimensions."""

from typing import NamedTuple

import numpy as np
from scipy.stats import chi2


class Density(NamedTuple):
    """What a normal cloud of `n` particles has near its middle."""

    dimensions: int
    near: float
    """How many particles lie within half a standard deviation, in the mean over many clouds: n P(chi^2 <= 1/4)."""
    nearest: float
    """How far the nearest is, in standard deviations: the median over clouds that were drawn."""


def cloud_density(n: int, dimensions: int, rng: np.random.Generator, clouds: int = 400) -> Density:
    """The density of normal clouds of `n` particles where they are densest, at the middle."""
    lengths = np.linalg.norm(rng.standard_normal((clouds, n, dimensions)), axis=-1)
    return Density(dimensions, float(n * chi2.cdf(0.25, dimensions)), float(np.median(lengths.min(axis=1))))
