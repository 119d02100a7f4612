"""Every object whole once, and counted once: the seam of a panorama (paper 2, figure 3) and suppression.

A panorama is cut behind the camera, so the left quarter is appended at the right. Now every object up to a quarter wide
is whole somewhere, but those of the appended quarter are there twice. The copy whose centre lies in this range counts:

    W/8 <= centre < W/8 + W

Centres jitter by a few pixels from one copy to the other. So the range has a margin, and the duplicates that it lets in
are suppressed on the circle. The boxes that suppression takes away vote on where the box that stays is (Gidaris and
Komodakis, 2015), which halves its jitter. Source: paper 2, section 2.2.
"""

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import box_area, box_iou, shared_area, wrapped_box

# Shares of the panorama's width. A cut copy that the margin lets in shows at least 3/4 of its object, enough for the
# whole copy to suppress it.
MARGIN = 1 / 32  # of the valid range at either end (11 degrees)
EDGE_TOLERANCE = 1 / 64  # how near to an end of the extended image a box counts as cut by it
# Intersection over union above which boxes of two classes are one object that got two names; of 0.8, 0.65 and 0.5 the
# one with the best F1 on the validation rooms.
SAME_OBJECT_IOU = 0.65
# Intersection over union from which a box votes on another's place. On the validation rooms 0.5 to 0.8 do about as well
# (data/detector/README.md): centres miss exact ones by 2.96 rows, without votes by 3.22.
VOTE_IOU = 0.6
VOTE_SCORE = 0.1  # Smallest score of a box that votes. On these rooms 0.05 to 0.3 do about as well.


def appended_columns(width: int) -> int:
    """Return how many columns are appended at the right: a quarter of the panorama's width, rounded."""
    return round(width / 4)


def extend_seam(image: np.ndarray) -> np.ndarray:
    """Return the panorama (H, W, ...) with its left quarter added: (H, 1.25 W, ...). Source: paper 2, section 2.2."""
    return np.concatenate([image, image[:, : appended_columns(image.shape[1])]], axis=1)


def valid_range(width: int) -> tuple[float, float]:
    """Return the columns [start, stop) of the extended image in which a centre counts: [W/8, W/8 + W)."""
    start = appended_columns(width) / 2
    return start, start + width


def centres_in_range(boxes: np.ndarray, width: int, margin: float = 0.0) -> np.ndarray:
    """Return which boxes (n, 4) have their centre in the valid range. `margin` in pixels widens it."""
    start, stop = valid_range(width)
    centre = (boxes[:, 0] + boxes[:, 2]) / 2
    return (centre >= start - margin) & (centre < stop + margin)


