"""From light to the file that a 360-degree camera writes: exposure, white balance, blur, noise, JPEG."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.random import Generator

from course_lib.files import atomic_write


@dataclass(frozen=True)
class PanoramaCameraModel:
    """What one photograph does to the light; each range is drawn anew for every photograph."""

    exposure_stops: float = 0.25  # standard deviation of the exposure, powers of two; chosen
    white_balance: float = 0.04  # standard deviation of each channel's gain, a share of one; chosen
    blur: tuple[float, float] = (0.3, 0.8)  # pixels at 1280, standard deviation of lens and stitching; chosen
    shot_noise: float = 0.15  # variance per brightness level, grey levels; chosen
    read_noise: float = 1.2  # standard deviation, grey levels; chosen
    jpeg_quality: tuple[int, int] = (78, 86)  # 0 to 100, OpenCV's scale; chosen


def photograph(light: np.ndarray, model: PanoramaCameraModel, rng: Generator) -> np.ndarray:
    """One photograph of the light of a panorama.

    light: `(H, W, 3)` float32 BGR, 255 = full scale at exposure 1. Returns `(H, W, 3)` uint8 BGR.
    """
    gain = 2.0 ** rng.normal(0.0, model.exposure_stops) * rng.normal(1.0, model.white_balance, 3)
    image = light * gain.astype(np.float32)
    sigma = rng.uniform(*model.blur) * light.shape[1] / 1280
    # A panorama has no left and right end: blur it with a margin from its other side.
    margin = 8
    image = np.concatenate([image[:, -margin:], image, image[:, :margin]], axis=1)
    image = cv2.GaussianBlur(image, (0, 0), max(sigma, 0.1))[:, margin:-margin]
    spread = np.sqrt(model.shot_noise * np.clip(image, 0, 255) + model.read_noise**2, dtype=np.float32)
    image = image + spread * rng.standard_normal(image.shape, dtype=np.float32)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def write_photograph(path: str | Path, image: np.ndarray, model: PanoramaCameraModel, rng: Generator) -> None:
    """Write a photograph as JPEG with a quality of its own. Raises `OSError` when it cannot be written."""
    quality = int(rng.integers(model.jpeg_quality[0], model.jpeg_quality[1] + 1))
    atomic_write(path, cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes())
