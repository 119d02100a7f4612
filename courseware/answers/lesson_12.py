"""Exercises of lesson 12: the range in which a box counts, overlap on the circle, suppression, a threshold."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise
from courseware.lessons.kit.mistakes import edited

WIDTHS = (640, 1280, 1920)


def counts_once(boxes, width, start):
    """Which boxes (n, 4) of the extended image count; width is that of the panorama itself."""
    # The centre, in a range one turn wide. With both ends in, an object there would count twice.
    centre = (boxes[:, 0] + boxes[:, 2]) / 2
    return (centre >= start) & (centre < start + width)


def boxes_near_the_ends(rng: np.random.Generator) -> tuple:
    """Return boxes of the extended image, most of them near an end of the range, and one centre on each end."""
    width, start, n = int(rng.choice(WIDTHS)), rng.choice([0.0625, 0.125, 0.1875]), int(rng.integers(12, 20))
    centres = rng.uniform(0.03, 1.22, n)
    centres[:8] = start + rng.uniform(-0.06, 0.06, 8) + rng.choice([0, 1], 8)
    centres[:2] = start, start + 1
    half = np.round(np.minimum(rng.uniform(0.01, 0.12, n), np.minimum(centres, 1.25 - centres)) * 64) / 64  # exact
    rows = np.sort(rng.uniform(0, 0.5, (n, 2)), axis=1)
    boxes = np.column_stack([centres - half, rows[:, 0], centres + half, rows[:, 1]]) * width
    return rng.permutation(boxes), width, float(start * width)


def overlap(a, b, width):
    """IoU of two boxes [u_min, v_min, u_max, v_max] on the circle of columns."""
    # b in three places, one shared area, the area of the union below.
    across = sum(max(0, min(a[2], b[2] + turn) - max(a[0], b[0] + turn)) for turn in (-width, 0, width))
    down = max(0, min(a[3], b[3]) - max(a[1], b[1]))
    shared = across * down
    areas = [(box[2] - box[0]) * (box[3] - box[1]) for box in (a, b)]
    return shared / (sum(areas) - shared)


def two_boxes(rng: np.random.Generator) -> tuple:
    """Return two boxes up to a quarter wide: they overlap, are apart, or one lies across the seam or a turn on."""
    width, kind = int(rng.choice(WIDTHS)), rng.integers(5)
    a = np.array([rng.uniform(0.3, 0.6) if kind == 0 else 0.9, 0.4, 0.0, 0.55])
    a[2] = a[0] + rng.uniform(0.1, 0.2)
    b = a + [*rng.uniform(-0.05, 0.05, 2)] * 2 + [0, 0, rng.uniform(-0.04, 0.05), 0]
    if kind == 1:  # below the other one, and often beside it: two negative lengths, whose product is positive
        b += [0, 0.3, 0, 0.3] - rng.choice([0, 0.35]) * np.array([1, 0, 1, 0])
    if kind in (2, 3):  # its left edge lies beyond the seam, so it is at the left of the image
        b[[0, 2]] += 0.05 - b[0]
    if kind == 4:  # only one of them passes the seam
        a[2], b[2] = rng.uniform(0.95, 0.99), rng.uniform(1.01, 1.08)
    a, b = rng.permutation([a, b]) * width  # both were shares of the width
    return a, b, width


def surest(boxes, scores, threshold, limit):
    """Rows (k,) of the boxes that stay after threshold and suppression, the surest first."""
    # The surest first; only boxes that stayed put others out, and only of their class.
    best, classes, kept = scores.max(axis=1), scores.argmax(axis=1), []
    areas = (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
    for i in np.argsort(-best):
        sides = np.minimum(boxes[i, 2:], boxes[kept, 2:]) - np.maximum(boxes[i, :2], boxes[kept, :2])
        shared = np.clip(sides, 0, None).prod(axis=1)
        in_the_way = (shared > limit * (areas[i] + areas[kept] - shared)) & (classes[kept] == classes[i])
        if best[i] >= threshold and not in_the_way.any():
            kept.append(i)
    return np.array(kept, dtype=int)


def scored(classes, best) -> np.ndarray:
    """Return scores (n, 3): `best` for each row's class, and less for the others."""
    scores = np.outer(best, [0.2, 0.3, 0.4])
    scores[np.arange(len(best)), classes] = best
    return scores


def answers_of_a_network(rng: np.random.Generator) -> tuple:
    """Return several boxes on each of a few things, of two classes now and then; all scores differ."""
    boxes, classes = [], []
    for _ in range(int(rng.integers(3, 6))):
        corner, size, label = rng.uniform(0, 600, 2), rng.uniform(40, 160, 2), int(rng.integers(3))
        for _ in range(int(rng.integers(2, 6))):
            moved = corner + rng.normal(0, 0.25, 2) * size
            boxes.append([*moved, *(moved + size * rng.uniform(0.8, 1.25, 2))])
            classes.append(label if rng.random() < 0.8 else (label + 1) % 3)
    scores = scored(classes, rng.permutation(np.linspace(0.15, 0.95, len(boxes))))
    return np.array(boxes), scores, float(rng.choice([0.2, 0.3, 0.5])), float(rng.choice([0.3, 0.45, 0.6]))


def squares(shifts: list, classes: list, best: list, threshold: float, limit: float) -> tuple:
    """Return squares of 10 pixels, so far to the right."""
    return np.array([0.0, 0, 10, 10]) + np.outer(shifts, [1, 0, 1, 0]), scored(classes, best), threshold, limit


