"""Batches of training samples, made in a thread beside the training.

Every sample has a generator of its own, seeded by (seed, epoch, place in the epoch): a stopped training goes on alike.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
import torch

from tools.detector_training.assignment import Targets, make_targets
from tools.detector_training.augmentation import AugmentationRanges, augmented_sample
from tools.detector_training.images import LabelledPanorama

BATCHES_AHEAD = 4  # enough to bridge a slow one, little memory


class Batch(NamedTuple):
    """Images and objects of one step."""

    images: torch.Tensor  # (b, 3, h, w) float32, RGB in [0, 1]
    targets: Targets


def images_to_tensor(images: list[np.ndarray]) -> torch.Tensor:
    """Network input (b, 3, h, w), RGB in [0, 1], channels last in memory, of BGR uint8 images of one size."""
    stacked = torch.from_numpy(np.stack(images)[..., ::-1].copy())
    return stacked.permute(0, 3, 1, 2).to(torch.float32).div_(255.0)


def epoch_batches(
    panoramas: list[LabelledPanorama],
    batch_size: int,
    window: tuple[int, int],
    seed: int,
    epoch: int,
    n_batches: int,
    ranges: AugmentationRanges | None = None,
) -> Iterator[Batch]:
    """The first `n_batches` batches of one epoch. What is left over of the panoramas is left out."""
    order = np.random.default_rng([seed, epoch]).permutation(len(panoramas))

    def batch(number: int) -> Batch:
        places = range(number * batch_size, min((number + 1) * batch_size, len(order)))
        samples = [
            augmented_sample(panoramas[int(order[k])], window, np.random.default_rng([seed, epoch, k]), ranges)
            for k in places
        ]
        targets = make_targets([(sample.labels, sample.boxes, sample.ignored) for sample in samples])
        return Batch(images_to_tensor([sample.image for sample in samples]), targets)

    maker = ThreadPoolExecutor(1)
    waiting = deque(maker.submit(batch, number) for number in range(min(BATCHES_AHEAD, n_batches)))
    try:
        for following in range(BATCHES_AHEAD, BATCHES_AHEAD + n_batches):
            made = waiting.popleft().result()
            if following < n_batches:
                waiting.append(maker.submit(batch, following))
            yield made
    finally:
        maker.shutdown(cancel_futures=True)
