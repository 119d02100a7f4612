"""Non-maximum suppression: of boxes that show the same object, the best one stays.

A network answers for one object with several overlapping boxes. Within a class the overlap limit is low (Darknet's
0.45); a chair half behind a table overlaps it, so across classes only boxes that nearly coincide count as one object
under two names.
"""

import numpy as np

from course_lib.spherical_stereo.boxes import box_iou

SAME_OBJECT_IOU = 0.65
"""Intersection over union above which boxes of two classes are one object that got two names; of 0.8, 0.65 and 0.5 the
one with the best F1 on the validation rooms."""


def suppress(overlap: np.ndarray, rank: np.ndarray, threshold: float) -> np.ndarray:
    """Greedy suppression: indices (k,) of those that stay, best rank first.

    overlap (n, n), of a kept one (row) with another (column); rank (n,), greater is better, at a tie the first. What
    overlaps a kept one by more than the threshold goes.
    """
    kept: list[int] = []
    gone = np.zeros(len(rank), dtype=bool)
    for index in np.argsort(-np.asarray(rank, dtype=np.float64), kind="stable"):
        if not gone[index]:
            kept.append(int(index))
            gone |= overlap[index] > threshold
    return np.array(kept, dtype=int)


def limit_by_class(overlap: np.ndarray, iou: np.ndarray, classes: np.ndarray) -> np.ndarray:
    """The overlap (n, n) that counts: within a class as it is; across classes 1 above SAME_OBJECT_IOU, else 0."""
    same = classes[:, None] == classes[None, :]
    return np.where(same, overlap, np.where(iou > SAME_OBJECT_IOU, 1.0, 0.0))


def suppress_in_image(boxes: np.ndarray, scores: np.ndarray, classes: np.ndarray, iou_threshold: float) -> np.ndarray:
    """Indices of the boxes (n, 4) of a plain image that stay, the greatest score first."""
    if len(boxes) == 0:
        return np.zeros(0, dtype=int)
    # A circle far longer than the image: nothing wraps around it.
    iou = box_iou(boxes, boxes, 10 * (boxes[:, 2].max() + 1))
    return suppress(limit_by_class(iou, iou, classes), scores, iou_threshold)
