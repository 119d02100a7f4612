"""Exercises of lesson 14: a place from two boxes, the error of a range, a range from many matches, its mean error."""

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
    """Boxes of one object anywhere around the rig; the two centres differ in azimuth, as real boxes' do."""
    return _boxes_at(rng, rng.uniform(0.1, 0.95))


def _boxes_at(rng: np.random.Generator, turn: float, wide: float = 0.05) -> tuple:
    """Boxes whose upper centre is at column turn x width; half their width is up to `wide` of the panorama's."""
    width = int(rng.choice([640, 1280]))
    baseline, rho, z = rng.uniform(0.2, 0.6), rng.uniform(1.0, 4.0), rng.uniform(-1.4, -0.3)
    boxes = []
    aside = rng.choice([-1, 1]) * rng.uniform(0.002, 0.01)
    for height, u in ((z, turn * width), (z + baseline, (turn + aside) * width)):
        v = (0.5 - np.arctan2(height, rho) / np.pi) * width / 2
        half_width, half_height = rng.uniform(0.2, 1.0, 2) * wide * width
        boxes.append(np.array([u - half_width, v - half_height, u + half_width, v + half_height]))
    return boxes[0], boxes[1], width, baseline


def _across_the_seam(rng: np.random.Generator) -> tuple:
    """Boxes that begin before the right edge and end behind it: u_max is greater than the width."""
    upper, lower, width, baseline = _boxes_at(rng, 0.99)
    upper[2], lower[2] = width + rng.uniform(0.01, 0.05, 2) * width
    return upper, lower, width, baseline


