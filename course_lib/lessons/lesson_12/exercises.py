"""Exercises of lesson 12: the range in which a box counts, overlap on the circle, suppression, a threshold."""

from collections.abc import Callable

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 12.1: which boxes count


def counts(boxes: np.ndarray, width: int, start: float) -> np.ndarray:
    """Which boxes (n, 4) of the extended image have their centre in [start, start + width)."""
    return _in_range(_centre(boxes), start, start + width)


def _in_range(values: np.ndarray, start: float, stop: float) -> np.ndarray:
    return (values >= start) & (values < stop)


def _centre(boxes: np.ndarray) -> np.ndarray:
    return (boxes[:, 0] + boxes[:, 2]) / 2


def _boxes(rng: np.random.Generator) -> tuple:
    """Boxes of the extended image, and always one with its centre on each end of the range."""
    width, start = int(rng.choice([640, 1280, 1920])), rng.choice([0.0625, 0.125, 0.1875])
    n = int(rng.integers(12, 20))
    centres = rng.uniform(0.03, 1.22, size=n)
    centres[:8] = start + rng.uniform(-0.06, 0.06, size=8) + rng.choice([0, 1], size=8)  # close to an end
    centres[:2] = start, start + 1
    half = np.minimum(rng.uniform(0.01, 0.12, size=n), np.minimum(centres, 1.25 - centres))
    half = np.round(half * 64) / 64  # so that the two centres are exact
    rows = np.sort(rng.uniform(0, 0.5, size=(n, 2)), axis=1)
    boxes = np.column_stack([centres - half, rows[:, 0], centres + half, rows[:, 1]]) * width
    return boxes[rng.permutation(n)], width, float(start * width)


# 12.2: overlap of two boxes across the seam


def overlap(a: np.ndarray, b: np.ndarray, width: int) -> float:
    """IoU of two boxes (u_min, v_min, u_max, v_max) on the circle of columns; u_max may pass the width."""
    return _iou(_shared_on_circle(a, b, width), a, b)


def _area(box: np.ndarray) -> float:
    return (box[2] - box[0]) * (box[3] - box[1])


def _across(a: np.ndarray, b: np.ndarray) -> float:
    return max(0.0, min(a[2], b[2]) - max(a[0], b[0]))


def _down(a: np.ndarray, b: np.ndarray) -> float:
    return max(0.0, min(a[3], b[3]) - max(a[1], b[1]))


def _shared_on_circle(a: np.ndarray, b: np.ndarray, width: int) -> float:
    across = sum(_across(a, b + np.array([turn, 0, turn, 0])) for turn in (-width, 0, width))
    return across * _down(a, b)


def _iou(shared: float, a: np.ndarray, b: np.ndarray) -> float:
    return float(shared / (_area(a) + _area(b) - shared))


def _two_boxes(rng: np.random.Generator) -> tuple:
    """Two boxes up to a quarter wide: overlapping, apart, one with its columns one turn on, one across the seam."""
    width = int(rng.choice([640, 1280, 1920]))
    case = rng.integers(5)
    a = np.array([rng.uniform(0.3, 0.6), 0.4, 0.0, 0.55])
    a[2] = a[0] + rng.uniform(0.1, 0.2)
    if case != 0:
        a[[0, 2]] += 0.9 - a[0]  # across the seam
    shift = np.array([rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05)] * 2)
    b = a + shift + np.array([0, 0, rng.uniform(-0.04, 0.05), 0])
    if case in (2, 3):
        b[[0, 2]] += 1.05 - b[0]  # its left edge lies beyond the seam: on the image that is at the left
        b[[0, 2]] -= 1.0
    if case == 1:
        b[[1, 3]] += 0.3  # below the other one
        if rng.random() < 0.5:
            b[[0, 2]] -= 0.35  # and beside it: two negative lengths, whose product is positive
    if case == 4:
        a[2], b[2] = rng.uniform(0.95, 0.99), rng.uniform(1.01, 1.08)  # only one of them passes the seam
    if rng.random() < 0.5:
        a, b = b, a
    return a * width, b * width, width  # both were shares of the width


