"""Answers that students may give to lessons 11 to 13, for test_exercise_answers.py."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.geometry import wrap_angle

PI = np.pi


def area(box):
    return (box[2] - box[0]) * (box[3] - box[1])


def across(a, b, turn=0):
    return max(0, min(a[2], b[2] + turn) - max(a[0], b[0] + turn))


def down(a, b):
    return min(a[3], b[3]) - max(a[1], b[1])


def iou(shared, a, b):
    return shared / (area(a) + area(b) - shared)


def moved_if_across(a, b, width):
    a, b = ([u - width, v, w - width, x] if w > width else [u, v, w, x] for u, v, w, x in (a, b))
    return iou(across(a, b) * max(0, down(a, b)), a, b)


def turns(a, b, width):
    return [across(a, b, turn) for turn in (-width, 0, width)]


def nearest_copy(a, b, width):
    gap = (b[0] + b[2] - a[0] - a[2]) / 2
    return iou(across(a, b, (gap + width / 2) % width - width / 2 - gap) * max(0, down(a, b)), a, b)


def centre(boxes):
    return boxes[:, [0, 2]].mean(axis=1)


def hue_arrow(hues, saturations):
    return np.sum(saturations * np.exp(1j * np.radians(hues)))


def gap(a_u, a_l):
    return np.abs(wrap_angle(a_l - a_u))


def elevation(v, height):
    return (0.5 - v / height) * PI


def struck(table, largest, rounds=None, blank=0, start=-1):
    """Repeated maximum or minimum of a table; without `rounds`, until nothing above 0 is left."""
    table, result = np.array(table, float), np.full(len(table), start)
    while table.max() > 0 if rounds is None else (rounds := rounds - 1) >= 0:
        i, j = np.unravel_index(table.argmax() if largest else table.argmin(), table.shape)
        result[i] = j
        table[i], table[:, j] = blank, blank
    return result


def by_order(table, order, last=math.inf):
    """One-to-one along a sorted list of all combinations, as long as they are below `last`."""
    result = np.full(len(table), -1)
    for k in order:
        i, j = divmod(int(k), table.shape[1])
        if result[i] < 0 and j not in result and table[i, j] < last:
            result[i] = j
    return result


def best_sum(counts):
    result = np.full(len(counts), -1)
    i, j = linear_sum_assignment(-counts)
    result[i] = np.where(counts[i, j] > 0, j, -1)
    return result


# Exercise, answer, words of the hint that must come.
WRONG = [
    ("11.2", lambda a, b, w: np.sign(a - b) * min(abs(a - b), w - abs(a - b)) / w * 360, "sign and all"),
    ("11.3", lambda c, w: -np.angle(np.exp(2j * PI * c / w).sum()) / (2 * PI) * w % w, "mirrored"),
    ("12.1", moved_if_across, "try all turns"),
    ("12.1", lambda a, b, w: iou(sum(turns(a, b, w)) * down(a, b), a, b), "cut the length down off at 0"),
    ("12.1", lambda a, b, w: sum(turns(a, b, w)) * max(0, down(a, b)) / max(area(a), area(b)), "larger box"),
    ("12.2", lambda boxes, w: (centre(boxes) >= w / 8) & (centre(boxes) < w), "Your range ends at W"),
    ("12.2", lambda boxes, w: (boxes[:, 2] >= w / 8) & (boxes[:, 2] < w / 8 + w), "right edge"),
    ("12.2", lambda boxes, w: np.abs(centre(boxes) - 5 * w / 8) <= w / 2, "twice in all"),
    ("12.3", lambda h, s: abs(np.angle(hue_arrow(h, s), deg=True)), "turns -10 into 10"),
    ("12.3", lambda h, s: np.angle(hue_arrow(h, s), deg=True) + 180, "opposite colour"),
    ("12.3", lambda h, s: np.angle(hue_arrow(h, s)) % (2 * PI), "degrees"),
    (
        "13.1",
        lambda a, b, e: np.where(gap(a, b) > PI / 2, PI / 2 - e, np.arcsin(np.cos(e) * np.sin(gap(a, b)))),
        "the lower one",
    ),
    (
        "13.1",
        lambda a, b, e: np.where(gap(a, b) > PI / 2, PI / 2 - abs(e), np.cos(e) * np.sin(gap(a, b))),
        "arcsine is missing",
    ),
    ("13.1", lambda a, b, e: np.arcsin(np.cos(e) * np.sin(gap(a, b))), "beyond pi/2 use the pole"),
    ("13.2", lambda v, rho, b, h: v - b / rho / PI * h, "not to the angle"),
    ("13.2", lambda v, rho, b, h: (0.5 - np.arctan(np.tan(elevation(v, h)) + rho / b) / PI) * h, "range / baseline"),
    ("13.2", lambda v, rho, b, h: (0.5 + np.arctan(np.tan(elevation(v, h)) + b / rho) / PI) * h, "upside down"),
    ("13.3", lambda counts: struck(counts, largest=True, rounds=min(counts.shape)), "stop at 0"),
    ("13.3", lambda counts: struck(counts, largest=True, rounds=len(counts)), "Stop at 0"),
    ("13.3", lambda counts: struck(counts, largest=True, start=0), "must hold -1"),
    ("13.3", best_sum, "largest sum"),
]
# Exercise, answer by another way than the solution.
RIGHT = [
    ("11.2", lambda a, b, w: np.degrees(wrap_angle((a - b) / w * 2 * PI))),
    ("11.3", lambda c, w: (0.5 - np.angle(np.exp(2j * PI * (0.5 - c / w)).sum()) / (2 * PI)) * w % w),
    ("12.1", nearest_copy),
    ("12.2", lambda boxes, w: [w / 8 <= (box[0] + box[2]) / 2 < w / 8 + w for box in boxes]),
    ("12.2", lambda boxes, w: ((centre(boxes) - w / 8) // w == 0).astype(int)),
    ("12.3", lambda h, s: np.angle(hue_arrow(h, s), deg=True) % 360),
    (
        "13.1",
        lambda a, b, e: np.arcsin(np.cos(e) * np.where(gap(a, b) > PI / 2, 1, np.sin(gap(a, b)))),
    ),
    ("13.2", lambda v, rho, b, h: np.arctan2(rho, rho / np.tan(v / h * PI) + b) / PI * h),
    ("13.3", lambda counts: by_order(-counts, np.argsort(-counts, axis=None), last=0)),
]