def lowest_threshold(scores, right, least):
    """The lowest threshold at which Wilson's lower end of the precision is at least `least`; inf for none."""
    # Every score is tried, from the lowest up; the first that can be believed is the answer.
    z = 1.96
    for t in np.unique(scores):
        kept = scores >= t
        n, share = kept.sum(), right[kept].mean()
        root = z * np.sqrt(share * (1 - share) / n + z**2 / (4 * n**2))
        if (share + z**2 / (2 * n) - root) / (1 + z**2 / n) >= least:
            return t
    return np.inf


with_exact_z = edited(lowest_threshold, "1.96 => 1.959963984540054")


def refused(arguments, answer) -> str | None:
    """Say what is wrong with a threshold. We compare what it keeps, and Wilson's z may be 1.96 or more exact."""
    scores, right, least = arguments
    try:
        t = float(np.asarray(answer, dtype=float).reshape(()))
    except (TypeError, ValueError):
        return "Give one number, the threshold."
    if np.isnan(t):
        return "NaN says nothing. Where no threshold is good enough, the answer is np.inf, which keeps no box."
    wanted = {int((scores >= lowest(scores, right, least)).sum()) for lowest in (lowest_threshold, with_exact_z)}
    kept = int((scores >= t - 1e-6).sum())
    if kept in wanted:
        return None
    if kept == 0:
        return "Your threshold keeps no box, but one that can be believed exists. Have you tried them all?"
    if max(wanted) == 0:
        return "No threshold is good enough here, so the answer is np.inf."
    if kept > max(wanted):
        return "Your threshold is too low. With its boxes the lower end of the interval is below `least`."
    return "Your threshold is too high. A lower one still keeps the lower end at `least`, and finds more."


def validation_boxes(rng: np.random.Generator) -> tuple:
    """Return scores with two digits, so that some are equal, and boxes that are right more often at high scores."""
    scores = np.round(rng.uniform(0.05, 0.99, int(rng.integers(60, 200))), 2)
    return scores, rng.random(len(scores)) < scores**0.25, float(rng.choice([0.75, 0.8, 0.85]))


FOUR_SCORES = np.array([0.6, 0.9, 0.7, 0.8])

# fmt: off
EXERCISES = [
    Exercise("12.1", counts_once, boxes_near_the_ends, "warm-up", cases={
        "half columns": lambda rng: (np.array([[90.0, 0, 110, 9], [91, 0, 110, 9], [92, 0, 110, 9]]), 1280, 100.25),
        "no boxes": lambda rng: (np.zeros((0, 4)), 1280, 160.0),
    }),
    Exercise("12.2", overlap, two_boxes, cases={
        name: lambda rng, a=a, b=b: (np.array(a), np.array(b), 1280) for name, (a, b) in {
            "half a turn apart": ([100.0, 300, 200, 400], [740.0, 300, 840, 400]),
            "a across the seam": ([1200.0, 300, 1300, 400], [0.0, 300, 20, 400]),
            "b across the seam": ([0.0, 300, 20, 400], [1200.0, 300, 1300, 400]),
            "equal boxes": ([1200.0, 300, 1300, 400], [1200.0, 300, 1300, 400]),
            "side by side": ([100.0, 300, 200, 400], [200.0, 300, 300, 400]),
            "far apart": ([100.0, 300, 200, 400], [900.0, 450, 950, 500]),
        }.items()
    }, example=(([1200, 300, 1300, 400], [0, 300, 20, 400], 1280), 0.2)),
    Exercise("12.3", surest, answers_of_a_network, cases={
        "a chain of overlaps": lambda rng: squares([0, 4, 8], [0, 0, 0], [0.9, 0.8, 0.7], 0.1, 0.4),
        "one place and two classes": lambda rng: squares([0, 0], [0, 1], [0.6, 0.7], 0.1, 0.4),
        "an IoU equal to the limit": lambda rng: squares([0, 5], [1, 1], [0.6, 0.7], 0.1, 1 / 3),
        "a score equal to the threshold": lambda rng: squares([0, 30], [1, 1], [0.5, 0.7], 0.5, 0.4),
        "no score that is enough": lambda rng: squares([0, 30], [1, 1], [0.2, 0.3], 0.5, 0.4),
        "boxes apart": lambda rng: squares([30, 0, 60], [1, 1, 1], [0.5, 0.7, 0.6], 0.1, 0.4),
        "no boxes": lambda rng: (np.zeros((0, 4)), np.zeros((0, 3)), 0.5, 0.4),
        "two likely classes":
            lambda rng: (np.tile([0.0, 0, 10, 10], (2, 1)), np.array([[0.9, 0.1], [0.7, 0.6]]), 0.5, 0.4),
    }, example=(([[0, 0, 10, 10], [4, 0, 14, 10], [8, 0, 18, 10]], [[0.9, 0], [0.8, 0], [0.7, 0]], 0.5, 0.4), [0, 2])),
    Exercise("12.4", lowest_threshold, validation_boxes, "challenge", verify=refused, cases={
        "four right boxes": lambda rng: (FOUR_SCORES, np.ones(4, bool), 0.5),
        "too few boxes to be sure": lambda rng: (FOUR_SCORES, np.ones(4, bool), 0.6),
        "all boxes wrong": lambda rng: (np.linspace(0.1, 0.9, 50), np.zeros(50, bool), 0.5),
        "equal scores": lambda rng: (np.full(40, 0.5), np.arange(40) < 36, 0.8),
        "several crossings": lambda rng: (np.round(np.linspace(0.99, 0.2, 80), 2), np.arange(80) // 4 != 5, 0.8),
    }, example=(([0.6, 0.9, 0.7, 0.8], [True, True, True, True], 0.5), 0.6)),
]
