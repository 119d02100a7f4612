"""Exercises of lesson 12: overlap on the circle, the range in which a box counts, and the mean of hues."""

from __future__ import annotations

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 12.1: overlap of two boxes across the seam


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


# 12.2: which boxes count


def counts(boxes: np.ndarray, width: int) -> np.ndarray:
    """Which boxes (n, 4) of the extended image have their centre in [W/8, W/8 + W)."""
    return _in_range((boxes[:, 0] + boxes[:, 2]) / 2, width / 8, width / 8 + width)


def _in_range(values: np.ndarray, start: float, stop: float) -> np.ndarray:
    return (values >= start) & (values < stop)


def _boxes(rng: np.random.Generator) -> tuple:
    """Boxes of the extended image, and always one with its centre on each end of the range."""
    width = int(rng.choice([640, 1280, 1920]))
    n = int(rng.integers(12, 20))
    centres = rng.uniform(0.03, 1.22, size=n)
    centres[:8] = rng.uniform(0.06, 0.19, size=8) + rng.choice([0, 1], size=8)  # close to an end
    centres[:2] = 0.125, 1.125
    half = np.minimum(rng.uniform(0.01, 0.12, size=n), np.minimum(centres, 1.25 - centres))
    half = np.round(half * 64) / 64  # so that the two centres are exact
    rows = np.sort(rng.uniform(0, 0.5, size=(n, 2)), axis=1)
    boxes = np.column_stack([centres - half, rows[:, 0], centres + half, rows[:, 1]]) * width
    return boxes[rng.permutation(n)], width


def _centre(boxes: np.ndarray) -> np.ndarray:
    return (boxes[:, 0] + boxes[:, 2]) / 2


# 12.3: mean hue


def mean_hue(hues: np.ndarray, saturations: np.ndarray) -> float:
    """Mean of hues (n,) in degrees on the circle, weighted by saturation; in [0, 360)."""
    return float(np.degrees(_mean_angle(np.radians(hues), saturations)) % 360)


def _mean_angle(angles: np.ndarray, weights: np.ndarray) -> float:
    return np.arctan2(np.sum(weights * np.sin(angles)), np.sum(weights * np.cos(angles)))


def _pixels(rng: np.random.Generator) -> tuple:
    """Hues around one of several colours, red among them, and saturations that differ."""
    n = int(rng.integers(5, 12))
    middle = rng.choice([0.0, 0.0, 20.0, 120.0, 200.0, 340.0])
    return (middle + rng.normal(0, 25, size=n)) % 360, rng.uniform(0.1, 1.0, size=n)


