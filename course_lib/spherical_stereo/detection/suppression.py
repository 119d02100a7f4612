"""Non-maximum suppression: of boxes that show the same object, the best one stays.

A network answers for one object with several overlapping boxes. Within a class the overlap limit is low (Darknet's
0.45); a chair half behind a table overlaps it, so across classes only boxes that nearly coincide count as one object
under two names.

The boxes that go are not lost: they vote on where the box that stays is (Gidaris and Komodakis, 2015). One box alone
moves by a pixel or two when the image is shifted by less than the network's stride, and a pixel between the upper and
the lower centre costs a quarter of a metre at 4 m (2.4); the mean of several moves half as much.
"""

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import box_iou

SAME_OBJECT_IOU = 0.65
"""Intersection over union above which boxes of two classes are one object that got two names; of 0.8, 0.65 and 0.5 the
one with the best F1 on the validation rooms."""

VOTE_IOU = 0.6
"""Intersection over union from which a box votes on another's place. On the validation rooms 0.5 to 0.8 do about as
well (data/detector/README.md): centres miss exact ones by 2.96 rows, without votes by 3.22."""

VOTE_SCORE = 0.1
"""Smallest score of a box that votes. On these rooms 0.05 to 0.3 do about as well."""


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


def vote_on_boxes(boxes: np.ndarray, scores: np.ndarray, classes: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """The kept boxes (k, 4), each the mean of those of its class that nearly coincide with it, weighted by score.

    b_k = sum_i s_i b_i / sum_i s_i,  over all i with IoU(b_i, b_k) >= VOTE_IOU, s_i >= VOTE_SCORE and k itself.

    boxes (n, 4) of a plain image, scores (n,), classes (n,): all candidates. kept (k,): indices of those that stay.
    """
    if len(kept) == 0:
        return boxes[kept]
    iou = box_iou(boxes[kept], boxes, 10 * (boxes[:, 2].max() + 1))
    votes = (iou >= VOTE_IOU) & (classes[kept][:, None] == classes) & (scores >= VOTE_SCORE)
    votes[np.arange(len(kept)), kept] = True
    weight = votes * np.maximum(scores, 1e-9)
    return (weight @ boxes) / weight.sum(axis=1, keepdims=True)
