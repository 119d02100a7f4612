"""Exercises of lesson 12: the range in which a box counts, overlap on the circle, suppression, a threshold."""

import numpy as np

from course_lib.lessons.kit.cases import case
from course_lib.lessons.kit.exercises import Exercise
from course_lib.lessons.kit.mistakes import edited

WIDTHS = (640, 1280, 1920)

# 12.1: which boxes count


def counts_once(boxes, width, start):
    """Which boxes (n, 4) of the extended image count; width is that of the panorama itself."""
    # The centre, in a range one turn wide. With both ends in, an object there would count twice.
    centre = (boxes[:, 0] + boxes[:, 2]) / 2
    return (centre >= start) & (centre < start + width)


def boxes_near_the_ends(rng: np.random.Generator) -> tuple:
    """Boxes of the extended image, most of them near an end of the range, and always one with its centre on each."""
    width, start, n = int(rng.choice(WIDTHS)), rng.choice([0.0625, 0.125, 0.1875]), int(rng.integers(12, 20))
    centres = rng.uniform(0.03, 1.22, n)
    centres[:8] = start + rng.uniform(-0.06, 0.06, 8) + rng.choice([0, 1], 8)
    centres[:2] = start, start + 1
    half = np.round(np.minimum(rng.uniform(0.01, 0.12, n), np.minimum(centres, 1.25 - centres)) * 64) / 64  # exact
    rows = np.sort(rng.uniform(0, 0.5, (n, 2)), axis=1)
    boxes = np.column_stack([centres - half, rows[:, 0], centres + half, rows[:, 1]]) * width
    return rng.permutation(boxes), width, float(start * width)


# 12.2: overlap of two boxes across the seam


def overlap(a, b, width):
    """IoU of two boxes [u_min, v_min, u_max, v_max] on the circle of columns."""
    # b in three places, one shared area, the area of the union below.
    across = sum(max(0, min(a[2], b[2] + turn) - max(a[0], b[0] + turn)) for turn in (-width, 0, width))
    down = max(0, min(a[3], b[3]) - max(a[1], b[1]))
    shared = across * down
    areas = [(box[2] - box[0]) * (box[3] - box[1]) for box in (a, b)]
    return shared / (sum(areas) - shared)


def two_boxes(rng: np.random.Generator) -> tuple:
    """Two boxes up to a quarter wide: overlapping, apart, one with its columns one turn on, one across the seam."""
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


def box(*edges):
    return np.array(edges, dtype=float)


def multiplied_first(a, b, width):
    """A mistake: the two lengths are multiplied before they are cut off at 0."""
    down = min(a[3], b[3]) - max(a[1], b[1])
    shared = max((min(a[2], b[2] + turn) - max(a[0], b[0] + turn)) * down for turn in (-width, 0, width))
    areas = [(box[2] - box[0]) * (box[3] - box[1]) for box in (a, b)]
    return max(shared, 0) / (sum(areas) - max(shared, 0))


# 12.3: threshold and suppression


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
    """Scores (n, 3): `best` for each row's class, and less for the others."""
    scores = np.outer(best, [0.2, 0.3, 0.4])
    scores[np.arange(len(best)), classes] = best
    return scores


def answers_of_a_network(rng: np.random.Generator) -> tuple:
    """Several boxes on each of a few things, of two classes now and then, in any order; scores all differ."""
    boxes, classes = [], []
    for _ in range(int(rng.integers(3, 6))):
        corner, size, label = rng.uniform(0, 600, 2), rng.uniform(40, 160, 2), int(rng.integers(3))
        for _ in range(int(rng.integers(2, 6))):
            moved = corner + rng.normal(0, 0.25, 2) * size
            boxes.append([*moved, *(moved + size * rng.uniform(0.8, 1.25, 2))])
            classes.append(label if rng.random() < 0.8 else (label + 1) % 3)
    best = rng.permutation(np.linspace(0.15, 0.95, len(boxes)))
    return (
        np.array(boxes),
        scored(classes, best),
        float(rng.choice([0.2, 0.3, 0.5])),
        float(rng.choice([0.3, 0.45, 0.6])),
    )


def squares(name: str, shifts: list, classes: list, best: list, threshold: float, limit: float):
    """A special case: squares of 10 pixels, so far to the right."""
    boxes = np.array([0.0, 0, 10, 10]) + np.outer(shifts, [1, 0, 1, 0])
    return case(name, boxes, scored(classes, best), threshold, limit)


