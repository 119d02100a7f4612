"""What goes wrong with a depth camera's frames: each trouble makes, of a good recording, what arrives instead.

An exposure that jumps is modelled after the simulated camera itself (simulation/sensors/time_of_flight.py): with the
light cut to a share, amplitudes fall to that share, so that ranges are noisier, by

    sigma_r = c / (4 pi f) sqrt(shot^2 / A + dark^2 / A^2),      A = share * WHITE_SHARE * 4 / r^2

and returns whose amplitude falls below the camera's threshold are lost: far ones first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from course_lib.experiments.sensor_trouble.placing import Arrival, troubled_runs
from course_lib.simulation.corridor.recorded_runs import FRAME_RATE
from course_lib.simulation.sensors.time_of_flight import SPEED_OF_LIGHT, TimeOfFlightModel

LIGHT_LEFT = 1 / 16  # share of the exposure that is left after a jump: four stops; chosen
WHITE_SHARE = 0.3  # reflectivity times cosine of what is seen, which a depth image does not tell; chosen
GREATEST_RANGE = 9.99  # m, where a saturated sensor stops: the SR4000's unambiguous range
SECOND = 1.0

# (image that is due, image that arrived before, generator) -> image that arrives
Spoil = Callable[[np.ndarray, np.ndarray, np.random.Generator], np.ndarray]


def black(image: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """No return in any pixel."""
    return np.full_like(image, np.nan)


def repeated(image: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """The image that arrived before, once more."""
    return before.copy()


def half_covered(image: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """One half, upper, lower, left or right, without returns: a hand before the lens is too near for any."""
    covered = image.copy()
    height, width = image.shape
    halves = (
        np.s_[: height // 2],
        np.s_[height // 2 :],
        np.s_[:, : width // 2],
        np.s_[:, width // 2 :],
    )
    covered[halves[rng.integers(4)]] = np.nan
    return covered


def saturated(image: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """All pixels at zero, all at the greatest range, or all anywhere between: one of the three, drawn."""
    kind = rng.integers(3)
    if kind == 2:
        return rng.uniform(0.0, GREATEST_RANGE, image.shape).astype(image.dtype)
    return np.full_like(image, (0.0, GREATEST_RANGE)[kind])


def underexposed(image: np.ndarray, before: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """The image with `LIGHT_LEFT` of its light: noisier, and without what is far (the model above)."""
    model = TimeOfFlightModel()
    amplitude = LIGHT_LEFT * WHITE_SHARE * 4 / np.maximum(image.astype(np.float64), 0.05) ** 2
    phase = np.sqrt(model.shot_noise**2 / amplitude + model.dark_noise**2 / amplitude**2)
    noise = SPEED_OF_LIGHT / (4 * np.pi * model.frequency) * phase * rng.standard_normal(image.shape)
    return np.where(amplitude < model.least_amplitude, np.nan, image + noise).astype(image.dtype)


SPOILS: dict[str, Spoil] = {
    "repeated": repeated,
    "black": black,
    "frozen for a second": repeated,
    "half covered": half_covered,
    "saturated": saturated,
    "exposure jump": underexposed,
}
TROUBLES = ("dropped", *SPOILS, "time backwards")


LONGEST_RUN = round(SECOND * FRAME_RATE)
"""Frames of the longest trouble in recordings of the corridor."""


def run_length(trouble: str, period: float) -> int:
    """How many frames one after the other a trouble lasts: a second's for a frozen camera, one for all others."""
    return round(SECOND / period) if trouble == "frozen for a second" else 1


def troubled_recording(
    trouble: str, images: Sequence[np.ndarray], times: np.ndarray, share: float, rng: np.random.Generator
) -> tuple[list[Arrival], list[tuple[int, int]]]:
    """What arrives of a recording, an `Arrival` for each frame that is due, and the troubled stretches (first, end).

    trouble: of `TROUBLES`. images: `(H, W)` metres, NaN = no measurement. times: `(T,)` seconds. share: of the frames.
    A frame whose time goes backwards is stamped up to a second before the frame before it.
    Raises `ValueError` for a trouble that does not exist, or does not fit into the recording.
    """
    if trouble not in TROUBLES:
        raise ValueError(f"trouble must be one of {', '.join(TROUBLES)}; got {trouble!r}")
    period = float(np.median(np.diff(times)))
    runs = troubled_runs(len(images), share, run_length(trouble, period), rng)
    arrivals = [Arrival(image, float(time)) for image, time in zip(images, times, strict=True)]
    for index in (index for first, end in runs for index in range(first, end)):
        image, time = arrivals[index]
        if trouble == "dropped":
            arrivals[index] = Arrival(None, time)
        elif trouble == "time backwards":
            arrivals[index] = Arrival(image, arrivals[index - 1].time - rng.uniform(0.0, SECOND))
        else:
            arrivals[index] = Arrival(SPOILS[trouble](image, arrivals[index - 1].image, rng), time)
    return arrivals, runs
