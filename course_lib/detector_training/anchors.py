"""Anchors for a set of boxes: k-means on their widths and heights with 1 - IoU as the distance, as in YOLOv2."""

from __future__ import annotations

import numpy as np

from course_lib.detector_training.images import TrainingDataError


def shape_overlap(sizes: np.ndarray, anchors: np.ndarray) -> np.ndarray:
    """IoU (n, k) of boxes of `sizes` (n, 2) and `anchors` (k, 2), width and height, laid centre on centre."""
    shared = np.minimum(sizes[:, None], anchors[None]).prod(axis=-1)
    return shared / (sizes.prod(axis=-1)[:, None] + anchors.prod(axis=-1)[None] - shared)


def choose_anchors(sizes: np.ndarray, count: int, rng: np.random.Generator, rounds: int = 100) -> np.ndarray:
    """`count` anchors (count, 2) for boxes of `sizes` (n, 2), width and height in pixels, smallest area first.

    Each round gives every box to the anchor of largest IoU and moves the anchor to the median of its boxes. Raises
    `TrainingDataError` when there are fewer boxes than anchors, or a size is not positive.
    """
    sizes = np.asarray(sizes, dtype=np.float64)
    if len(sizes) < count or sizes.ndim != 2 or sizes.shape[1] != 2 or not (sizes > 0).all():
        raise TrainingDataError(f"{count} anchors need at least as many boxes of positive size; got {sizes.shape}")
    anchors = sizes[rng.choice(len(sizes), count, replace=False)]
    for _ in range(rounds):
        owner = shape_overlap(sizes, anchors).argmax(axis=1)
        # An anchor that lost all its boxes stays where it is.
        moved = np.array(
            [np.median(sizes[owner == i], axis=0) if (owner == i).any() else anchors[i] for i in range(count)]
        )
        if np.allclose(moved, anchors):
            break
        anchors = moved
    return anchors[np.argsort(anchors.prod(axis=1), kind="stable")]