def in_several_classes(boxes, scores, threshold, limit):
    """A mistake: a box takes part in every class in which its score reaches the threshold."""
    kept = {i for column in scores.T for i in surest(boxes, column[:, None], threshold, limit)}
    return np.array(sorted(kept, key=lambda i: -scores[i].max()), dtype=int)


# 12.4: the lowest threshold whose precision can be believed


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
all_good = edited(
    lowest_threshold,
    "z = 1.96 => z, good = 1.96, [] and also return t => good.append(t) and also return np.inf => return good",
)


def refused(arguments, answer) -> str | None:
    """What is wrong with a threshold: what it keeps is compared, and Wilson's z may be 1.96 or more exact."""
    scores, right, least = arguments
    try:
        t = float(np.asarray(answer, dtype=float).reshape(()))
    except (TypeError, ValueError):
        return "Give one number, the threshold."
    if np.isnan(t):
        return "NaN says nothing. Where no threshold is good enough, the answer is np.inf: it keeps no box."
    wanted = {int((scores >= lowest(scores, right, least)).sum()) for lowest in (lowest_threshold, with_exact_z)}
    kept = int((scores >= t - 1e-6).sum())
    if kept in wanted:
        return None
    if kept == 0:
        return "Yours keeps no box, but a threshold that can be believed exists. Have you tried them all?"
    if max(wanted) == 0:
        return "No threshold is good enough here: then the answer is np.inf."
    if kept > max(wanted):
        return "Yours is too low: with the boxes that it keeps, the lower end of the interval is below `least`."
    return "Yours is higher than it must be: a lower one still keeps the lower end at `least`, and finds more."


def validation_boxes(rng: np.random.Generator) -> tuple:
    """Scores with two digits, so that some are equal, and boxes that are right about as often as their score says."""
    scores = np.round(rng.uniform(0.05, 0.99, int(rng.integers(60, 200))), 2)
    return scores, rng.random(len(scores)) < scores**0.25, float(rng.choice([0.75, 0.8, 0.85]))


def until_it_fails(scores, right, least):
    """A mistake: down from the top, until the condition, once it held, fails for the first time."""
    levels = np.unique(scores)[::-1]
    good = np.isin(levels, all_good(scores, right, least))
    first = good.argmax()
    return levels[first:][np.append(good[first:], False).argmin() - 1] if good.any() else np.inf


FOUR_SCORES = np.array([0.6, 0.9, 0.7, 0.8])

