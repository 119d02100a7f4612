"""Exercises of lesson 14: a place from two boxes, the error of a range, and a range from many matches."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from course_lib.lessons.kit.exercises import Exercise, Mistake

# 14.1: X from two boxes


def place_of(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    """X = d x_hat `(3,)` metres, of the centres of two boxes on panoramas width x width / 2 pixels."""
    (a, e_u), (_, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
    return _distance(e_u, e_l, baseline) * _direction(a, e_u)


def _centre(box: np.ndarray) -> np.ndarray:
    return (box[:2] + box[2:]) / 2


def _angles(centre: np.ndarray, width: int) -> tuple[float, float]:
    """Azimuth and elevation of edge coordinates."""
    return (0.5 - centre[0] / width) * 2 * np.pi, (0.5 - centre[1] / (width / 2)) * np.pi


def _distance(e_u: float, e_l: float, baseline: float) -> float:
    return baseline * np.cos(e_l) / np.sin(e_l - e_u)


def _direction(a: float, e: float) -> np.ndarray:
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])


def _two_boxes(rng: np.random.Generator) -> tuple:
    width = int(rng.choice([640, 1280]))
    baseline, rho, z = rng.uniform(0.2, 0.6), rng.uniform(1.0, 4.0), rng.uniform(-1.4, -0.3)
    u = rng.uniform(0.1, 0.95) * width
    boxes = []
    for height in (z, z + baseline):
        v = (0.5 - np.arctan2(height, rho) / np.pi) * width / 2
        half_width, half_height = rng.uniform(0.01, 0.05, 2) * width
        boxes.append(np.array([u - half_width, v - half_height, u + half_width, v + half_height]))
    return boxes[0], boxes[1], width, baseline


def _place_with_the_range(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    (a, e_u), (_, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
    return baseline / (np.tan(e_l) - np.tan(e_u)) * _direction(a, e_u)


def _place_from_below(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    (_, e_u), (a, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
    return _distance(e_u, e_l, baseline) * _direction(a, e_l)


def _place_with_the_other_cosine(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float):
    (a, e_u), (_, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
    return baseline * np.cos(e_u) / np.sin(e_l - e_u) * _direction(a, e_u)


def _place_mirrored(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    return place_of(box_upper, box_lower, width, baseline) * [1, -1, 1]


def _place_of_corners(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    boxes = [np.array([*box[:2], *box[:2]]) for box in (box_upper, box_lower)]
    return place_of(*boxes, width, baseline)


def _distance_for_place(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> float:
    return float(np.linalg.norm(place_of(box_upper, box_lower, width, baseline)))


def _place_with(distance: Callable, turn_up: float = 1.0) -> Callable:
    """A mistake: `distance(e_u, e_l, baseline)` along the upper direction; elevations times `turn_up`."""

    def mistaken(box_upper, box_lower, width, baseline):
        (a, e_u), (_, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
        e_u, e_l = turn_up * e_u, turn_up * e_l
        return distance(e_u, e_l, baseline) * _direction(a, e_u)

    return mistaken


def _place_on_a_square_image(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    a, _ = _angles(_centre(box_upper), width)
    e_u, e_l = ((0.5 - _centre(box)[1] / width) * np.pi for box in (box_upper, box_lower))
    return _distance(e_u, e_l, baseline) * _direction(a, e_u)


# 14.2: the standard deviation of a range


def range_sigma(horizontal_range: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float):
    """rho^2 / B sigma sqrt(sec^4 e_u + sec^4 e_l), metres `(n,)`; sigma: of either elevation, radians."""
    return horizontal_range**2 / baseline * sigma * np.sqrt(np.cos(e_u) ** -4 + np.cos(e_l) ** -4)


def _triangles(rng: np.random.Generator) -> tuple:
    baseline, rho, z = rng.uniform(0.1, 0.6), rng.uniform(1.2, 6.0, 5), rng.uniform(-1.4, 0.3, 5)
    return rho, np.arctan2(z, rho), np.arctan2(z + baseline, rho), baseline, rng.uniform(0.001, 0.01)


def _sigma_added(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    return rho**2 / baseline * sigma * (np.cos(e_u) ** -2 + np.cos(e_l) ** -2)


def _sigma_level(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    return rho**2 / baseline * sigma * np.sqrt(2)


def _sigma_linear(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    return range_sigma(rho, e_u, e_l, baseline, sigma) / rho


def _sigma_one_camera(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    return rho**2 / baseline * sigma / np.cos(e_u) ** 2


def _variance(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    return range_sigma(rho, e_u, e_l, baseline, sigma) ** 2


def _sigma_subtracted(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    return rho**2 / baseline * sigma * np.abs(np.cos(e_u) ** -2 - np.cos(e_l) ** -2)


# 14.3: one range from many matches


def range_of(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    """baseline / median(tan e_l - tan e_u), metres, of matched features `(n,)`."""
    return float(baseline / np.median(np.tan(e_l) - np.tan(e_u)))


def _matches(rng: np.random.Generator) -> tuple:
    """An even number of matches; one in four is of something else, and that one may even diverge."""
    n = 2 * int(rng.integers(3, 7))
    baseline, rho = rng.uniform(0.2, 0.5), rng.uniform(1.5, 4.0)
    z = rng.uniform(-1.3, -0.2, n)
    e_u, e_l = np.arctan2(z, rho), np.arctan2(z + baseline, rho) + 0.004 * rng.standard_normal(n)
    strangers = rng.permutation(n)[: max(1, n // 4)]
    e_l[strangers] = e_u[strangers] + rng.uniform(-0.3, 0.03, len(strangers))
    return e_u, e_l, baseline


def _mean_slope(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / np.mean(np.tan(e_l) - np.tan(e_u)))


def _median_range(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(np.median(baseline / (np.tan(e_l) - np.tan(e_u))))


def _mean_range(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(np.mean(baseline / (np.tan(e_l) - np.tan(e_u))))


def _angles_not_tangents(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / np.median(e_l - e_u))


def _other_order(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return -range_of(e_u, e_l, baseline)


def _medians_apart(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / (np.tan(np.median(e_l)) - np.tan(np.median(e_u))))


EXERCISES = [
    Exercise(
        "14.1",
        place_of,
        _two_boxes,
        (
            Mistake(_place_with_the_range, "You go the horizontal range along a slanted direction: multiply by d."),
            Mistake(_place_from_below, "d is measured from the upper camera, so it goes with the upper direction."),
            Mistake(_place_with_the_other_cosine, "That is the distance from the lower camera: look at the cosine."),
            Mistake(
                _place_mirrored, "Left and right are swapped: azimuth decreases to the right, a = (1/2 - u/W) 2 pi."
            ),
            Mistake(
                _place_of_corners, "You took the boxes' corners (u_min, v_min); the centre is the mean of both corners."
            ),
            Mistake(_distance_for_place, "That is d alone. The place is d times the unit vector: three numbers."),
            Mistake(
                _place_with(lambda e_u, e_l, baseline: baseline * np.cos(e_l) / np.sin(e_u - e_l)),
                "Your point lies behind the camera: the angle at the point is e_l - e_u, lower minus upper.",
            ),
            Mistake(
                _place_with(_distance, turn_up=-1.0),
                "Your elevations are upside down: row 0 is straight up, e = (1/2 - v/H) pi.",
            ),
            Mistake(
                _place_with(_distance, turn_up=2.0),
                "The rows span pi, from straight up to straight down; only the columns span 2 pi.",
            ),
            Mistake(
                _place_with(lambda e_u, e_l, baseline: baseline / np.sin(e_l - e_u)),
                "The cosine of the lower elevation is missing above the fraction line of d.",
            ),
            Mistake(
                _place_with(lambda e_u, e_l, baseline: baseline / np.tan(e_l - e_u)),
                "No right angle there, so no tangent: d = B cos e_l / sin(e_l - e_u).",
            ),
            Mistake(
                _place_with(lambda e_u, e_l, baseline: 1.0),
                "That is the unit vector alone. Multiply it by the distance d.",
            ),
            Mistake(
                _place_on_a_square_image,
                "You divide the row by the width. A panorama is half as high as it is wide: H = W / 2.",
            ),
            Mistake(
                lambda box_upper, box_lower, width, baseline: place_of(box_upper, box_lower, width, 0.3),
                "Your baseline is always 0.3 m: use the argument.",
            ),
            Mistake(
                lambda box_upper, box_lower, width, baseline: place_of(box_upper, box_lower, 1280, baseline),
                "Your panorama is always 1280 columns wide: use the argument.",
            ),
        ),
    ),
    Exercise(
        "14.2",
        range_sigma,
        _triangles,
        (
            Mistake(_sigma_added, "Independent errors add as squares: take the root of the sum of the squares."),
            Mistake(_sigma_level, "That holds for level rays. Each elevation counts with 1 / cos^2 of its own."),
            Mistake(_sigma_linear, "The error grows with the square of the range."),
            Mistake(_sigma_one_camera, "Only the upper camera's noise is in it; the lower one's belongs there too."),
            Mistake(_variance, "That is the variance; the standard deviation is its root."),
            Mistake(_sigma_subtracted, "Independent errors do not cancel: add their squares, whatever the signs."),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: (
                    rho**2 / baseline * sigma * np.sqrt(np.cos(e_u) ** -2 + np.cos(e_l) ** -2)
                ),
                "Under the root stands the square of 1 / cos^2, which is 1 / cos^4.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: (
                    rho**2 / baseline * sigma * np.hypot(np.cos(e_u) ** 2, np.cos(e_l) ** 2)
                ),
                "The cosines stand below the fraction line: steep rays make the error larger.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: (
                    rho**2 / baseline * sigma * (np.cos(e_u) ** -4 + np.cos(e_l) ** -4)
                ),
                "The squares are added, but their root is missing.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: range_sigma(rho, e_u, e_l, baseline, 1.0),
                "sigma is missing: without noise there is no error.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: range_sigma(rho, e_u, e_l, baseline**2, sigma),
                "The baseline counts once: twice the baseline, half the error.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: range_sigma(rho, e_u, e_l, 1 / baseline, sigma),
                "You multiply by the baseline. A longer one makes the error smaller: divide.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: rho**2 / baseline * sigma / np.cos(e_l) ** 2,
                "Only the lower camera's noise is in it; the upper one's belongs there too.",
            ),
        ),
    ),
    Exercise(
        "14.3",
        range_of,
        _matches,
        (
            Mistake(_mean_slope, "One match on something else spoils a mean; a median does not notice it."),
            Mistake(
                _median_range, "Take the median of the slopes and divide once: a range jumps where its slope is near 0."
            ),
            Mistake(_mean_range, "A mean of ranges follows whichever slope is nearest 0. Median, and of the slopes."),
            Mistake(_angles_not_tangents, "It is the tangents that differ by B / rho, not the angles."),
            Mistake(_other_order, "Your range is negative: the lower camera sees points higher, tan e_l - tan e_u."),
            Mistake(_medians_apart, "Subtract match by match first: the two medians may belong to different features."),
            Mistake(
                lambda e_u, e_l, baseline: float(baseline / np.median(np.abs(np.tan(e_l) - np.tan(e_u)))),
                "A negative slope is a wrong match. Its absolute value makes it look right: take slopes as they are.",
            ),
            Mistake(
                lambda e_u, e_l, baseline: float(baseline / np.median(np.tan(e_l - e_u))),
                "You take the tangent of the difference. Take the difference of the two tangents.",
            ),
            Mistake(
                lambda e_u, e_l, baseline: 1 / range_of(e_u, e_l, baseline),
                "That is 1 / rho: divide the other way round.",
            ),
            Mistake(
                lambda e_u, e_l, baseline: range_of(e_u, e_l, 1.0),
                "The baseline is missing: a slope alone has no metres.",
            ),
            Mistake(
                lambda e_u, e_l, baseline: baseline / (np.tan(e_l) - np.tan(e_u)),
                "That is one range for each match. One range is asked for: the median of the slopes first.",
            ),
        ),
    ),
]
