"""Batches of training samples, made in a thread beside the training; OpenCV and NumPy let go of Python's lock there.

Every sample has a generator of its own, seeded by (seed, epoch, place in the epoch): the order and the pictures are the
same however many threads there are, and a training that was stopped goes on with the samples that it would have seen.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import torch

from tools.detector_training.assignment import Targets, make_targets
from tools.detector_training.augmentation import AugmentationRanges, augmented_sample
from tools.detector_training.images import PanoramaFolders

QUEUE_LENGTH = 4  # batches in waiting: enough to bridge a slow one, little memory


@dataclass(frozen=True)
class Batch:
    """Images and objects of one step."""

    images: torch.Tensor
    """(b, 3, h, w) float32, RGB in [0, 1]."""
    targets: Targets


def epoch_order(n_panoramas: int, seed: int, epoch: int) -> np.ndarray:
    """The order in which an epoch visits the panoramas, a permutation of 0 .. n - 1."""
    return np.random.default_rng([seed, epoch]).permutation(n_panoramas)


def make_batch(
    panoramas: PanoramaFolders,
    indices: np.ndarray,
    generators: list[np.random.Generator],
    window: tuple[int, int],
    ranges: AugmentationRanges | None = None,
) -> Batch:
    """A batch of augmented samples of the panoramas with these indices, one generator each."""
    samples = [augmented_sample(panoramas[int(i)], window, g, ranges) for i, g in zip(indices, generators, strict=True)]
    targets = make_targets([(s.labels, s.boxes, s.ignored) for s in samples])
    return Batch(images_to_tensor([s.image for s in samples]), targets)


def images_to_tensor(images: list[np.ndarray]) -> torch.Tensor:
    """Network input (b, 3, h, w), RGB in [0, 1], channels last in memory, of BGR uint8 images of one size."""
    stacked = torch.from_numpy(np.stack(images)[..., ::-1].copy())
    return stacked.permute(0, 3, 1, 2).to(torch.float32).div_(255.0)


def epoch_batches(
    panoramas: PanoramaFolders,
    batch_size: int,
    window: tuple[int, int],
    seed: int,
    epoch: int,
    n_batches: int | None = None,
    ranges: AugmentationRanges | None = None,
) -> Iterator[Batch]:
    """The batches of one epoch, or its first `n_batches`; a last, smaller one is left out unless it is the only one."""
    order = epoch_order(len(panoramas), seed, epoch)
    n_batches = n_batches or max(1, len(order) // batch_size)

    def batch(number: int) -> Batch:
        places = np.arange(number * batch_size, min((number + 1) * batch_size, len(order)))
        generators = [np.random.default_rng([seed, epoch, int(place)]) for place in places]
        return make_batch(panoramas, order[places], generators, window, ranges)

    return _made_ahead(batch, n_batches)


def _made_ahead(make, count: int) -> Iterator:
    """Yields make(0), ..., make(count - 1), each made in a thread while the one before is used."""
    waiting: queue.Queue = queue.Queue(maxsize=QUEUE_LENGTH)
    stopped = threading.Event()

    def put(item, error) -> None:
        # With a time limit: when the one who takes them has left, nobody makes room any more.
        while not stopped.is_set():
            try:
                waiting.put((item, error), timeout=0.2)
                return
            except queue.Full:
                continue

    def produce() -> None:
        try:
            for number in range(count):
                put(make(number), None)
                if stopped.is_set():
                    return
        except BaseException as error:
            put(None, error)

    thread = threading.Thread(target=produce, name="batches", daemon=True)
    thread.start()
    try:
        for _ in range(count):
            item, error = waiting.get()
            if error is not None:
                raise error
            yield item
    finally:
        stopped.set()
        thread.join()
