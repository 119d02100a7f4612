"""How well a detector finds the objects of panoramas: precision and recall at an overlap, the choice of a threshold.

A detection is right when its class is the object's and their boxes overlap enough; each object is found once. Objects
that are too much hidden or too small are ignored: who finds one, by the same rule, neither gains nor loses.
Source: paper 2, section 2.2 (the detector); the scores are those of the PASCAL VOC challenge.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import box_iou

IOU_THRESHOLD = 0.5


class DetectionScoreError(ValueError):
    """Detections or objects that cannot be scored."""


@dataclass(frozen=True)
class Boxes:
    """The detections, or the objects, of one panorama."""

    labels: Sequence[str]
    """n class names."""
    boxes: np.ndarray
    """(n, 4) u_min, v_min, u_max, v_max, edge coordinates; u_max may pass the width at the seam."""
    scores: np.ndarray | None = None
    """(n,) scores; objects have none."""


@dataclass(frozen=True)
class Matching:
    """What became of the detections of one panorama."""

    scores: np.ndarray
    """(k,) scores of the detections that count, ignored ones left out."""
    correct: np.ndarray
    """(k,) boolean: found an object that no better detection had found."""
    object_index: np.ndarray
    """(k,) which object, -1 for a false alarm."""
    detection_index: np.ndarray
    """(k,) which detection of those given."""
    n_objects: int
    """Objects to be found."""


@dataclass(frozen=True)
class PrecisionRecall:
    """Precision and recall over falling thresholds."""

    threshold: np.ndarray
    """(k,) scores, falling: entry i keeps all detections of at least this score."""
    precision: np.ndarray
    """(k,) share of the kept detections that are right."""
    recall: np.ndarray
    """(k,) share of the objects that are found."""


def match_detections(
    detections: Boxes, objects: Boxes, ignored: Boxes, width: float, iou_threshold: float = IOU_THRESHOLD
) -> Matching:
    """Pairs the detections of one panorama with its objects, best score first, each object at most once.

    A detection takes the free object of its class that it overlaps most, if IoU >= `iou_threshold`. One that finds
    none is left out of the count when it overlaps an ignored object of its class that much; else it is a false alarm:
    another class, or a small box inside a large ignored object, says what is not so. `width` is the panorama's, in
    pixels. Raises `DetectionScoreError` for detections without scores or lists of unequal length, `DetectionError`
    for what is no box.
    """
    for name, given in (("detections", detections), ("objects", objects), ("ignored", ignored)):
        if len(given.labels) != len(given.boxes):
            raise DetectionScoreError(
                f"{name}: {len(given.labels)} labels and {len(given.boxes)} boxes; one label for each box is needed"
            )
    if detections.scores is None or len(detections.scores) != len(detections.labels):
        raise DetectionScoreError("detections need one score each, to say which comes first")
    scores = np.asarray(detections.scores, dtype=np.float64)
    if not np.isfinite(scores).all():
        raise DetectionScoreError("detections: scores must be finite; got NaN or infinity")
    overlap = _overlaps_in_class(detections, objects, width)
    excused = (_overlaps_in_class(detections, ignored, width) >= iou_threshold).any(axis=1)
    free = np.ones(len(objects.labels), dtype=bool)
    kept, found = [], []
    for index in np.argsort(-scores, kind="stable"):
        candidates = np.where(free, overlap[index], -1.0)
        best = int(candidates.argmax()) if len(candidates) else -1
        if best >= 0 and candidates[best] >= iou_threshold:
            free[best] = False
        elif excused[index]:
            continue
        else:
            best = -1
        kept.append(int(index))
        found.append(best)
    kept, found = np.array(kept, dtype=np.int64), np.array(found, dtype=np.int64)
    return Matching(scores[kept], found >= 0, found, kept, len(objects.labels))


def precision_recall_curve(matchings: Sequence[Matching]) -> PrecisionRecall:
    """Precision and recall of many panoramas together, at every score that occurs.

    precision(t) = right detections with score >= t / all detections with score >= t
    recall(t)    = right detections with score >= t / objects

    Ignored detections are in neither count. Raises `DetectionScoreError` when there is no object at all.
    """
    n_objects = sum(matching.n_objects for matching in matchings)
    if n_objects == 0:
        raise DetectionScoreError("there is no object to be found in these panoramas, so recall is not defined")
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


def _overlaps_in_class(a: Boxes, b: Boxes, width: float) -> np.ndarray:
    """IoU (n, m) of the boxes of both, 0 where the classes differ."""
    if not len(a.labels) or not len(b.labels):
        return np.zeros((len(a.labels), len(b.labels)))
    same = np.asarray(a.labels, object)[:, None] == np.asarray(b.labels, object)[None, :]
    return np.where(same, box_iou(a.boxes, b.boxes, width), 0.0)