EXERCISES = [
    Exercise(
        number="12.1",
        reference=overlap,
        inputs=_two_boxes,
        mistakes=(
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
                lambda a, b, w: _iou((_across(a, b) + _across(a, b + np.array([w, 0, w, 0]))) * _down(a, b), a, b),
                "You move the second box to the right only. It may have to go to the left as well.",
            ),
            Mistake(
                lambda a, b, w: _iou((_across(a, b) + _across(a + np.array([w, 0, w, 0]), b)) * _down(a, b), a, b),
                "You move the first box to the right only. The other case, the second one to the right, is missing.",
            ),
            Mistake(
                lambda a, b, w: overlap(a, b, 1280),
                "Your panorama is always 1280 columns wide: use the argument.",
            ),
        ),
    ),
    Exercise(
        number="12.2",
        reference=counts,
        inputs=_boxes,
        mistakes=(
            Mistake(
                lambda boxes, width: _in_range(boxes[:, 0], width / 8, width / 8 + width),
                "You look at the left edge. The centre of the box decides.",
            ),
            Mistake(
                lambda boxes, width: _in_range(boxes[:, 2], width / 8, width / 8 + width),
                "You look at the right edge. The centre of the box decides.",
            ),
            Mistake(
                lambda boxes, width: _in_range((boxes[:, 1] + boxes[:, 3]) / 2, width / 8, width / 8 + width),
                "You look at the rows. The centre's column is the mean of u_min and u_max: numbers 0 and 2 of a box.",
            ),
            Mistake(
                lambda boxes, width: _in_range((boxes[:, 2] - boxes[:, 0]) / 2, width / 8, width / 8 + width),
                "That is half the width of a box. The centre is the mean of its two edges: add them.",
            ),
            Mistake(
                lambda boxes, width: _in_range(_centre(boxes), width / 8, width),
                "Your range ends at W: less than one turn, so that some objects count nowhere. It ends at W/8 + W.",
            ),
            Mistake(
                lambda boxes, width: _in_range(_centre(boxes), width / 8, 7 * width / 8),
                "You leave out an eighth at both ends. The range is one whole turn: to W/8 + W.",
            ),
            Mistake(
                lambda boxes, width: _in_range(_centre(boxes), 0, width),
                "In your range the left end begins at 0: there boxes are cut. Begin an eighth later.",
            ),
            Mistake(
                lambda boxes, width: _in_range(_centre(boxes), width / 4, width / 4 + width),
                "Yours begins at a quarter and ends where the image ends, where boxes are cut. Half of that.",
            ),
            Mistake(
                lambda boxes, width: (_centre(boxes) >= width / 8) & (_centre(boxes) <= width / 8 + width),
                "A centre on the right end counts in yours, and so does its copy on the left end: twice in all.",
            ),
            Mistake(
                lambda boxes, width: (_centre(boxes) > width / 8) & (_centre(boxes) < width / 8 + width),
                "A centre right on the left end is lost in yours: its copy on the right end does not count either.",
            ),
            Mistake(
                lambda boxes, width: (_centre(boxes) > width / 8) & (_centre(boxes) <= width / 8 + width),
                "A good range, too, but the task wants its left end in and its right end out.",
            ),
            Mistake(
                lambda boxes, width: (boxes[:, 0] >= width / 8) & (boxes[:, 2] < width / 8 + width),
                "You ask for the whole box inside. Then an object on either end of the range never counts.",
            ),
            Mistake(
                lambda boxes, width: ~counts(boxes, width),
                "Yours is True for those that do not count.",
            ),
            Mistake(
                lambda boxes, width: counts(boxes, 1280),
                "Your panorama is always 1280 columns wide: use the argument.",
            ),
            Mistake(
                lambda boxes, width: _in_range(_centre(boxes), 1.25 * width / 8, 1.25 * width / 8 + width),
                "W is the width of the panorama itself, without the quarter that was added.",
            ),
        ),
    ),
    Exercise(
        number="12.3",
        reference=mean_hue,
        inputs=_pixels,
        mistakes=(
            Mistake(
                lambda hues, saturations: float(np.mean(hues)),
                "That is the plain mean: reds at 350 and 10 degrees give 180, a cyan. Add up vectors instead.",
            ),
            Mistake(
                lambda hues, saturations: float(np.average(hues, weights=saturations)),
                "Weighted, but still a plain mean: 350 and 10 degrees give 180. Add up vectors instead.",
            ),
            Mistake(
                lambda hues, saturations: mean_hue(hues, np.ones(len(hues))),
                "On the circle, but every pixel counts alike. A pale pixel says less: weigh with the saturation.",
            ),
            Mistake(
                lambda hues, saturations: float(np.degrees(_mean_angle(np.radians(hues), saturations))),
                "Some of yours are negative. Hues lie in [0, 360).",
            ),
            Mistake(
                lambda hues, saturations: float(
                    np.degrees(
                        np.arctan(
                            np.sum(saturations * np.sin(np.radians(hues)))
                            / np.sum(saturations * np.cos(np.radians(hues)))
                        )
                    )
                    % 360
                ),
                "np.arctan cannot tell a colour from its opposite. np.arctan2, with two arguments, can.",
            ),
            Mistake(
                lambda hues, saturations: float(abs(np.degrees(_mean_angle(np.radians(hues), saturations)))),
                "The absolute value turns -10 into 10. A hue of -10 is one of 350: take the remainder by 360.",
            ),
            Mistake(
                lambda hues, saturations: float(np.degrees(_mean_angle(np.radians(hues), saturations)) + 180),
                "You add 180, which gives the opposite colour. The remainder by 360 brings it into [0, 360).",
            ),
            Mistake(
                lambda hues, saturations: float(_mean_angle(np.radians(hues), saturations) % (2 * np.pi)),
                "These are radians; the task asks for degrees.",
            ),
            Mistake(
                lambda hues, saturations: float(np.average((hues + 180) % 360 - 180, weights=saturations) % 360),
                "You moved the seam to 180 degrees, and took a plain mean. Add up vectors: they have no seam.",
            ),
            Mistake(
                lambda hues, saturations: float(_mean_angle(np.radians(hues), saturations)),
                "These are radians, and some are negative. The task asks for degrees in [0, 360).",
            ),
            Mistake(
                lambda hues, saturations: float(np.degrees(_mean_angle(hues, saturations)) % 360),
                "np.sin and np.cos take radians; you give them degrees.",
            ),
            Mistake(
                lambda hues, saturations: float((90 - np.degrees(_mean_angle(np.radians(hues), saturations))) % 360),
                "np.arctan2 takes the sum of the sines first, then that of the cosines.",
            ),
            Mistake(
                lambda hues, saturations: float(np.median(hues)),
                "A median does not know the circle either. Add up vectors.",
            ),
            Mistake(
                lambda hues, saturations: mean_hue(hues, saturations**2),
                "Your weight is the square of the saturation. Count it once.",
            ),
        ),
    ),
]