def _moved_if_across(a: np.ndarray, b: np.ndarray, width: int) -> float:
    a, b = (box - np.array([1, 0, 1, 0]) * width * (box[2] > width) for box in (a, b))
    return _iou(_across(a, b) * _down(a, b), a, b)


def _uncut(a: np.ndarray, b: np.ndarray, width: int, across: bool) -> float:
    """Negative lengths are not cut off at 0: across, or else down."""
    turns = [b[[0, 2]] + turn for turn in (-width, 0, width)]
    length = max(min(a[2], right) - max(a[0], left) for left, right in turns)
    if across:
        return _iou(length * _down(a, b), a, b)
    return _iou(max(0.0, length) * (min(a[3], b[3]) - max(a[1], b[1])), a, b)


def _edges_on_image(box: np.ndarray, width: int) -> np.ndarray:
    return np.array([box[0] % width, box[1], box[2] % width, box[3]])


def _two_places(first: float, second: float) -> Callable:
    """A mistake: b in two places only, so many widths from its own."""

    def mistaken(a: np.ndarray, b: np.ndarray, width: int) -> float:
        turns = (np.array([turn * width, 0, turn * width, 0]) for turn in (first, second))
        return _iou(sum(_across(a, b + turn) for turn in turns) * _down(a, b), a, b)

    return mistaken


def _product_uncut(a: np.ndarray, b: np.ndarray, width: int) -> float:
    """The greatest product of both lengths over all turns: two negative ones make a positive one."""
    down = min(a[3], b[3]) - max(a[1], b[1])
    across = [min(a[2], b[2] + turn) - max(a[0], b[0] + turn) for turn in (-width, 0, width)]
    return _iou(max(0.0, *(length * down for length in across)), a, b)


def _product_cut(a: np.ndarray, b: np.ndarray, width: int) -> float:
    """The product of two lengths that may both be negative, cut off at 0; the best of three turns."""
    best = 0.0
    for turn in (-width, 0, width):
        moved = b + np.array([turn, 0, turn, 0])
        shared = (min(a[2], moved[2]) - max(a[0], moved[0])) * (min(a[3], b[3]) - max(a[1], b[1]))
        best = max(best, _iou(shared, a, b))
    return best


def _lengths_added_uncut(a: np.ndarray, b: np.ndarray, width: int) -> float:
    """All three lengths are added, the negative ones too."""
    across = sum(min(a[2], b[2] + turn) - max(a[0], b[0] + turn) for turn in (-width, 0, width))
    return _iou(across * _down(a, b), a, b)


# 12.3: threshold and suppression


def surest(boxes: np.ndarray, scores: np.ndarray, threshold: float, limit: float) -> np.ndarray:
    """Rows (k,) that stay, the greatest score first: scores (n, c) of each class, boxes (n, 4), IoU at most `limit`."""
    return _suppressed(boxes, scores, threshold, limit)


def _suppressed(
    boxes: np.ndarray,
    scores: np.ndarray,
    threshold: float,
    limit: float,
    enough: Callable = np.greater_equal,
    rival: Callable = np.greater,
    overlap_of: Callable = lambda a, b: _iou(_across(a, b) * _down(a, b), a, b),
    by_class: bool = True,
    kept_only: bool = True,
    sort: bool = True,
) -> np.ndarray:
    """`surest` with the slips that a mistake makes."""
    best, classes = scores.max(axis=1), scores.argmax(axis=1)
    rows = np.flatnonzero(enough(best, threshold))
    rows = rows[np.argsort(-best[rows])] if sort else rows
    kept: list[int] = []
    for place, i in enumerate(rows):
        rivals = [k for k in (kept if kept_only else rows[:place]) if not by_class or classes[k] == classes[i]]
        if not any(rival(overlap_of(boxes[i], boxes[k]), limit) for k in rivals):
            kept.append(int(i))
    return np.array(kept, dtype=int)