# fmt: off
EXERCISES = [
    Exercise("12.1", counts_once, boxes_near_the_ends, "warm-up", cases=[
        case("half columns", np.array([[90.0, 0, 110, 9], [91, 0, 110, 9], [92, 0, 110, 9]]), 1280, 100.25),
        case("no boxes", np.zeros((0, 4)), 1280, 160.0),
    ], mistakes="""
        (boxes[:, 0] + boxes[:, 2]) / 2 => boxes[:, 0] + boxes[:, 2] / 2
        Numbers 2 and 3 of a box are u_max and v_max, not its width and height.
        boxes[:, 2]) / 2 => boxes[:, 2]) // 2
        `//` cuts half columns off. A centre may lie between two columns: divide with `/`.
        (boxes[:, 0] + boxes[:, 2]) / 2 => boxes[:, 0]
        (boxes[:, 0] + boxes[:, 2]) / 2 => boxes[:, 2]
        You look at the left edge or the right edge alone. The centre of the box decides.
        (boxes[:, 0] + boxes[:, 2]) / 2 => (boxes[:, 1] + boxes[:, 3]) / 2
        (boxes[:, 0] + boxes[:, 2]) / 2 => (boxes[:, 2] - boxes[:, 0]) / 2
        The centre's column is the mean of u_min and u_max: add numbers 0 and 2 of a box, and halve the sum.
        < start + width => < width
        < start + width => < width - start
        Your range ends at W or before: less than one turn, so that some objects count nowhere. It ends at start + W.
        ... => return counts_once(boxes, width, 0)
        ... => return counts_once(boxes, width, width / 8)
        You take a fixed range, from 0 or, as in the lesson, from W/8. Here it begins at `start`.
        ) & ( => ) | (
        All of yours count: a centre must obey both conditions, not one of them.
        < start + width => <= start + width
        A centre on the right end counts in yours, and so does its copy on the left end: twice in all.
        >= start => > start
        >= start => > start and also < start + width => <= start + width
        A centre right on the left end is lost in yours. The left end belongs to the range, the right end does not.
        centre >= start => boxes[:, 0] >= start and also centre < => boxes[:, 2] <
        You ask for the whole box inside. Then an object on either end of the range never counts.
        & (centre < start + width) =>
        < start + width => < start + 1.25 * width
        Your range does not end within the extended image. It is one turn wide: W, without the quarter added.
    """),
    Exercise("12.2", overlap, two_boxes, cases=[
        case("half a turn apart", box(100, 300, 200, 400), box(740, 300, 840, 400), 1280),
        case("a across the seam", box(1200, 300, 1300, 400), box(0, 300, 20, 400), 1280),
        case("b across the seam", box(0, 300, 20, 400), box(1200, 300, 1300, 400), 1280),
        case("equal boxes", box(1200, 300, 1300, 400), box(1200, 300, 1300, 400), 1280),
        case("side by side", box(100, 300, 200, 400), box(200, 300, 300, 400), 1280),
        case("far apart", box(100, 300, 200, 400), box(900, 450, 950, 500), 1280),
    ], mistakes="""
        (-width, 0, width) => (0,)
        Across the seam yours is 0: one of the boxes may have to be moved by a whole turn first.
        max(0, => max(-np.inf, and also (-width, 0, width) => (0,)
        Two things: boxes apart have negative lengths (cut them off at 0), and the seam needs a turn.
        max(0, min(a[2] => max(-np.inf, min(a[2]
        sum(max(0, => max(max(-np.inf,
        Boxes that are apart side by side share nothing: cut every length across off at 0 before you use it.
        max(0, min(a[3] => max(-np.inf, min(a[3]
        Boxes one above the other share nothing: cut the length down off at 0.
        / (sum(areas) - shared) => / sum(areas)
        The shared area is in both boxes, so you count it twice below. Take it away once.
        / (sum(areas) - shared) => / min(areas)
        / (sum(areas) - shared) => / max(areas)
        / (sum(areas) - shared) => / areas[0]
        / (sum(areas) - shared) => / areas[1]
        You divide by the area of one box (the smaller, the larger, a or b). Below stands the area of the union.
        (-width, 0, width) => [width * (int(a[2] > width) - int(b[2] > width))]
        You move a box only where it passes the seam itself. The other one may end before it: try all turns.
        across = => a[::2] %= width; b[::2] %= width; across = and also (-width, 0, width) => (0,)
        The remainder of u_max turns a box at the seam inside out: its right edge is then left of the other.
        (-width, 0, width) => (0, width)
        (-width, 0, width) => (-width, 0)
        (-width, 0, width) => (-width, width)
        (-width, 0, width) => (-width,)
        b may have to go one turn to the left, one to the right, or stay where it is: try all three.
    """, functions={
        multiplied_first:
            "Boxes apart both ways have two negative lengths, whose product is positive: cut each off at 0 first.",
    }),
    Exercise("12.3", surest, answers_of_a_network, cases=[
        squares("a chain of overlaps", [0, 4, 8], [0, 0, 0], [0.9, 0.8, 0.7], 0.1, 0.4),
        squares("one place and two classes", [0, 0], [0, 1], [0.6, 0.7], 0.1, 0.4),
        squares("an IoU equal to the limit", [0, 5], [1, 1], [0.6, 0.7], 0.1, 1 / 3),
        squares("a score equal to the threshold", [0, 30], [1, 1], [0.5, 0.7], 0.5, 0.4),
        squares("no score that is enough", [0, 30], [1, 1], [0.2, 0.3], 0.5, 0.4),
        squares("boxes apart", [30, 0, 60], [1, 1, 1], [0.5, 0.7, 0.6], 0.1, 0.4),
        case("no boxes", np.zeros((0, 4)), np.zeros((0, 3)), 0.5, 0.4),
        case("two likely classes", np.array([[0.0, 0, 10, 10]] * 2), np.array([[0.9, 0.1], [0.7, 0.6]]), 0.5, 0.4),
    ], mistakes="""
        ... => return surest(boxes, scores[:, :1], threshold, limit)
        You look at the first class alone. A box's score is the greatest of its row.
        & (classes[kept] == classes[i]) =>
        A chair may stand before a sofa: only boxes of the same class put each other out.
        [kept => [best > best[i]
        You compare with every surer box, also with those that went. Only a box that stayed puts others out.
        np.argsort(-best) => range(len(best))
        You go through the rows in their order. The surest box comes first.
        np.array(kept, dtype=int) => np.sort(np.array(kept, dtype=int))
        np.array(kept, dtype=int) => np.array(kept[::-1], dtype=int)
        np.array(kept, dtype=int) => np.array(sorted(kept, key=lambda i: classes[i]), dtype=int)
        The right rows in a wrong order (as given, least score first, or class after class): the surest comes first.
        ... => good = scores.max(axis=1) >= threshold; return surest(boxes[good], scores[good], threshold, limit)
        Your numbers count within those that reach the threshold. Give their rows in the list as given.
        (shared > limit => (shared >= limit
        best[i] >= threshold => best[i] > threshold
        An IoU just equal to the limit is allowed, and a score equal to the threshold is enough.
        (areas[i] + areas[kept] - shared) => np.minimum(areas[i], areas[kept])
        (areas[i] + areas[kept] - shared) => (areas[i] + areas[kept])
        Below the shared area stands the union: not the smaller box, and what both share counts once only.
        (shared > limit * (areas[i] + areas[kept] - shared)) & =>
        You keep one box a class. There may be several chairs: only those that overlap are one.
        and not in_the_way.any() =>
        Nothing is put out in yours, only sorted: of boxes on one thing the surest alone stays.
        best[i] >= threshold and =>
        You use no threshold: rows with less than that never count.
    """, functions={
        in_several_classes: "A box has one class, that of its greatest score. In yours it takes part in several.",
    }),
    Exercise("12.4", lowest_threshold, validation_boxes, "challenge", verify=refused, cases=[
        case("four right boxes", FOUR_SCORES, np.ones(4, bool), 0.5),
        case("too few boxes to be sure", FOUR_SCORES, np.ones(4, bool), 0.6),
        case("all boxes wrong", np.linspace(0.1, 0.9, 50), np.zeros(50, bool), 0.5),
        case("equal scores", np.full(40, 0.5), np.arange(40) < 36, 0.8),
        case("several crossings", np.round(np.linspace(0.99, 0.2, 80), 2), np.arange(80) // 4 != 5, 0.8),
    ], mistakes="""
        if (share + z**2 / (2 * n) - root) / (1 + z**2 / n) => if share
        That is the plain share. Of 4 boxes, 4 right ones prove little: the lower end must reach `least`.
        if (share + z**2 / (2 * n) - root) / (1 + z**2 / n) => if share - z * np.sqrt(share * (1 - share) / n)
        p - z sqrt(p (1-p) / n) has no width where all are right. Wilson has the true share in the root.
        - root => + root
        That is the upper end of the interval. The lower end must reach `least`.
        ... => return max(all_good(scores, right, least), default=np.inf)
        That is the highest good threshold. The lowest one finds most objects.
        ... => return lowest_threshold(scores - 1e-9 * np.argsort(np.argsort(-scores)), right, least)
        ... => return lowest_threshold(scores + 1e-9 * np.argsort(np.argsort(scores)), right, least)
        ... => return lowest_threshold(scores - 1e-9 * np.arange(len(scores)), right, least)
        ... => return lowest_threshold(scores + 1e-9 * np.arange(len(scores)), right, least)
        Boxes with equal scores stay or go together: no threshold cuts between them.
        np.unique(scores) => np.unique(scores)[:-1] and also scores >= t => scores > t
        You keep boxes with more than t. A box with a score of just t is kept, too.
        z = 1.96 => z = 1.645
        z = 1.96 => z = 1.0
        z = 1.645 is for 90 %, z = 1 for about 68 %. The task has z = 1.96.
        share + z**2 / (2 * n) - root => share - root
        Something is missing above Wilson's fraction line: the middle of the interval is not k / n itself.
        kept.sum(), right[kept].mean() => len(scores), right[kept].sum() / len(scores)
        The share is that of the boxes kept, those with a score of at least t, not of all boxes.
    """, functions={
        until_it_fails:
            "You stop when it fails for the first time. Precision goes up and down: lower thresholds may do again.",
    }),
]