def join_cut_pairs(
    boxes: np.ndarray, scores: np.ndarray, classes: np.ndarray, width: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Join objects wider than a quarter that both ends of the extended image cut. Return boxes, scores, classes."""
    quarter, tolerance = appended_columns(width), EDGE_TOLERANCE * width
    at_left = (boxes[:, 0] <= tolerance) & (boxes[:, 2] >= quarter - tolerance)
    at_right = (boxes[:, 2] >= width + quarter - tolerance) & (boxes[:, 0] <= width + tolerance)
    gone = np.zeros(len(boxes), dtype=bool)
    boxes, scores = boxes.copy(), scores.copy()
    for right in np.flatnonzero(at_right & ~at_left):
        for left in np.flatnonzero(at_left & ~at_right & ~gone & (classes == classes[right])):
            pair = boxes[[left, right]]
            shared = pair[:, 3].min() - pair[:, 1].max()
            if shared > 0.5 * (pair[:, 3] - pair[:, 1]).min():
                start, end = boxes[right, 0], min(boxes[left, 2] + width, boxes[right, 0] + width)
                # Whole now, so it counts: of its places a turn apart, the one with its centre in the valid range.
                turn = width if (start + end) / 2 >= valid_range(width)[1] else 0
                boxes[right] = (start - turn, pair[:, 1].min(), end - turn, pair[:, 3].max())
                scores[right] = max(scores[left], scores[right])
                gone[left] = True
                break
    return boxes[~gone], scores[~gone], classes[~gone]


def select_on_circle(
    boxes: np.ndarray, scores: np.ndarray, classes: np.ndarray, width: int, iou_threshold: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return one detection per object, 0 <= u_min < W, the greatest score first, from those on the extended image.

    Of boxes of one class that overlap beyond `iou_threshold` one stays: a whole one before a cut one, one with its
    centre inside the range before one in the margin, then the surer one. It takes the greatest score that it replaces.
    """
    tolerance = EDGE_TOLERANCE * width
    boxes, scores, classes = join_cut_pairs(boxes, scores, classes, width)
    near = centres_in_range(boxes, width, MARGIN * width)
    boxes, scores, classes = boxes[near], scores[near], classes[near]
    inside = centres_in_range(boxes, width)
    cut = (boxes[:, 0] <= tolerance) | (boxes[:, 2] >= width + appended_columns(width) - tolerance)
    boxes = wrapped_box(
        np.column_stack([boxes[:, :2], np.minimum(boxes[:, 2], boxes[:, 0] + width), boxes[:, 3]]), width
    )
    iou = box_iou(boxes, boxes, width)
    overlap = np.where(cut[None, :], shared_area(boxes, boxes, width) / box_area(boxes)[None, :], iou)
    overlap = _limit_by_class(overlap, iou, classes)
    kept = _suppress(overlap, scores + inside - 2.0 * cut, iou_threshold)
    # For each kept box the greatest score among itself and those that it suppressed. `kept` is in the order of
    # suppression: what several overlap went with the first of them.
    replaces = overlap[kept] > iou_threshold
    replaces[np.arange(len(kept)), kept] = True
    replaces &= np.cumsum(replaces, axis=0) == 1
    best = np.where(replaces, scores, -np.inf).argmax(axis=1) if len(kept) else kept
    order = np.argsort(-scores[best], kind="stable")
    return boxes[kept[order]], scores[best[order]], classes[best[order]]


def _suppress(overlap: np.ndarray, rank: np.ndarray, threshold: float) -> np.ndarray:
    """Return indices (k,) of the boxes that stay, best rank first. overlap (n, n): of a kept one (row) with another."""
    kept: list[int] = []
    gone = np.zeros(len(rank), dtype=bool)
    for index in np.argsort(-rank, kind="stable"):
        if not gone[index]:
            kept.append(int(index))
            gone |= overlap[index] > threshold
    return np.array(kept, dtype=int)


def _limit_by_class(overlap: np.ndarray, iou: np.ndarray, classes: np.ndarray) -> np.ndarray:
    """Return the overlap (n, n) that counts: in a class as it is; across classes 1 above SAME_OBJECT_IOU, else 0."""
    return np.where(classes[:, None] == classes[None, :], overlap, np.where(iou > SAME_OBJECT_IOU, 1.0, 0.0))


def suppress_in_image(boxes: np.ndarray, scores: np.ndarray, classes: np.ndarray, iou_threshold: float) -> np.ndarray:
    """Return indices of the boxes (n, 4) of a plain image that stay, the greatest score first."""
    # A circle far longer than the image: nothing wraps around it.
    iou = box_iou(boxes, boxes, 10 * (boxes[:, 2].max(initial=0.0) + 1))
    return _suppress(_limit_by_class(iou, iou, classes), scores, iou_threshold)


def vote_on_boxes(boxes: np.ndarray, scores: np.ndarray, classes: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Return the kept boxes (k, 4), each the mean of those that nearly coincide with it, weighted by score.

    b_k = sum_i s_i b_i / sum_i s_i,  over all i of its class with IoU(b_i, b_k) >= VOTE_IOU, s_i >= VOTE_SCORE, and k
    """
    iou = box_iou(boxes[kept], boxes, 10 * (boxes[:, 2].max(initial=0.0) + 1))
    votes = (iou >= VOTE_IOU) & (classes[kept][:, None] == classes) & (scores >= VOTE_SCORE)
    votes[np.arange(len(kept)), kept] = True
    weight = votes * np.maximum(scores, 1e-9)
    return (weight @ boxes) / weight.sum(axis=1, keepdims=True)
