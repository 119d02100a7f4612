"""Compression keeps what is seen."""

import io

import numpy as np
from PIL import Image

from course_lib.lessons.kit.compression import compress


def test_compression_keeps_the_picture():
    rng = np.random.default_rng(0)
    rgb = np.kron(rng.integers(0, 255, (4, 5, 3)), np.ones((20, 20, 1))).astype(np.uint8)
    back = np.asarray(Image.open(io.BytesIO(compress(rgb))).convert("RGB"))
    assert back.shape == rgb.shape
    assert np.abs(back.astype(int) - rgb).max() <= 12