def _slip(**changed) -> Callable:
    return lambda boxes, scores, threshold, limit: _suppressed(boxes, scores, threshold, limit, **changed)


def _shared_of_the_smaller(a: np.ndarray, b: np.ndarray) -> float:
    return _across(a, b) * _down(a, b) / min(_area(a), _area(b))


def _one_of_each_class(boxes: np.ndarray, scores: np.ndarray, threshold: float, limit: float) -> np.ndarray:
    best, classes = scores.max(axis=1), scores.argmax(axis=1)
    rows = [i for i in np.argsort(-best) if best[i] >= threshold]
    return np.array([i for k, i in enumerate(rows) if classes[i] not in classes[rows[:k]]], dtype=int)


def _class_after_class(boxes: np.ndarray, scores: np.ndarray, threshold: float, limit: float) -> np.ndarray:
    kept, classes = surest(boxes, scores, threshold, limit), scores.argmax(axis=1)
    return kept[np.argsort(classes[kept], kind="stable")]


def _in_several_classes(boxes: np.ndarray, scores: np.ndarray, threshold: float, limit: float) -> np.ndarray:
    """A box takes part in every class in which its score reaches the threshold."""
    kept: set[int] = set()
    for column in scores.T:
        kept.update(_suppressed(boxes, column[:, None], threshold, limit).tolist())
    return np.array(sorted(kept, key=lambda i: -scores[i].max()), dtype=int)


def _of_the_short_list(boxes: np.ndarray, scores: np.ndarray, threshold: float, limit: float) -> np.ndarray:
    """Numbers in the list of those that reach the threshold, not in the list that was given."""
    reach = scores.max(axis=1) >= threshold
    return (np.cumsum(reach) - 1)[surest(boxes, scores, threshold, limit)]


def _scored(classes: np.ndarray, best: np.ndarray, n_classes: int = 3) -> np.ndarray:
    """Scores (n, c): `best` for each row's class, and less for the others."""
    scores = np.outer(best, np.linspace(0.2, 0.4, n_classes))
    scores[np.arange(len(best)), classes] = best
    return scores


def _answers_of_a_network(rng: np.random.Generator) -> tuple:
    """Several boxes on each of a few things, of two classes now and then, in any order; scores all differ."""
    boxes, classes = [], []
    for _ in range(int(rng.integers(3, 6))):
        corner, size, label = rng.uniform(0, 600, 2), rng.uniform(40, 160, 2), int(rng.integers(3))
        for _ in range(int(rng.integers(2, 6))):
            moved = corner + rng.normal(0, 0.25, 2) * size
            boxes.append([*moved, *(moved + size * rng.uniform(0.8, 1.25, 2))])
            classes.append(label if rng.random() < 0.8 else (label + 1) % 3)
    best = rng.permutation(np.linspace(0.15, 0.95, len(boxes)))
    threshold, limit = float(rng.choice([0.2, 0.3, 0.5])), float(rng.choice([0.3, 0.45, 0.6]))
    return np.array(boxes), _scored(np.array(classes), best), threshold, limit


_SQUARE = np.array([0.0, 0.0, 10.0, 10.0])


def _squares(shifts: list[float], classes: list[int], best: list[float], threshold: float, limit: float) -> tuple:
    boxes = _SQUARE + np.outer(shifts, [1.0, 0, 1, 0])
    return boxes, _scored(np.array(classes), np.array(best)), threshold, limit


# 12.4: the lowest threshold whose precision can be believed


def lowest_threshold(scores: np.ndarray, right: np.ndarray, least: float) -> float:
    """Lowest score t at which Wilson's lower end of the share of right boxes, of those with at least t, is >= least."""
    return _lowest(scores, right, least, _wilson_low)


def _wilson_low(hits: int, n: int, z: float = 1.96) -> float:
    """The least share p that `hits` of `n` do not contradict: hits / n = p + z sqrt(p (1 - p) / n)."""
    share, spread = hits / n, z * z / n
    return (share + spread / 2 - np.sqrt(spread * share * (1 - share) + spread**2 / 4)) / (1 + spread)


