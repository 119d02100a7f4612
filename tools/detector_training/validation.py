"""Precision and recall of a detector on rooms that it was not trained on, and the choice of its threshold."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.experiments.room_evaluation import Matching, match_detections
from course_lib.spherical_stereo.detection.darknet import read_names
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.recording import TrueObject
from tools.detector_evaluation import average_precision, best_threshold, precision_recall_curve, scores_at
from tools.detector_training.images import LabelledPanorama

# Boxes below this score are not looked at: far below any threshold that could be chosen.
MIN_SCORE = 0.05


@dataclass(frozen=True)
class Validation:
    """What a validation found."""

    n_images: int
    threshold: float  # the score that gives the largest F1 on these images
    precision: float
    recall: float
    average_precision: float
    by_class: dict[str, tuple[float, float, int]]  # precision and recall at that threshold, and number of objects

    def line(self) -> str:
        """One line for a log."""
        return (
            f"precision {self.precision:.3f} recall {self.recall:.3f} at score {self.threshold:.2f}, "
            f"average precision {self.average_precision:.3f} ({self.n_images} images)"
        )


def measure_detector(cfg: Path, weights: Path, names_file: Path, panoramas: Iterable[LabelledPanorama]) -> Validation:
    """Precision and recall of the detector, run by OpenCV as the method runs it, on panoramas."""
    detector = YoloDetector(cfg, weights, names_file, score_threshold=MIN_SCORE)
    return validate(lambda panorama: detector.detect(panorama.image), panoramas, read_names(names_file))


def validate(
    detect: Callable[[LabelledPanorama], list[Detection]], panoramas: Iterable[LabelledPanorama], names: list[str]
) -> Validation:
    """Precision and recall at IoU 0.5 of `detect` over panoramas, at the threshold with the best F1.

    Raises `DetectionScoreError` when the panoramas hold no object, or no detection is right.
    """
    found: list[Matching] = []
    of_class: dict[str, list[Matching]] = {name: [] for name in names}
    for panorama in panoramas:
        detections, width = detect(panorama), panorama.image.shape[1]
        boxes = zip(panorama.labels, panorama.boxes, strict=True)
        objects = [TrueObject(k, names[label], box, box, 1.0) for k, (label, box) in enumerate(boxes)]
        found.append(match_detections(detections, objects, width, ~panorama.ignored))
        for name in names:
            only = [one for one in detections if one.label == name]
            counts = ~panorama.ignored & [thing.label == name for thing in objects]
            of_class[name].append(match_detections(only, objects, width, counts))
    curve = precision_recall_curve(found)
    threshold = best_threshold(curve)
    by_class = {}
    for name, matchings in of_class.items():
        count = sum(matching.n_objects for matching in matchings)
        if count:
            by_class[name] = (*scores_at(precision_recall_curve(matchings), threshold), count)
    return Validation(len(found), threshold, *scores_at(curve, threshold), average_precision(curve), by_class)


def every_nth(panoramas: list[LabelledPanorama], count: int) -> list[LabelledPanorama]:
    """At most `count` panoramas, evenly spread over the folder: the same ones every time the folder is the same."""
    indices = np.unique(np.linspace(0, len(panoramas) - 1, min(count, len(panoramas))).round().astype(int))
    return [panoramas[int(index)] for index in indices]
