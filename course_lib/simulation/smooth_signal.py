"""Smooth random signals: what sways, wanders and looks about in the simulated recordings."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator


def smooth_signal(n: int, width: float, rng: Generator) -> np.ndarray:
    """Smooth random signal `(n,)` with zero mean and standard deviation one; `width` in frames."""
    margin = int(4 * width)
    kernel = np.exp(-0.5 * (np.arange(-margin, margin + 1) / width) ** 2)
    signal = np.convolve(rng.normal(size=n + 2 * margin), kernel, mode="valid")
    return signal / np.sqrt(np.sum(kernel**2))


def smoothed(values: np.ndarray, width: float) -> np.ndarray:
    """Values `(T,)` or `(T, k)` smoothed over frames by a bell curve of `width` frames; the ends are held."""
    margin = int(4 * width)
    kernel = np.exp(-0.5 * (np.arange(-margin, margin + 1) / width) ** 2)
    kernel /= kernel.sum()
    columns = np.asarray(values, dtype=np.float64).reshape(len(values), -1).T
    padded = np.pad(columns, ((0, 0), (margin, margin)), mode="edge")
    return np.stack([np.convolve(column, kernel, mode="valid") for column in padded], axis=1).reshape(np.shape(values))