def _lowest(scores: np.ndarray, right: np.ndarray, least: float, low: Callable, enough=np.greater_equal) -> float:
    for t in np.unique(scores):
        kept = enough(scores, t)
        if kept.any() and low(int(right[kept].sum()), int(kept.sum())) >= least:
            return float(t)
    return np.inf


def _refused(arguments: tuple, answer: object) -> str | None:
    """What is wrong with a threshold: what it keeps is compared, and Wilson's z may be 1.96 or more exact."""
    scores, right, least = arguments
    try:
        t = float(np.asarray(answer, dtype=float).reshape(()))
    except (TypeError, ValueError):
        return "Give one number, the threshold."
    wanted = {int((scores >= _lowest(scores, right, least, low)).sum()) for low in (_wilson_low, _wilson_exact)}
    kept = int((scores >= t - 1e-6).sum())
    if kept in wanted or (np.isnan(t) and wanted == {0}):
        return None
    if kept == 0:
        return "Yours keeps no box, but a threshold that can be believed exists. Have you tried them all?"
    if max(wanted) == 0:
        return "No threshold is good enough here: then the answer is np.inf."
    if kept > max(wanted):
        return "Yours is too low: with the boxes that it keeps, the lower end of the interval is below `least`."
    return "Yours is higher than it must be: a lower one still keeps the lower end at `least`, and finds more."


def _wilson_exact(hits: int, n: int) -> float:
    return _wilson_low(hits, n, 1.959963984540054)


def _plain_share(hits: int, n: int) -> float:
    return hits / n


def _wald_low(hits: int, n: int) -> float:
    return hits / n - 1.96 * np.sqrt(hits / n * (1 - hits / n) / n)


def _wilson_high(hits: int, n: int) -> float:
    return 1 - _wilson_low(n - hits, n)


def _validation_boxes(rng: np.random.Generator) -> tuple:
    """Scores with two digits, so that some are equal, and boxes that are right about as often as their score says."""
    n = int(rng.integers(60, 200))
    scores = np.round(rng.uniform(0.05, 0.99, n), 2)
    return scores, rng.random(n) < scores**0.25, float(rng.choice([0.75, 0.8, 0.85]))


def _until_it_fails(scores: np.ndarray, right: np.ndarray, least: float) -> float:
    """Down from the top, until the condition, once it held, fails for the first time."""
    found = np.inf
    for t in np.unique(scores)[::-1]:
        kept = scores >= t
        if _wilson_low(int(right[kept].sum()), int(kept.sum())) >= least:
            found = float(t)
        elif np.isfinite(found):
            break
    return found


def _highest(scores: np.ndarray, right: np.ndarray, least: float) -> float:
    good = [
        t for t in np.unique(scores) if _wilson_low(int(right[scores >= t].sum()), int((scores >= t).sum())) >= least
    ]
    return float(max(good, default=np.inf))


def _row_by_row(order_of: Callable) -> Callable:
    """A mistake: box after box in the order `order_of(scores)`; among equal scores it may stop in the middle."""

    def mistaken(scores: np.ndarray, right: np.ndarray, least: float) -> float:
        order = order_of(scores)
        hits, n = np.cumsum(right[order]), np.arange(1, len(scores) + 1)
        good = np.flatnonzero([_wilson_low(int(h), int(k)) >= least for h, k in zip(hits, n, strict=True)])
        return float(scores[order[good[-1]]]) if len(good) else np.inf

    return mistaken


def _without_the_middle(hits: int, n: int) -> float:
    """Wilson's formula without z squared / 2n above the fraction line."""
    return _wilson_low(hits, n) - 1.96**2 / (2 * n) / (1 + 1.96**2 / n)


def _share_of_all(scores: np.ndarray, right: np.ndarray, least: float) -> float:
    """Divides by all boxes, not by those that are kept."""
    return _lowest(scores, right, least, lambda hits, n: _wilson_low(hits, len(scores)))


