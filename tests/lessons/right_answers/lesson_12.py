"""Right answers to lesson 12 by other ways than its solutions."""

import numpy as np


def across(a, b, turn=0):
    return max(0, min(a[2], b[2] + turn) - max(a[0], b[0] + turn))


def iou(across, a, b):
    shared = across * max(0, min(a[3], b[3]) - max(a[1], b[1]))
    return shared / (sum((box[2] - box[0]) * (box[3] - box[1]) for box in (a, b)) - shared)


def nearest_copy(a, b, width):
    gap = (b[0] + b[2] - a[0] - a[2]) / 2
    return iou(across(a, b, (gap + width / 2) % width - width / 2 - gap), a, b)


def suppressed(boxes, scores, threshold, limit):
    """The surest stays, all that overlap it go, and again with what is left."""
    best, classes, kept = scores.max(axis=1), scores.argmax(axis=1), []
    left = [i for i in np.argsort(best)[::-1] if best[i] >= threshold]
    while left:
        kept.append(k := left.pop(0))
        same = [i for i in left if classes[i] == classes[k]]
        gone = [i for i in same if iou(across(boxes[i], boxes[k]), boxes[i], boxes[k]) > limit]
        left = [i for i in left if i not in gone]
    return kept


def lowest(scores, right, least, z=1.96):
    """With Wilson's lower end as the lower root of (p - k / n)^2 = z^2 p (1 - p) / n."""
    for t in sorted(set(scores)):
        n, hits = (scores >= t).sum(), right[scores >= t].sum()
        if np.roots([1 + z * z / n, -2 * hits / n - z * z / n, (hits / n) ** 2]).real.min() >= least:
            return t
    return np.inf


def just_below(scores, right, least):
    """Between two scores: keeps the same boxes."""
    t = lowest(scores, right, least)
    return t if np.isinf(t) else (t + max(scores[scores < t], default=-t)) / 2


RIGHT = [
    ("12.1", lambda boxes, w, s: ((boxes[:, [0, 2]].mean(axis=1) - s) // w == 0).astype(int)),
    ("12.2", nearest_copy),
    ("12.3", suppressed),
    ("12.4", lowest),
    ("12.4", just_below),
    ("12.4", lambda *given: lowest(*given, 1.959964)),
]
