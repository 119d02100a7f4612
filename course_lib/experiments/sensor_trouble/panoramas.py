"""What goes wrong with pairs of panoramas: each trouble makes, of a good walk, what arrives instead."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from course_lib.experiments.sensor_trouble.placing import Arrival, troubled_runs

PERIOD = 1.0  # s between pairs; chosen: a few decimetres of a slow walk
DARK_NOISE = 2.0  # of 255, one sigma, of a camera that sees nothing; chosen
HOT_PIXELS = 2e-5  # share of a dark image's pixels that shine all the same; chosen
STOPS = 2.0  # by which an exposure jumps, up or down; chosen

Pair = tuple[np.ndarray, np.ndarray]
# (pair that is due, the good pair before it, pair that arrived before, generator) -> pair that arrives
Spoil = Callable[[Pair, Pair, Pair, np.random.Generator], Pair]


def one_dark(pair: Pair, earlier: Pair, before: Pair, rng: np.random.Generator) -> Pair:
    """Upper or lower, drawn, shows the noise of a covered lens and a few hot pixels."""
    images = list(pair)
    which = int(rng.integers(2))
    noise = np.abs(rng.normal(0.0, DARK_NOISE, images[which].shape))
    dark = np.minimum(noise, 255).astype(np.uint8)
    dark[rng.random(dark.shape[:2]) < HOT_PIXELS] = 255
    images[which] = dark
    return images[0], images[1]


def exchanged(pair: Pair, earlier: Pair, before: Pair, rng: np.random.Generator) -> Pair:
    """The upper camera's image as the lower one's, and the other way round."""
    return pair[1], pair[0]


def different_moments(pair: Pair, earlier: Pair, before: Pair, rng: np.random.Generator) -> Pair:
    """The lower image is that of the pair before: the rig has moved between the two."""
    return pair[0], earlier[1]


def repeated(pair: Pair, earlier: Pair, before: Pair, rng: np.random.Generator) -> Pair:
    """The pair that arrived before, once more."""
    return before[0].copy(), before[1].copy()


def exposure_jump(pair: Pair, earlier: Pair, before: Pair, rng: np.random.Generator) -> Pair:
    """One camera, drawn, `STOPS` stops brighter or darker, drawn: values are multiplied, and clipped at white."""
    images = list(pair)
    which, factor = int(rng.integers(2)), 2.0 ** (STOPS * rng.choice((-1.0, 1.0)))
    images[which] = np.clip(np.rint(images[which] * factor), 0, 255).astype(np.uint8)
    return images[0], images[1]


SPOILS: dict[str, Spoil] = {
    "one camera dark": one_dark,
    "cameras exchanged": exchanged,
    "different moments": different_moments,
    "repeated": repeated,
    "exposure jump": exposure_jump,
}
TROUBLES = ("dropped", *SPOILS)


def troubled_walk(
    trouble: str, pairs: Sequence[Pair], share: float, rng: np.random.Generator
) -> tuple[list[Arrival], list[tuple[int, int]]]:
    """What arrives of a walk, an `Arrival` for each pair that is due, and the troubled stretches (first, end).

    trouble: of `TROUBLES`. pairs: (upper, lower), uint8 BGR `(H, W, 3)` each. share: of the pairs, 0 to 1.
    Raises `ValueError` for a trouble that does not exist, or does not fit into the walk.
    """
    if trouble not in TROUBLES:
        raise ValueError(f"trouble must be one of {', '.join(TROUBLES)}; got {trouble!r}")
    runs = troubled_runs(len(pairs), share, 1, rng)
    arrivals = [Arrival(pair, PERIOD * k) for k, pair in enumerate(pairs)]
    for index, _ in runs:
        image = None
        if trouble != "dropped":
            image = SPOILS[trouble](pairs[index], pairs[index - 1], arrivals[index - 1].image, rng)
        arrivals[index] = Arrival(image, arrivals[index].time)
    return arrivals, runs
