"""Which frames of a recording are troubled: drawn from a seed, so and so many of a hundred."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

STREAM = 0x7B0B1E  # joins a recording's seed
GOOD_FRAMES = 10  # after a trouble, before recovery is asked
LEFT_AT_THE_END = GOOD_FRAMES + 2  # frames, never troubled, so that most troubles can be recovered from


class Arrival(NamedTuple):
    """What came when a frame was due."""

    image: object
    """Of the sensor: a depth image, or a pair of panoramas; None: nothing came."""
    time: float
    """Seconds, as the frame's stamp says."""


def troubled_runs(n_frames: int, share: float, length: int, rng: np.random.Generator) -> list[tuple[int, int]]:
    """Stretches (first, end) of troubled frames in a recording, ascending, none touching another.

    share: of all frames, 0 to 1: as many stretches as come nearest to it, at least one. length: frames of each. The
    first frame is good, and so are the last `LEFT_AT_THE_END`.
    Raises `ValueError` for a recording too short for them.
    """
    count = max(1, round(share * n_frames / length))
    room = n_frames - 1 - LEFT_AT_THE_END
    # Each stretch but the first takes a good frame before it along, so that none touch.
    spare = room - (count * (length + 1) - 1)
    if length < 1 or not 0 < share < 1 or spare < 0:
        raise ValueError(
            f"{count} stretches of {length} troubled frames do not fit into {n_frames} frames, of which the first and "
            f"the last {LEFT_AT_THE_END} stay good; take a longer recording or a smaller share"
        )
    gaps = np.sort(rng.choice(spare + count, count, replace=False)) - np.arange(count)
    firsts = 1 + gaps + np.arange(count) * (length + 1)
    return [(int(first), int(first) + length) for first in firsts]


def require_fits(n_frames: int, shares: Sequence[float], lengths: Sequence[int]) -> None:
    """Raises `ValueError`, before anything is run, where one of the troubles does not fit (`troubled_runs`)."""
    for length in lengths:
        for share in shares:
            troubled_runs(n_frames, share, length, np.random.default_rng(0))


def troubled_frames(runs: list[tuple[int, int]], n_frames: int) -> np.ndarray:
    """Which frames lie in a stretch, bool `(n_frames,)`."""
    mask = np.zeros(n_frames, bool)
    for first, end in runs:
        mask[first:end] = True
    return mask


def generator(seed: int, name: str, share: float) -> np.random.Generator:
    """The generator of one trouble at one share in one seed's recording: each has a stream of its own."""
    return np.random.default_rng([STREAM, seed, round(10_000 * share), *name.encode()])