def _place_with_the_range(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    (a, e_u), (_, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
    return baseline / (np.tan(e_l) - np.tan(e_u)) * _direction(a, e_u)


def _place_with_d_for_the_range(
    box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float
) -> np.ndarray:
    """Goes d along the floor and then up by its tangent."""
    (a, e_u), (_, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
    return _distance(e_u, e_l, baseline) * np.array([np.cos(a), np.sin(a), np.tan(e_u)])


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


def _place_turned(azimuth: Callable) -> Callable:
    """A mistake: right but for the azimuth, which is `azimuth(box_upper, box_lower, width)`."""

    def mistaken(box_upper, box_lower, width, baseline):
        (_, e_u), (_, e_l) = (_angles(_centre(box), width) for box in (box_upper, box_lower))
        return _distance(e_u, e_l, baseline) * _direction(azimuth(box_upper, box_lower, width), e_u)

    return mistaken


def _azimuth(box: np.ndarray, width: int) -> float:
    return _angles(_centre(box), width)[0]


def _place_in_degrees(box_upper: np.ndarray, box_lower: np.ndarray, width: int, baseline: float) -> np.ndarray:
    (a, e_u), (_, e_l) = (np.rad2deg(_angles(_centre(box), width)) for box in (box_upper, box_lower))
    return _distance(e_u, e_l, baseline) * _direction(a, e_u)


def _place_with_right_edge(edge: Callable) -> Callable:
    """A mistake: right but for boxes across the seam, whose u_max becomes `edge(u_max, width)`."""

    def mistaken(box_upper, box_lower, width, baseline):
        boxes = [np.array([box[0], box[1], edge(box[2], width), box[3]]) for box in (box_upper, box_lower)]
        return place_of(*boxes, width, baseline)

    return mistaken


# 14.2: the standard deviation of a range


def range_sigma(
    rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float, sigma_baseline: float
) -> np.ndarray:
    """Standard deviation `(n,)`, metres, of ranges; sigma: of either elevation [rad], sigma_baseline: metres.

    sqrt((rho^2 / B)^2 sigma^2 (sec^4 e_u + sec^4 e_l) + (rho / B)^2 sigma_B^2)
    """
    return np.hypot(_by_angles(rho, e_u, e_l, baseline, sigma), rho / baseline * sigma_baseline)


def _by_angles(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    return rho**2 / baseline * sigma * np.sqrt(np.cos(e_u) ** -4 + np.cos(e_l) ** -4)


def _triangles(rng: np.random.Generator) -> tuple:
    baseline, rho, z = rng.uniform(0.1, 0.6), rng.uniform(1.2, 6.0, 5), rng.uniform(-1.4, 0.3, 5)
    e_u, e_l = np.arctan2(z, rho), np.arctan2(z + baseline, rho)
    return rho, e_u, e_l, baseline, rng.uniform(0.001, 0.01), rng.uniform(0.002, 0.02)


def _angles_alone(by_angles: Callable) -> Callable:
    """A mistake: the part of the angles is `by_angles(rho, e_u, e_l, baseline, sigma)`; the baseline's is right."""

    def mistaken(rho, e_u, e_l, baseline, sigma, sigma_baseline):
        return np.hypot(by_angles(rho, e_u, e_l, baseline, sigma), rho / baseline * sigma_baseline)

    return mistaken


def _sigma_in_degrees(rho, e_u, e_l, baseline, sigma, sigma_baseline):
    return range_sigma(rho, np.deg2rad(e_u), np.deg2rad(e_l), baseline, sigma, sigma_baseline)


# 14.3: one range from many matches


def range_of(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    """baseline / median(tan e_l - tan e_u), metres, of matches `(n,)`; NaN where that slope is not positive."""
    slope = float(np.median(np.tan(e_l) - np.tan(e_u)))
    return float(baseline / slope) if slope > 0 else float("nan")


def _matches(rng: np.random.Generator) -> tuple:
    """An even number of matches; one in four is of something else, and that one may even diverge."""
    n = 2 * int(rng.integers(3, 7))
    return _matches_with(rng, n, max(1, n // 4), lambda size: rng.uniform(-0.3, 0.03, size))


def _matches_with(rng: np.random.Generator, n: int, n_strangers: int, parallax: Callable) -> tuple:
    """n matches of one object, of which so many are strangers with `parallax(size)` in place of their own."""
    baseline, rho = rng.uniform(0.2, 0.5), rng.uniform(1.5, 4.0)
    z = rng.uniform(-1.3, -0.2, n)
    e_u, e_l = np.arctan2(z, rho), np.arctan2(z + baseline, rho) + 0.004 * rng.uniform(-1, 1, n)
    strangers = rng.permutation(n)[:n_strangers]
    e_l[strangers] = e_u[strangers] + parallax(n_strangers)
    return e_u, e_l, baseline


def _one_match_is_far_off(rng: np.random.Generator) -> tuple:
    return _matches_with(rng, 5, 1, lambda size: rng.uniform(0.5, 0.6, size))


def _stranger_first(rng: np.random.Generator) -> tuple:
    """The match on something else comes first in the list."""
    e_u, e_l, baseline = _one_match_is_far_off(rng)
    order = np.argsort(e_u - e_l)
    return e_u[order], e_l[order], baseline


def _images_swapped(rng: np.random.Generator) -> tuple:
    """Every match diverges, as when the upper image is taken for the lower: there is no range."""
    e_u, e_l, baseline = _matches_with(rng, 8, 0, lambda size: np.zeros(size))
    return e_l, e_u, baseline


def refuses_range(arguments: tuple, answer: object) -> str | None:
    """What is wrong with one range of matched features, or None: it must lie among those of the majority."""
    e_u, e_l, baseline = arguments
    if np.size(answer) != 1 or np.asarray(answer).dtype.kind not in "iuf":
        return "One range is asked for, a single number for all matches together."
    value = float(np.reshape(answer, ()))
    slopes = np.tan(e_l) - np.tan(e_u)
    if (slopes <= 0).all():
        return None if np.isnan(value) else "Where the matches diverge there is no range: the answer is NaN, no number."
    own = slopes[np.abs(slopes - np.median(slopes)) <= 0.05]
    nearest, farthest = baseline / own.max(), baseline / own[own > 0].min()
    if nearest * (1 - 1e-5) <= value <= farthest * (1 + 1e-5):
        return None
    return "Your range lies outside of what most of the matches say: is it in metres, and does one stranger move it?"


def _mean_slope(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / np.mean(np.tan(e_l) - np.tan(e_u)))


def _mean_range(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(np.mean(baseline / (np.tan(e_l) - np.tan(e_u))))


def _angles_not_tangents(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / np.median(e_l - e_u))


def _other_order(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return -range_of(e_u, e_l, baseline)


def _medians_apart(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / (np.tan(np.median(e_l)) - np.tan(np.median(e_u))))


def _along_the_ray(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(np.median(baseline * np.cos(e_l) / np.sin(e_l - e_u)))


def _first_match(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / (np.tan(e_l[0]) - np.tan(e_u[0])))


def _tangent_of_the_difference(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return float(baseline / np.median(np.tan(e_l - e_u)))


def _nan_if_any_diverges(e_u: np.ndarray, e_l: np.ndarray, baseline: float) -> float:
    return range_of(e_u, e_l, baseline) if (np.tan(e_l) > np.tan(e_u)).all() else float("nan")


def _of_those_in_front(range_from: Callable) -> Callable:
    """A mistake: `range_from` of the matches that do not diverge; NaN where there is none."""

    def mistaken(e_u, e_l, baseline):
        good = np.tan(e_l) > np.tan(e_u)
        return range_from(e_u[good], e_l[good], baseline) if good.any() else float("nan")

    return mistaken


def _or_nan(range_from: Callable) -> Callable:
    """`range_from`, but NaN where all matches diverge."""

    def mistaken(e_u, e_l, baseline):
        return range_from(e_u, e_l, baseline) if (np.tan(e_l) > np.tan(e_u)).any() else float("nan")

    return mistaken


_SPOILED = {
    _mean_slope: "One match on something else spoils a mean; a median does not notice it.",
    _mean_range: "A mean of ranges follows whichever slope is nearest 0. Median, and of the slopes.",
    _along_the_ray: "That is d, along the slanted ray. Asked is the horizontal range: the difference of tangents.",
    _first_match: "You take the first match alone. It may be the one on something else.",
    _angles_not_tangents: "It is the tangents that differ by B / rho, not the angles.",
    _medians_apart: "Subtract match by match first: the two medians may belong to different features.",
    _tangent_of_the_difference: "You take the tangent of the difference. Take the difference of the two tangents.",
}
"""Ranges that are wrong whether or not matches that diverge were looked at, and why."""


# 14.4: the mean error of a range


def mean_error(rho: np.ndarray, e_u: np.ndarray, e_l: np.ndarray, baseline: float, sigma: float) -> np.ndarray:
    """How much too far ranges `(n,)` are on the average, metres, to second order in sigma [rad].

    sigma^2 (rho^3 / B^2 (sec^4 e_u + sec^4 e_l) + rho^2 / B (sec^2 e_u tan e_u - sec^2 e_l tan e_l)): half of the two
    second derivatives of rho = B / (tan e_l - tan e_u), times sigma^2.
    """
    return sigma**2 * (_by_curvature(rho, e_u, e_l, baseline) + _by_tangent(rho, e_u, e_l, baseline))


def _by_curvature(rho, e_u, e_l, baseline):
    return rho**3 / baseline**2 * (np.cos(e_u) ** -4 + np.cos(e_l) ** -4)


def _with_shares(of_curvature, of_tangent):
    """The mean error with its two parts taken so many times."""

    def wrong(rho, e_u, e_l, baseline, sigma):
        curvature = of_curvature * _by_curvature(rho, e_u, e_l, baseline)
        return sigma**2 * (curvature + of_tangent * _by_tangent(rho, e_u, e_l, baseline))

    return wrong


def _by_tangent(rho, e_u, e_l, baseline):
    return rho**2 / baseline * (np.tan(e_u) / np.cos(e_u) ** 2 - np.tan(e_l) / np.cos(e_l) ** 2)


def _noisy_triangles(rng: np.random.Generator) -> tuple:
    return _triangles(rng)[:5]


def _level_rays(rng: np.random.Generator) -> tuple:
    """Half of the parallax above the horizon, half below: the tangents' part is the same from both."""
    baseline, rho = rng.uniform(0.1, 0.6), rng.uniform(2.0, 6.0, 3)
    e = np.arctan2(baseline / 2, rho)
    return rho, -e, e, baseline, rng.uniform(0.001, 0.01)


EXERCISES = [
    Exercise(
        number="14.1",
        solution=place_of,
        inputs=_two_boxes,
        level="warm-up",
        cases=(_across_the_seam, lambda rng: _boxes_at(rng, 0.5), lambda rng: _boxes_at(rng, 0.04, wide=0.03)),
        mistakes=(
            Mistake(
                _place_with_d_for_the_range,
                "You go d along the floor. d runs along the slanted ray; along the floor it is d cos e_u.",
            ),
            Mistake(
                _place_with(lambda e_u, e_l, baseline: baseline / (e_l - e_u) / np.cos(e_u)),
                "baseline / (e_l - e_u) holds for level rays alone. Take eq. (14.1), or the tangents of (14.3).",
            ),
            Mistake(_place_with_the_range, "You go the horizontal range along a slanted direction: multiply by d."),
            Mistake(_place_from_below, "d is measured from the upper camera, so it goes with the upper direction."),
            Mistake(
                _place_turned(lambda upper, lower, width: _azimuth(lower, width)),
                "You take the lower box's azimuth. d belongs to the upper camera's ray, and so does the azimuth.",
            ),
            Mistake(
                _place_turned(lambda upper, lower, width: (_azimuth(upper, width) + _azimuth(lower, width)) / 2),
                "You average the two azimuths. The place lies on the upper camera's ray: its azimuth alone.",
            ),
            Mistake(
                _place_with_right_edge(lambda right, width: right % width),
                "Across the seam u_max lies beyond the width and must stay there: with a remainder the middle jumps.",
            ),
            Mistake(
                _place_with_right_edge(min),
                "You cut boxes off at the right edge. Across the seam u_max is greater than the width, and means it.",
            ),
            Mistake(
                lambda box_upper, box_lower, width, baseline: place_of(box_lower, box_upper, width, baseline),
                "Upper and lower box are exchanged: your point comes out behind the camera.",
            ),
            Mistake(_place_in_degrees, "np.sin and np.cos take radians; yours are given degrees."),
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
                "No right angle there, so no tangent: look at the law of sines once more.",
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
        number="14.2",
        solution=range_sigma,
        inputs=_triangles,
        cases=(
            lambda rng: (*_triangles(rng)[:5], 0.0),
            lambda rng: (*_triangles(rng)[:4], 0.0, 0.01),
            lambda rng: (*_level_rays(rng), 0.004),
        ),
        mistakes=(
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: range_sigma(
                    rho, e_u, e_l, 0.3, sigma, sigma_baseline
                ),
                "Your baseline is always 0.3 m: use the argument.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: np.hypot(
                    _by_angles(rho, e_u, e_l, baseline, sigma), (rho / baseline) ** 2 * sigma_baseline
                ),
                "The range is proportional to the baseline: differentiate B / slope by B, and put rho = B / slope in.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: _by_angles(rho, e_u, e_l, baseline, sigma),
                "The baseline is not known exactly either: its error is still missing.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: (
                    _by_angles(rho, e_u, e_l, baseline, sigma) + rho / baseline * sigma_baseline
                ),
                "The baseline's error is independent of the angles': it joins them under the root, as a square.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: np.hypot(
                    _by_angles(rho, e_u, e_l, baseline, sigma), sigma_baseline
                ),
                "A baseline 1 % too long makes every range 1 % too long: its error grows with the range.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: np.hypot(
                    _by_angles(rho, e_u, e_l, baseline, sigma), sigma_baseline / baseline
                ),
                "sigma_B / B is a share. A share of what, to be metres?",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: np.hypot(
                    _by_angles(rho, e_u, e_l, baseline, sigma), rho**2 / baseline * sigma_baseline
                ),
                "The range is proportional to the baseline: differentiate by B, and only one rho is left.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: rho / baseline * sigma_baseline,
                "That is the baseline's part alone; the two elevations are missing.",
            ),
            Mistake(
                _sigma_in_degrees,
                "The elevations are radians already: yours are turned into radians once more.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma, sigma_baseline: _sigma_in_degrees(
                    rho, e_u, e_l, baseline, np.deg2rad(sigma), sigma_baseline
                ),
                "The elevations and sigma are radians already: yours are turned into radians once more.",
            ),
            Mistake(
                _angles_alone(
                    lambda rho, e_u, e_l, baseline, sigma: (
                        rho**2 / baseline * sigma * (np.cos(e_u) ** -2 + np.cos(e_l) ** -2)
                    )
                ),
                "Independent errors add as squares: take the root of the sum of the squares.",
            ),
            Mistake(
                _angles_alone(lambda rho, e_u, e_l, baseline, sigma: rho**2 / baseline * sigma * np.sqrt(2)),
                "That holds for level rays. Each elevation counts with 1 / cos^2 of its own.",
            ),
            Mistake(
                _angles_alone(lambda rho, e_u, e_l, baseline, sigma: _by_angles(rho, e_u, e_l, baseline, sigma) / rho),
                "The angles' error grows with the square of the range.",
            ),
            Mistake(
                _angles_alone(lambda rho, e_u, e_l, baseline, sigma: rho**2 / baseline * sigma / np.cos(e_u) ** 2),
                "Only the upper camera's noise is in it; the lower one's belongs there too.",
            ),
            Mistake(
                _angles_alone(lambda rho, e_u, e_l, baseline, sigma: rho**2 / baseline * sigma / np.cos(e_l) ** 2),
                "Only the lower camera's noise is in it; the upper one's belongs there too.",
            ),
            Mistake(
                lambda *arguments: range_sigma(*arguments) ** 2,
                "That is the variance; the standard deviation is its root.",
            ),
            Mistake(
                _angles_alone(
                    lambda rho, e_u, e_l, baseline, sigma: (
                        rho**2 / baseline * sigma * np.abs(np.cos(e_u) ** -2 - np.cos(e_l) ** -2)
                    )
                ),
                "Independent errors do not cancel: add their squares, whatever the signs.",
            ),
            Mistake(
                _angles_alone(
                    lambda rho, e_u, e_l, baseline, sigma: (
                        rho**2 / baseline * sigma * np.sqrt(np.cos(e_u) ** -2 + np.cos(e_l) ** -2)
                    )
                ),
                "Under the root stands the square of 1 / cos^2, which is 1 / cos^4.",
            ),
            Mistake(
                _angles_alone(
                    lambda rho, e_u, e_l, baseline, sigma: (
                        rho**2 / baseline * sigma * np.hypot(np.cos(e_u) ** 2, np.cos(e_l) ** 2)
                    )
                ),
                "The cosines stand below the fraction line: steep rays make the error larger.",
            ),
            Mistake(
                _angles_alone(lambda rho, e_u, e_l, baseline, sigma: _by_angles(rho, e_u, e_l, baseline, 1.0)),
                "sigma is missing: without noise there is no error.",
            ),
            Mistake(
                _angles_alone(lambda rho, e_u, e_l, baseline, sigma: _by_angles(rho, e_u, e_l, baseline**2, sigma)),
                "The baseline counts once: twice the baseline, half the error.",
            ),
        ),
    ),
    Exercise(
        number="14.3",
        solution=range_of,
        inputs=_matches,
        verify=refuses_range,
        cases=(_one_match_is_far_off, _stranger_first, _images_swapped, lambda rng: _matches_with(rng, 9, 0, np.zeros)),
        mistakes=(
            *(
                Mistake(range_from, why, others=(_or_nan(range_from), _of_those_in_front(range_from)))
                for range_from, why in _SPOILED.items()
            ),
            Mistake(
                _nan_if_any_diverges,
                "Yours is NaN as soon as one match diverges. One may be a stranger: NaN only where all of them do.",
            ),
            Mistake(
                lambda e_u, e_l, baseline: float(baseline / np.median(np.tan(e_l) - np.tan(e_u))),
                "Right while there is a range. But where the matches diverge yours is negative: NaN belongs there.",
            ),
            Mistake(
                lambda e_u, e_l, baseline: abs(float(baseline / np.median(np.tan(e_u) - np.tan(e_l)))),
                "Your absolute value hides matches that diverge: there the answer is NaN, no positive number.",
            ),
            Mistake(_other_order, "Your range is negative: the lower camera sees points higher, tan e_l - tan e_u."),
            Mistake(
                lambda e_u, e_l, baseline: float(baseline / np.median(np.abs(np.tan(e_l) - np.tan(e_u)))),
                "A negative slope is a wrong match. Its absolute value makes it look right: take slopes as they are.",
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
    Exercise(
        number="14.4",
        solution=mean_error,
        inputs=_noisy_triangles,
        level="challenge",
        cases=(_level_rays,),
        mistakes=(
            Mistake(
                _with_shares(0.5, 1),
                "One of the two parts is off by a factor of two: a half of Taylor's series, or the 2 of 2 / s^3.",
                others=(_with_shares(2, 1), _with_shares(1, 0.5), _with_shares(1, 2)),
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: mean_error(rho, e_u, e_l, baseline, sigma) / rho,
                "That is the share of the range. The task asks for metres.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: 0 * rho,
                "Zero is the first order. The second does not cancel: B / slope bends.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: mean_error(rho, e_u, e_l, 0.3, sigma),
                "Your baseline is always 0.3 m: use the argument.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: sigma**2 * _by_curvature(rho, e_u, e_l, baseline),
                "The slope is not even either: tan e bends, too. Its second derivative gives a second part.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: sigma**2 * _by_tangent(rho, e_u, e_l, baseline),
                "You differentiated the tangents twice, but B / slope itself bends: that part is missing.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: 2 * mean_error(rho, e_u, e_l, baseline, sigma),
                "Twice too large: the second-order term of Taylor's series has a factor of one half.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: mean_error(rho, e_u, e_l, baseline, sigma) / 2,
                "Half of it: d2(1/s)/ds2 = 2 / s^3; one of the twos is lost.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: (
                    sigma**2 * (_by_curvature(rho, e_u, e_l, baseline) - _by_tangent(rho, e_u, e_l, baseline))
                ),
                "The sign of the tangents' part is wrong: the upper elevation stands in the slope with a minus.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: 2 * sigma**2 * rho**3 / baseline**2,
                "That holds for level rays. Each elevation counts with 1 / cos of its own.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: mean_error(rho, e_u, e_l, baseline, 1.0) * sigma,
                "The first order cancels in the mean, so what is left grows with sigma squared.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: _by_angles(rho, e_u, e_l, baseline, sigma),
                "That is the standard deviation. Asked is the mean of the error, which is much smaller.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: rho + mean_error(rho, e_u, e_l, baseline, sigma),
                "That is the mean range; asked is by how much it is too far.",
            ),
            Mistake(
                lambda rho, e_u, e_l, baseline, sigma: -mean_error(rho, e_u, e_l, baseline, sigma),
                "Too far is positive: measured minus true.",
            ),
        ),
        tolerance=5e-5,  # a second derivative taken numerically is right as well
    ),
]
