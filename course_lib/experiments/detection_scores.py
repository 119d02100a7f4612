"""Which detections of a panorama are right: their class is the object's, and their boxes overlap enough.

Each object is found once. Objects that are too much hidden or too small are ignored: a detection that finds one, by the
same rule, neither gains nor loses. Source: paper 2, section 2.2 (the detector); the rules are those of the PASCAL VOC
challenge.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from course_lib.experiments.room import counts_as_object
from course_lib.spherical_stereo.detection.detected_object import box_iou
from course_lib.spherical_stereo.recording import TrueObject

IOU_THRESHOLD = 0.5


class DetectionScoreError(ValueError):
    """Detections or objects that cannot be scored."""


@dataclass(frozen=True)
class Boxes:
    """The detections, or the objects, of one panorama."""

    labels: Sequence[str]  # n class names
    boxes: np.ndarray  # (n, 4) u_min, v_min, u_max, v_max, edge coordinates; u_max may pass the width at the seam
    scores: np.ndarray | None = None  # (n,) scores; objects have none


@dataclass(frozen=True)
class Matching:
    """What became of the detections of one panorama."""

    scores: np.ndarray  # (k,) scores of the detections that count, ignored ones left out
    correct: np.ndarray  # (k,) boolean: found an object that no better detection had found
    object_index: np.ndarray  # (k,) which object, -1 for a false alarm
    detection_index: np.ndarray  # (k,) which detection of those given
    n_objects: int  # Objects to be found


def match_detections(
    detections: Boxes, objects: Boxes, ignored: Boxes, width: float, iou_threshold: float = IOU_THRESHOLD
) -> Matching:
    """Pairs the detections of one panorama with its objects, best score first, each object at most once.

    A detection takes the free object of its class that it overlaps most, if IoU >= `iou_threshold`. One that finds
    none is left out of the count when it overlaps an ignored object of its class that much; else it is a false alarm.
    width: of the panorama, pixels.
    """
    scores = np.asarray(detections.scores, dtype=np.float64)
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


def _overlaps_in_class(a: Boxes, b: Boxes, width: float) -> np.ndarray:
    """IoU (n, m) of the boxes of both, 0 where the classes differ."""
    if not len(a.labels) or not len(b.labels):
        return np.zeros((len(a.labels), len(b.labels)))
    same = np.asarray(a.labels, object)[:, None] == np.asarray(b.labels, object)[None, :]
    return np.where(same, box_iou(a.boxes, b.boxes, width), 0.0)


def match_image(detections: Sequence, objects: Sequence[TrueObject], width: int) -> Matching:
    """The detections of one panorama against its objects."""
    wanted = [thing for thing in objects if counts_as_object(thing, width)]
    ignored = [thing for thing in objects if not counts_as_object(thing, width)]
    boxes = np.array([one.box for one in detections], float).reshape(-1, 4)
    scores = np.array([one.score for one in detections], float)
    return match_detections(
        Boxes([one.label for one in detections], boxes, scores), *map(_boxes, (wanted, ignored)), width
    )


def _boxes(objects: Sequence[TrueObject]) -> Boxes:
    return Boxes([thing.label for thing in objects], np.array([thing.visible_box for thing in objects]).reshape(-1, 4))
