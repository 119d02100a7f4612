"""Precision and recall of detectors on panoramas whose objects are known, and the choice of a threshold."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.detection.darknet import read_names
from course_lib.spherical_stereo.detection.detector import YoloDetector
from courseware.experiments.room_evaluation import Matching, match_detections
from courseware.simulation.room.stereo_recording import StereoRecording, TrueObject
from tools.detector_training.images import LabelledPanorama

MIN_SCORE = 0.05  # of a box that a validation looks at: far below any threshold that could be chosen


class DetectionScoreError(ValueError):
    """Detections or objects that cannot be scored."""


class DetectorScore(NamedTuple):
    """How well a detector did, at IoU 0.5."""

    images: int
    objects: int  # to be found: half visible, 30 pixels high at a width of 1280
    found: int
    false_alarms: int

    @property
    def precision(self) -> float:
        """Right detections over all detections that count; nan without any."""
        return self.found / (self.found + self.false_alarms) if self.found + self.false_alarms else float("nan")

    @property
    def recall(self) -> float:
        """Objects found over objects to be found."""
        return self.found / self.objects


def score_detector(detector, labelled: Iterable[tuple[np.ndarray, Sequence[TrueObject]]]) -> DetectorScore:
    """Run a detector over images and count.

    labelled: (panorama, all that can be seen on it); objects that do not count are neither hit nor false alarm.
    Raises `DetectionScoreError` when there is no object to find. Source: paper 2, section 2.2.
    """
    matchings = [match_detections(detector.detect(image), things, image.shape[1]) for image, things in labelled]
    n_objects, found = objects_in(matchings), sum(int(matching.correct.sum()) for matching in matchings)
    return DetectorScore(len(matchings), n_objects, found, sum(len(m.correct) for m in matchings) - found)


def labelled_panoramas(recording: StereoRecording) -> Iterable[tuple[np.ndarray, Sequence[TrueObject]]]:
    """Every image of a recording with its objects."""
    for pair in recording.pairs:
        upper, lower = pair.images()
        yield upper, pair.upper_objects
        yield lower, pair.lower_objects


def objects_in(matchings: Sequence[Matching]) -> int:
    """Objects to be found in all panoramas. Raises `DetectionScoreError` when there is none."""
    n_objects = sum(matching.n_objects for matching in matchings)
    if n_objects == 0:
        raise DetectionScoreError("there is no object to be found in these panoramas, so recall is not defined")
    return n_objects


@dataclass(frozen=True)
class PrecisionRecall:
    """Precision and recall over falling thresholds."""

    threshold: np.ndarray  # (k,) scores, falling: entry i keeps all detections of at least this score
    precision: np.ndarray  # (k,) share of the kept detections that are right
    recall: np.ndarray  # (k,) share of the objects that are found


def precision_recall_curve(matchings: Sequence[Matching]) -> PrecisionRecall:
    """Precision and recall of many panoramas together, at every score that occurs.

    precision(t) = right detections with score >= t / all detections with score >= t
    recall(t)    = right detections with score >= t / objects

    Ignored detections are in neither count.
    """
    n_objects = objects_in(matchings)
    scores = np.concatenate([matching.scores for matching in matchings])
    correct = np.concatenate([matching.correct for matching in matchings])
    order = np.argsort(-scores, kind="stable")
    scores, right = scores[order], np.cumsum(correct[order])
    # A threshold keeps all detections of equal score: only the last of them is a point of the curve.
    last = np.ones(len(scores), dtype=bool)
    last[:-1] = scores[1:] != scores[:-1]
    kept = np.arange(1, len(scores) + 1)
    return PrecisionRecall(scores[last], (right / kept)[last], (right / n_objects)[last])


def scores_at(curve: PrecisionRecall, threshold: float) -> tuple[float, float]:
    """(precision, recall) of the detections with at least this score; precision is nan when there are none."""
    kept = np.flatnonzero(curve.threshold >= threshold)
    return (float(curve.precision[kept[-1]]), float(curve.recall[kept[-1]])) if len(kept) else (float("nan"), 0.0)


def best_threshold(curve: PrecisionRecall) -> float:
    """The threshold with the largest F1 = 2 precision recall / (precision + recall).

    Raises `DetectionScoreError` when no detection is right, since no threshold is then better than another.
    """
    total = curve.precision + curve.recall
    f1 = np.divide(2 * curve.precision * curve.recall, total, out=np.zeros_like(total), where=total > 0)
    if not len(f1) or f1.max() == 0.0:
        raise DetectionScoreError("no detection is right at any threshold: train the detector before choosing one")
    return float(curve.threshold[f1.argmax()])


def average_precision(curve: PrecisionRecall) -> float:
    """Area under precision over recall, precision made monotone from the right (as PASCAL VOC since 2010)."""
    if not len(curve.recall):
        return 0.0
    envelope = np.maximum.accumulate(curve.precision[::-1])[::-1]
    return float(np.sum(np.diff(curve.recall, prepend=0.0) * envelope))


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
    """Precision and recall at IoU 0.5 of a detector, run as the method runs it, at the threshold with the best F1.

    Raises `DetectionScoreError` when the panoramas hold no object, or no detection is right.
    """
    names, detector = read_names(names_file), YoloDetector(cfg, weights, names_file, score_threshold=MIN_SCORE)
    seen = [(detector.detect(panorama.image), panorama) for panorama in panoramas]
    curve = precision_recall_curve([_matching(*one, names, names) for one in seen])
    threshold, by_class = best_threshold(curve), {}
    for name in names:
        matchings = [_matching(*one, names, [name]) for one in seen]
        if count := sum(matching.n_objects for matching in matchings):
            by_class[name] = (*scores_at(precision_recall_curve(matchings), threshold), count)
    return Validation(len(seen), threshold, *scores_at(curve, threshold), average_precision(curve), by_class)


def _matching(detections: list, panorama: LabelledPanorama, names: list[str], chosen: list[str]) -> Matching:
    """The detections of a panorama against its objects, both of the chosen classes alone."""
    found = [one for one in detections if one.label in chosen]
    boxes = zip(panorama.labels, panorama.boxes, strict=True)
    objects = [TrueObject(k, names[label], box, box, 1.0) for k, (label, box) in enumerate(boxes)]
    counts = ~panorama.ignored & [thing.label in chosen for thing in objects]
    return match_detections(found, objects, panorama.image.shape[1], counts)