def _best_f1(scores: np.ndarray, right: np.ndarray, least: float) -> float:
    def f1(t: float) -> float:
        kept = scores >= t
        return 2 * right[kept].sum() / (kept.sum() + right.sum())

    return float(max(np.unique(scores), key=f1))


EXERCISES = [
    Exercise(
        number="12.1",
        level="warm-up",
        solution=counts,
        inputs=_boxes,
        cases=(
            lambda rng: (np.array([[90.0, 0, 110, 9], [91, 0, 110, 9], [92, 0, 110, 9]]), 1280, 100.25),  # halves
            lambda rng: (np.array([[140.0, 0, 160, 9], [150, 0, 170, 9], [1430, 0, 1450, 9]]), 1280, 160.0),
            lambda rng: (np.zeros((0, 4)), 1280, 160.0),  # nothing was found
        ),
        mistakes=(
            Mistake(
                lambda boxes, width, start: _in_range(boxes[:, 0] + boxes[:, 2] / 2, start, start + width),
                "Numbers 2 and 3 of a box are u_max and v_max, not its width and height.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range((boxes[:, 0] + boxes[:, 2]) // 2, start, start + width),
                "`//` cuts half columns off. A centre may lie between two columns: divide with `/`.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range(boxes[:, 0], start, start + width),
                "You look at the left edge. The centre of the box decides.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range(boxes[:, 2], start, start + width),
                "You look at the right edge. The centre of the box decides.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range((boxes[:, 1] + boxes[:, 3]) / 2, start, start + width),
                "You look at the rows. The centre's column is the mean of u_min and u_max: numbers 0 and 2 of a box.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range((boxes[:, 2] - boxes[:, 0]) / 2, start, start + width),
                "That is half the width of a box. The centre is the mean of its two edges: add them.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range(_centre(boxes), start, width),
                "Your range ends at W: less than one turn, so that some objects count nowhere. It ends at start + W.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range(_centre(boxes), start, width - start),
                "You leave out a piece at both ends. The range is one whole turn: to start + W.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range(_centre(boxes), 0, width),
                "In your range the left end begins at 0: use `start`.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range(_centre(boxes), width / 8, width / 8 + width),
                "That is the lesson's range, which begins at W/8. Here it begins at `start`.",
            ),
            Mistake(
                lambda boxes, width, start: (_centre(boxes) >= start) | (_centre(boxes) < start + width),
                "All of yours count: a centre must obey both conditions, not one of them.",
            ),
            Mistake(
                lambda boxes, width, start: (_centre(boxes) >= start) & (_centre(boxes) <= start + width),
                "A centre on the right end counts in yours, and so does its copy on the left end: twice in all.",
            ),
            Mistake(
                lambda boxes, width, start: (_centre(boxes) > start) & (_centre(boxes) < start + width),
                "A centre right on the left end is lost in yours: its copy on the right end does not count either.",
            ),
            Mistake(
                lambda boxes, width, start: (_centre(boxes) > start) & (_centre(boxes) <= start + width),
                "A good range, too, but the task wants its left end in and its right end out.",
            ),
            Mistake(
                lambda boxes, width, start: (boxes[:, 0] >= start) & (boxes[:, 2] < start + width),
                "You ask for the whole box inside. Then an object on either end of the range never counts.",
            ),
            Mistake(
                lambda boxes, width, start: ~counts(boxes, width, start),
                "Yours is True for those that do not count.",
            ),
            Mistake(
                lambda boxes, width, start: counts(boxes, 1280, start),
                "Your panorama is always 1280 columns wide: use the argument.",
            ),
            Mistake(
                lambda boxes, width, start: _in_range(_centre(boxes), start, start + 1.25 * width),
                "Your range does not end within the extended image. It is one turn wide: W, without the quarter added.",
            ),
        ),
    ),
    Exercise(
        number="12.2",
        solution=overlap,
        inputs=_two_boxes,
        cases=(
            lambda rng: (np.array([100.0, 300, 200, 400]), np.array([740.0, 300, 840, 400]), 1280),  # half a turn apart
            lambda rng: (np.array([1200.0, 300, 1300, 400]), np.array([0.0, 300, 20, 400]), 1280),
            lambda rng: (np.array([0.0, 300, 20, 400]), np.array([1200.0, 300, 1300, 400]), 1280),
            lambda rng: (np.array([1200.0, 300, 1300, 400]), np.array([1200.0, 300, 1300, 400]), 1280),  # equal
            lambda rng: (np.array([100.0, 300, 200, 400]), np.array([200.0, 300, 300, 400]), 1280),  # side by side
            lambda rng: (np.array([100.0, 300, 200, 400]), np.array([900.0, 450, 950, 500]), 1280),  # far apart
        ),
        mistakes=(
            Mistake(
                _product_cut,
                "Boxes apart both ways have two negative lengths, whose product is positive: cut each off at 0 first.",
                others=(_product_uncut,),
            ),
            Mistake(
                lambda a, b, w: 100 * overlap(a, b, w),
                "That is in percent. The IoU is a share: 1 for the same box.",
            ),
            Mistake(
                lambda a, b, w: _iou(_across(a, b) * _down(a, b), a, b),
                "Across the seam yours is 0: one of the boxes may have to be moved by a whole turn first.",
            ),
            Mistake(
                lambda a, b, w: _iou((min(a[2], b[2]) - max(a[0], b[0])) * (min(a[3], b[3]) - max(a[1], b[1])), a, b),
                "Two things: boxes apart have negative lengths (cut them off at 0), and the seam needs a turn.",
            ),
            Mistake(
                lambda a, b, w: float(_shared_on_circle(a, b, w) / (_area(a) + _area(b))),
                "The shared area is in both boxes, so you count it twice below. Take it away once.",
            ),
            Mistake(
                lambda a, b, w: float(_shared_on_circle(a, b, w) / min(_area(a), _area(b))),
                "You divide by the smaller box. Below stands the area of the union.",
            ),
            Mistake(
                lambda a, b, w: float(_shared_on_circle(a, b, w) / _area(a)),
                "You divide by the first box alone. Below stands the area of the union.",
            ),
            Mistake(
                lambda a, b, w: float(_shared_on_circle(a, b, w) / _area(b)),
                "You divide by the second box alone. Below stands the area of the union.",
            ),
            Mistake(
                lambda a, b, w: float(_shared_on_circle(a, b, w) / max(_area(a), _area(b))),
                "You divide by the larger box. Below stands the area of the union.",
            ),
            Mistake(
                _moved_if_across,
                "You move a box only where it passes the seam itself. The other one may end before it: try all turns.",
            ),
            Mistake(
                lambda a, b, w: _uncut(a, b, w, across=True),
                "Boxes that are apart side by side share nothing: cut the length across off at 0.",
            ),
            Mistake(
                lambda a, b, w: _uncut(a, b, w, across=False),
                "Boxes one above the other share nothing: cut the length down off at 0.",
            ),
            Mistake(
                lambda a, b, w: _iou(
                    _across(_edges_on_image(a, w), _edges_on_image(b, w)) * _down(a, b),
                    *(_edges_on_image(box, w) for box in (a, b)),
                ),
                "The remainder of u_max turns a box at the seam inside out: its right edge is then left of the other.",
            ),
            Mistake(
                lambda a, b, w: float(_shared_on_circle(a, b, w)),
                "That is the shared area in square pixels. Divide by the area of the union.",
            ),
            Mistake(
                _two_places(0, 1),
                "You try the second box where it is and one turn to the right. It may have to go to the left as well.",
            ),
            Mistake(
                _two_places(0, -1),
                "You try the second box where it is and one turn to the left. It may have to go to the right as well.",
            ),
            Mistake(
                _two_places(-1, 1),
                "You try the second box one turn to the left and to the right, but no longer where it is.",
            ),
            Mistake(
                _two_places(-1, np.inf),
                "You always move the second box one turn to the left. Mostly it is right where it is: try all three.",
            ),
            Mistake(
                _lengths_added_uncut,
                "You add up negative lengths as well: where the boxes do not meet, the length is 0.",
            ),
            Mistake(
                lambda a, b, w: overlap(a, b, 1280),
                "Your panorama is always 1280 columns wide: use the argument.",
            ),
        ),
    ),
    Exercise(
        number="12.3",
        solution=surest,
        inputs=_answers_of_a_network,
        cases=(
            lambda rng: _squares([0, 4, 8], [0, 0, 0], [0.9, 0.8, 0.7], 0.1, 0.4),  # a chain: the last one stays
            lambda rng: _squares([0, 0], [0, 1], [0.6, 0.7], 0.1, 0.4),  # one place, two classes
            lambda rng: _squares([0, 5], [1, 1], [0.6, 0.7], 0.1, 1 / 3),  # IoU equal to the limit
            lambda rng: _squares([0, 30], [1, 1], [0.5, 0.7], 0.5, 0.4),  # a score equal to the threshold
            lambda rng: _squares([0, 30], [1, 1], [0.2, 0.3], 0.5, 0.4),  # nothing is good enough
            lambda rng: _squares([30, 0, 60], [1, 1, 1], [0.5, 0.7, 0.6], 0.1, 0.4),
            lambda rng: (np.zeros((0, 4)), np.zeros((0, 3)), 0.5, 0.4),  # no answer at all
            lambda rng: (
                _SQUARE + np.zeros((2, 1)),
                np.array([[0.9, 0.1], [0.7, 0.6]]),
                0.5,
                0.4,
            ),  # two likely classes
        ),
        mistakes=(
            Mistake(
                _in_several_classes,
                "A box has one class, that of its greatest score. In yours it takes part in several.",
            ),
            Mistake(
                lambda boxes, scores, threshold, limit: _suppressed(boxes, scores[:, :1], threshold, limit),
                "You look at the first class alone. A box's score is the greatest of its row.",
            ),
            Mistake(
                _slip(by_class=False),
                "A chair may stand before a sofa: only boxes of the same class put each other out.",
            ),
            Mistake(
                _slip(kept_only=False),
                "You compare with every surer box, also with those that went. Only a box that stayed puts others out.",
            ),
            Mistake(_slip(sort=False), "You go through the rows in their order. The surest box comes first."),
            Mistake(
                lambda *given: np.sort(surest(*given)),
                "The right rows, but in the order of the list. The greatest score comes first.",
            ),
            Mistake(
                _of_the_short_list,
                "Your numbers count within those that reach the threshold. Give their rows in the list as given.",
            ),
            Mistake(
                _class_after_class,
                "The right rows, but class after class. The greatest score of all comes first.",
            ),
            Mistake(
                lambda *given: surest(*given)[::-1],
                "The right rows, but the least score first. np.argsort goes upwards.",
            ),
            Mistake(
                _slip(rival=np.greater_equal),
                "An IoU just equal to the limit is allowed: a box goes when it overlaps more than that.",
            ),
            Mistake(_slip(enough=np.greater), "A score equal to the threshold is enough: at least, not more than."),
            Mistake(
                _slip(overlap_of=_shared_of_the_smaller),
                "You divide by the smaller box. The intersection over union has the union below.",
            ),
            Mistake(
                _slip(overlap_of=lambda a, b: _across(a, b) * _down(a, b) / (_area(a) + _area(b))),
                "Below the shared area stands the union: the sum of both areas counts what they share twice.",
            ),
            Mistake(
                _one_of_each_class,
                "You keep one box a class. There may be several chairs: only those that overlap are one.",
            ),
            Mistake(
                lambda boxes, scores, threshold, limit: _suppressed(boxes, scores, threshold, np.inf),
                "Nothing is put out in yours, only sorted: of boxes on one thing the surest alone stays.",
            ),
            Mistake(
                lambda boxes, scores, threshold, limit: _suppressed(boxes, scores, 0.0, limit),
                "You use no threshold: rows with less than that never count.",
            ),
            Mistake(
                lambda boxes, scores, threshold, limit: np.isin(
                    np.arange(len(boxes)), _suppressed(boxes, scores, threshold, limit)
                ),
                "Yours is True or False for each row. Give the numbers of the rows that stay.",
            ),
            Mistake(
                lambda boxes, scores, threshold, limit: boxes[_suppressed(boxes, scores, threshold, limit)],
                "These are the boxes themselves. Give the numbers of their rows.",
            ),
        ),
    ),
    Exercise(
        number="12.4",
        level="challenge",
        solution=lowest_threshold,
        inputs=_validation_boxes,
        verify=_refused,
        cases=(
            lambda rng: (np.array([0.6, 0.9, 0.7, 0.8]), np.ones(4, bool), 0.5),
            lambda rng: (np.array([0.6, 0.9, 0.7, 0.8]), np.ones(4, bool), 0.6),  # four are too few to be sure
            lambda rng: (np.linspace(0.1, 0.9, 50), np.zeros(50, bool), 0.5),  # all of them wrong
            lambda rng: (np.full(40, 0.5), np.arange(40) < 36, 0.8),  # equal scores: all go or all stay
            lambda rng: (
                np.round(np.linspace(0.99, 0.2, 80), 2),
                np.r_[np.ones(20, bool), np.zeros(4, bool), np.ones(56, bool)],
                0.8,
            ),
        ),
        mistakes=(
            Mistake(
                lambda scores, right, least: _lowest(scores, right, least, _plain_share),
                "That is the plain share. Of 4 boxes, 4 right ones prove little: the lower end must reach `least`.",
            ),
            Mistake(
                lambda scores, right, least: _lowest(scores, right, least, _wald_low),
                "p - z sqrt(p (1-p) / n) has no width where all are right. Wilson has the true share in the root.",
            ),
            Mistake(
                lambda scores, right, least: _lowest(scores, right, least, _wilson_high),
                "That is the upper end of the interval. The lower end must reach `least`.",
            ),
            Mistake(
                _until_it_fails,
                "You stop when it fails for the first time. Precision goes up and down: lower thresholds may do again.",
            ),
            Mistake(_highest, "That is the highest good threshold. The lowest one finds most objects."),
            Mistake(
                _row_by_row(lambda scores: np.argsort(-scores, kind="stable")),
                "Boxes with equal scores stay or go together: no threshold cuts between them.",
                others=(
                    _row_by_row(lambda scores: np.argsort(-scores)),
                    _row_by_row(lambda scores: np.argsort(scores)[::-1]),
                    _row_by_row(lambda scores: np.argsort(scores, kind="stable")[::-1]),
                ),
            ),
            Mistake(
                lambda scores, right, least: _lowest(scores, right, least, _wilson_low, enough=np.greater),
                "You keep boxes with more than t. A box with a score of just t is kept, too.",
            ),
            Mistake(
                lambda scores, right, least: _lowest(scores, right, least, lambda hits, n: _wilson_low(hits, n, 1.645)),
                "z = 1.645 is for 90 %. The task has z = 1.96.",
            ),
            Mistake(
                lambda scores, right, least: _lowest(scores, right, least, lambda hits, n: _wilson_low(hits, n, 1.0)),
                "z = 1 is one standard deviation, about 68 %. The task has z = 1.96.",
            ),
            Mistake(
                lambda scores, right, least: _lowest(scores, right, least, _without_the_middle),
                "Something is missing above Wilson's fraction line: the middle of the interval is not k / n itself.",
            ),
            Mistake(
                _share_of_all,
                "The share is that of the boxes kept, those with a score of at least t, not of all boxes.",
            ),
            Mistake(
                _best_f1, "That is the threshold with the best F1. Asked: the lowest with a precision to believe in."
            ),
        ),
    ),
]
