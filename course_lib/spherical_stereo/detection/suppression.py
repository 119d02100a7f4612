"""Non-maximum suppression: of boxes that show the same object, the best one stays.

Within a class the overlap limit is low (Darknet's 0.45). Across classes only boxes that nearly coincide count as one
object. The boxes that go vote on where the box that stays is (Gidaris and Komodakis, 2015), which halves its jitter.
"""

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import box_iou

# Intersection over union above which boxes of two classes are one object that got two names; of 0.8, 0.65 and 0.5 the
# one with the best F1 on the validation rooms.
SAME_OBJECT_IOU = 0.65
# Intersection over union from which a box votes on another's place. On the validation rooms 0.5 to 0.8 do about as well
# (data/detector/README.md): centres miss exact ones by 2.96 rows, without votes by 3.22.
VOTE_IOU = 0.6
VOTE_SCORE = 0.1  # Smallest score of a box that votes. On these rooms 0.05 to 0.3 do about as well.


def suppress(overlap: np.ndarray, rank: np.ndarray, threshold: float) -> np.ndarray:
    """Return indices (k,) of the boxes that stay, best rank first. overlap (n, n): of a kept one (row) with another."""
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
    """Return the kept boxes (k, 4), each the mean of those of its class that nearly coincide with it, weighted by
    score.

    b_k = sum_i s_i b_i / sum_i s_i,  over all i with IoU(b_i, b_k) >= VOTE_IOU, s_i >= VOTE_SCORE and k itself.
    """
    if len(kept) == 0:
        return boxes[kept]
    iou = box_iou(boxes[kept], boxes, 10 * (boxes[:, 2].max() + 1))
    votes = (iou >= VOTE_IOU) & (classes[kept][:, None] == classes) & (scores >= VOTE_SCORE)
    votes[np.arange(len(kept)), kept] = True
    weight = votes * np.maximum(scores, 1e-9)
    return (weight @ boxes) / weight.sum(axis=1, keepdims=True)
