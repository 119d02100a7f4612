"""How sure a share or a median is that was measured on few seeds or poses."""

from collections.abc import Sequence

import numpy as np
from scipy.stats import binomtest, quantile_test

INTERVAL_PERCENT = 95
BOOTSTRAP_DRAWS, BOOTSTRAP_SEED = 10_000, 0


def wilson_percent(hits: int, n: int) -> list[float]:
    """Return Wilson's 95 % interval of a share, in percent: [low, high]."""
    interval = binomtest(hits, n).proportion_ci(confidence_level=0.95, method="wilson")
    return [100.0 * interval.low, 100.0 * interval.high]


def bootstrap_percent(shares: np.ndarray) -> list[float] | None:
    """Return the 95 % interval, in percent, of the mean of one share a room; None for a single room.

    Rooms are drawn with replacement. All rooms have the same number of poses, so that the mean over rooms is the share
    of all poses.
    """
    if len(shares) < 2:
        return None
    rng = np.random.default_rng(BOOTSTRAP_SEED)
    means = rng.choice(shares, (BOOTSTRAP_DRAWS, len(shares))).mean(axis=1)
    return [100.0 * float(value) for value in np.percentile(means, (2.5, 97.5))]


def share_intervals(kind: str, hits: np.ndarray, rooms: np.ndarray) -> dict[str, list[float] | None]:
    """Return both intervals of a share: of independent poses, and of whole rooms. rooms: the room of each pose."""
    by_room = np.array([hits[rooms == room].mean() for room in np.unique(rooms)])
    return {
        f"{kind}_wilson_percent": wilson_percent(int(hits.sum()), len(hits)),
        f"{kind}_rooms_percent": bootstrap_percent(by_room),
    }


def spread(values: Sequence[float]) -> dict[str, float]:
    """Return median, least and greatest of one number over seeds."""
    return {"median": float(np.median(values)), "least": float(min(values)), "greatest": float(max(values))}


def median_interval(values: Sequence[float]) -> dict[str, float | None]:
    """Return the median over seeds and its 95 % confidence interval; fewer than six seeds have no interval.

    From order statistics: at most half of all recordings lie below the median, whatever their distribution.
    """
    low, high = quantile_test(values, q=0, p=0.5).confidence_interval(confidence_level=INTERVAL_PERCENT / 100)
    known = np.isfinite([low, high]).all()
    ends = {"low": float(low), "high": float(high)} if known else {"low": None, "high": None}
    return {"median": float(np.median(values)), **ends}
