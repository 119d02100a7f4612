"""Right answers to lesson 12 by other ways than its solutions."""

import numpy as np


def centre(boxes):
    return boxes[:, [0, 2]].mean(axis=1)


def area(box):
    return (box[2] - box[0]) * (box[3] - box[1])


def across(a, b, turn=0):
    return max(0, min(a[2], b[2] + turn) - max(a[0], b[0] + turn))


def iou(across, a, b):
    shared = across * max(0, min(a[3], b[3]) - max(a[1], b[1]))
    return shared / (area(a) + area(b) - shared)


def nearest_copy(a, b, width):
    gap = (b[0] + b[2] - a[0] - a[2]) / 2
    return iou(across(a, b, (gap + width / 2) % width - width / 2 - gap), a, b)


def suppressed(boxes, scores, threshold, limit):
    """The surest stays, all that overlap it go, and again with what is left."""
    best, classes = scores.max(axis=1), scores.argmax(axis=1)
    left, kept = [i for i in np.argsort(best)[::-1] if best[i] >= threshold], []
    while left:
        k = left.pop(0)
        kept.append(k)
        fits = [iou(across(boxes[i], boxes[k]), boxes[i], boxes[k]) <= limit or classes[i] != classes[k] for i in left]
        left = [i for i, fit in zip(left, fits, strict=True) if fit]
    return kept


def class_after_class(boxes, scores, threshold, limit):
    classes, kept = scores.argmax(axis=1), []
    for one in range(scores.shape[1]):
        rows = np.flatnonzero(classes == one)
        kept += [rows[i] for i in suppressed(boxes[rows], scores[rows], threshold, limit)]
    return np.array(sorted(kept, key=lambda i: -scores[i].max()), dtype=int)


def good_thresholds(scores, right, least, z=1.96):
    """With Wilson's lower end as the lower root of (p - k / n)^2 = z^2 p (1 - p) / n."""
    good = []
    for t in sorted(set(scores)):
        n, hits = (scores >= t).sum(), right[scores >= t].sum()
        low = np.roots([1 + z * z / n, -2 * hits / n - z * z / n, (hits / n) ** 2]).real.min()
        good += [t] * bool(low >= least)
    return good


def just_below(scores, right, least):
    """Between two scores: keeps the same boxes."""
    good = good_thresholds(scores, right, least)
    below = scores[scores < good[0]] if good else []
    return np.inf if not good else (good[0] + below.max()) / 2 if len(below) else 0.0


RIGHT = [
    ("12.1", lambda boxes, w, s: [s <= (box[0] + box[2]) / 2 < s + w for box in boxes]),
    ("12.1", lambda boxes, w, s: ((centre(boxes) - s) // w == 0).astype(int)),
    ("12.2", nearest_copy),
    ("12.2", lambda a, b, w: [iou(sum(across(a, b, turn) for turn in (-w, 0, w)), a, b)]),
    ("12.3", suppressed),
    ("12.3", class_after_class),
    ("12.4", lambda s, r, least: (good_thresholds(s, r, least) or [np.inf])[0]),
    ("12.4", just_below),
    ("12.4", lambda s, r, least: (good_thresholds(s, r, least, 1.959964) or [np.inf])[0]),
]
