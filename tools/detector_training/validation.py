"""Precision and recall of a network, or of the finished detector, on rooms that it was not trained on."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import torch

from course_lib.experiments.detection_scores import Boxes, Matching, match_detections
from course_lib.spherical_stereo.detection.seam import appended_columns, select_on_circle
from tools.detector_evaluation import average_precision, best_threshold, precision_recall_curve, scores_at
from tools.detector_training.augmentation import panorama_window
from tools.detector_training.batches import images_to_tensor
from tools.detector_training.images import LabelledPanorama, PanoramaFolders
from tools.detector_training.network import TrainableNetwork, decode

# Boxes below this score are not looked at: far below any threshold that could be chosen.
LEAST_SCORE = 0.05
# Boxes of one class that overlap more than this are one object.
SUPPRESSION_IOU = 0.45
MOST_BOXES = 400


@dataclass(frozen=True)
class Validation:
    """What a validation found."""

    n_images: int
    threshold: float
    """The score that gives the largest F1 on these images."""
    precision: float
    recall: float
    average_precision: float
    by_class: dict[str, tuple[float, float, int]]
    """Precision, recall at that threshold, and the number of objects, of each class."""

    def line(self) -> str:
        """One line for a log."""
        return (
            f"precision {self.precision:.3f} recall {self.recall:.3f} at score {self.threshold:.2f}, "
            f"average precision {self.average_precision:.3f} ({self.n_images} images)"
        )


def validate(
    detect: Callable[[LabelledPanorama], Boxes],
    panoramas: Iterable[LabelledPanorama],
    names: list[str],
    threshold: float | None = None,
) -> Validation:
    """Precision and recall at IoU 0.5 of `detect` over panoramas; the threshold with the best F1 unless one is given.

    `detect` gives the boxes of a panorama in pixels of its image. Raises `DetectionScoreError` when the panoramas hold
    no object, or no detection is right and no threshold is given.
    """
    found: list[Matching] = []
    of_class: dict[str, list[Matching]] = {name: [] for name in names}
    for panorama in panoramas:
        detections = detect(panorama)
        width = panorama.image.shape[1]
        objects, ignored = (_objects(panorama, names, which) for which in (~panorama.ignored, panorama.ignored))
        found.append(match_detections(detections, objects, ignored, width))
        for name in names:
            only = [_of_class(boxes, name) for boxes in (detections, objects)]
            of_class[name].append(match_detections(*only, ignored, width))
    curve = precision_recall_curve(found)
    chosen = best_threshold(curve) if threshold is None else threshold
    by_class = {}
    for name, matchings in of_class.items():
        count = sum(matching.n_objects for matching in matchings)
        if count:
            by_class[name] = (*scores_at(precision_recall_curve(matchings), chosen), count)
    return Validation(len(found), chosen, *scores_at(curve, chosen), average_precision(curve), by_class)


def network_detector(network: TrainableNetwork, names: list[str]) -> Callable[[LabelledPanorama], Boxes]:
    """A function that finds the objects of a panorama with the PyTorch network, for validation between epochs.

    It does what the detector does (section 2.2 of paper 2): the left quarter appended, boxes whose centre is outside
    the valid range left out, suppression on the circle.
    """

    @torch.no_grad()
    def detect(panorama: LabelledPanorama) -> Boxes:
        height, width = panorama.image.shape[:2]
        window = (width + appended_columns(width), height)
        image = images_to_tensor([panorama_window(panorama, window).image])
        image = image.contiguous(memory_format=torch.channels_last)
        table = decode(network(image), network.heads, window[0])[0].numpy()
        return boxes_from_table(table, names, width)

    return detect


def boxes_from_table(table: np.ndarray, names: list[str], width: int) -> Boxes:
    """Detections in a panorama `width` wide from the network's boxes (n, 5 + classes) on the extended image."""
    scores = table[:, 5:].max(axis=1)
    best = np.argsort(-scores, kind="stable")[:MOST_BOXES]
    best = best[scores[best] >= LEAST_SCORE]
    centre, size = table[best, :2].astype(np.float64), table[best, 2:4].astype(np.float64)
    boxes = np.concatenate([centre - size / 2, centre + size / 2], axis=1)
    limit = np.array([width + appended_columns(width), width // 2], dtype=np.float64)
    boxes = np.clip(boxes, 0.0, np.tile(limit, 2))
    boxes[:, 2] = np.minimum(boxes[:, 2], boxes[:, 0] + width)
    real = (boxes[:, 2] - boxes[:, 0] > 1.0) & (boxes[:, 3] - boxes[:, 1] > 1.0)
    classes = table[best, 5:].argmax(axis=1)
    boxes, scores, classes = select_on_circle(boxes[real], scores[best][real], classes[real], width, SUPPRESSION_IOU)
    return Boxes([names[index] for index in classes], boxes, scores)


def every_nth(panoramas: PanoramaFolders, count: int) -> list[LabelledPanorama]:
    """At most `count` panoramas, evenly spread over the folder: the same ones every time the folder is the same."""
    indices = np.unique(np.linspace(0, len(panoramas) - 1, min(count, len(panoramas))).round().astype(int))
    return [panoramas[int(index)] for index in indices]


def _objects(panorama: LabelledPanorama, names: list[str], which: np.ndarray) -> Boxes:
    return Boxes([names[label] for label in panorama.labels[which]], panorama.boxes[which])


def _of_class(boxes: Boxes, name: str) -> Boxes:
    which = np.array([label == name for label in boxes.labels], dtype=bool)
    scores = None if boxes.scores is None else np.asarray(boxes.scores)[which]
    return Boxes([name] * int(which.sum()), np.asarray(boxes.boxes).reshape(-1, 4)[which], scores)
