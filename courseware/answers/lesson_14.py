"""Exercises of lesson 14: a place from two boxes, the error of a range, a range from many matches, its mean error."""

import numpy as np

from courseware.lessons.kit.exercise import Exercise


def place(box_upper, box_lower, width, baseline):
    """Place X = d x_hat (3,) in metres of the object in two boxes."""
    # Angles of both centres, eq. (14.1), and eq. (14.2).
    (u, v), (_, v_lower) = [(box[:2] + box[2:]) / 2 for box in (box_upper, box_lower)]
    a, e_u, e_l = (0.5 - u / width) * 2 * np.pi, (0.5 - 2 * v / width) * np.pi, (0.5 - 2 * v_lower / width) * np.pi
    d = baseline * np.cos(e_l) / np.sin(e_l - e_u)
    return d * np.array([np.cos(e_u) * np.cos(a), np.cos(e_u) * np.sin(a), np.sin(e_u)])


def two_boxes(rng: np.random.Generator, turn=None, wide=0.05) -> tuple:
    """Return boxes of one object, whose centres differ in azimuth as the centres of real boxes do.

    turn: column of the upper centre, and wide: greatest half width, both as shares of the panorama's width.
    """
    turn, width = rng.uniform(0.1, 0.95) if turn is None else turn, int(rng.choice([640, 1280]))
    baseline, rho, z = rng.uniform(0.2, 0.6), rng.uniform(1.0, 4.0), rng.uniform(-1.4, -0.3)
    aside, boxes = rng.choice([-1, 1]) * rng.uniform(0.002, 0.01), []
    for height, u in ((z, turn * width), (z + baseline, (turn + aside) * width)):
        centre = np.array([u, (0.5 - np.arctan2(height, rho) / np.pi) * width / 2])
        half = rng.uniform(0.2, 1.0, 2) * wide * width
        boxes.append(np.concatenate([centre - half, centre + half]))
    return *boxes, width, baseline


def boxes_across_the_seam(rng: np.random.Generator) -> tuple:
    """Return boxes that begin before the right edge and end behind it, where u_max is greater than the width."""
    upper, lower, width, baseline = two_boxes(rng, turn=0.99)
    upper[2], lower[2] = width + rng.uniform(0.01, 0.05, 2) * width
    return upper, lower, width, baseline


def range_sigma(rho, e_u, e_l, baseline, sigma, sigma_baseline):
    """Standard deviation (n,) of horizontal ranges rho (n,), metres."""
    # Three derivatives times their sigmas, added as squares.
    by_upper = rho**2 / baseline / np.cos(e_u) ** 2 * sigma
    by_lower = rho**2 / baseline / np.cos(e_l) ** 2 * sigma
    by_baseline = rho / baseline * sigma_baseline
    return np.sqrt(by_upper**2 + by_lower**2 + by_baseline**2)


def triangles(rng: np.random.Generator) -> tuple:
    baseline, rho, z = rng.uniform(0.1, 0.6), rng.uniform(1.2, 6.0, 5), rng.uniform(-1.4, 0.3, 5)
    e_u, e_l = np.arctan2(z, rho), np.arctan2(z + baseline, rho)
    return rho, e_u, e_l, baseline, rng.uniform(0.001, 0.01)


def range_from_matches(e_u, e_l, baseline):
    """Horizontal range in metres from matched features (n,), robustly; NaN if all of them diverge."""
    # The median of the slopes, then eq. (14.3); the mean of the slopes near it would do as well.
    slope = np.median(np.tan(e_l) - np.tan(e_u))
    return baseline / slope if slope > 0 else np.nan


def matches(rng: np.random.Generator, n=None, strangers=None, parallax=(-0.3, 0.03)) -> tuple:
    """Return matches of one object, an even number. One in four is of something else, and may even diverge."""
    n = 2 * int(rng.integers(3, 7)) if n is None else n
    baseline, rho, z = rng.uniform(0.2, 0.5), rng.uniform(1.5, 4.0), rng.uniform(-1.3, -0.2, n)
    e_u, e_l = np.arctan2(z, rho), np.arctan2(z + baseline, rho) + 0.004 * rng.uniform(-1, 1, n)
    others = rng.permutation(n)[: max(1, n // 4) if strangers is None else strangers]
    e_l[others] = e_u[others] + rng.uniform(*parallax, len(others))
    return e_u, e_l, baseline


def a_stranger_comes_first(rng: np.random.Generator) -> tuple:
    """Return a wrong match of the lowest feature, so that the medians of both sides belong to different features."""
    e_u, e_l, baseline = matches(rng, 9, 0)
    order = np.argsort(e_u)
    e_l[order[0]] = e_u[order[0]] + 0.55
    return e_u[order], e_l[order], baseline


def refused_range(arguments: tuple, answer: object) -> str | None:
    """Say what is wrong with a range of matched features: it must lie among the ranges of the majority."""
    e_u, e_l, baseline = arguments
    if np.size(answer) != 1 or np.asarray(answer).dtype.kind not in "iuf":
        return "Return one range, a single number for all matches together."
    value, slopes = float(np.reshape(answer, ())), np.tan(e_l) - np.tan(e_u)
    if (slopes <= 0).all():
        return None if np.isnan(value) else "Where the matches diverge there is no range, so the answer is NaN."
    own = slopes[(np.abs(slopes - np.median(slopes)) <= 0.05) & (slopes > 0)]
    if baseline / own.max() * (1 - 1e-5) <= value <= baseline / own.min() * (1 + 1e-5):
        return None
    return "Your range lies outside of what most of the matches say. Is it in metres, and does one stranger move it?"


def mean_error(rho, e_u, e_l, baseline, sigma):
    """How much too far ranges (n,) are on the average, metres, to second order in sigma."""
    # Half of each second derivative of B / (tan e_l - tan e_u), times sigma squared.
    bent_range = rho**3 / baseline**2 * (np.cos(e_u) ** -4 + np.cos(e_l) ** -4)
    bent_slope = rho**2 / baseline * (np.tan(e_u) / np.cos(e_u) ** 2 - np.tan(e_l) / np.cos(e_l) ** 2)
    return sigma**2 * (bent_range + bent_slope)


def rays_as_far_above_the_horizon_as_below(rng: np.random.Generator) -> tuple:
    """Return triangles where both tangents' parts are the same."""
    baseline, rho = rng.uniform(0.1, 0.6), rng.uniform(2.0, 6.0, 3)
    e = np.arctan2(baseline / 2, rho)
    return rho, -e, e, baseline, rng.uniform(0.001, 0.01)


# fmt: off
EXERCISES = [
    Exercise("14.1", place, two_boxes, "warm-up", cases={
        "boxes across the seam": boxes_across_the_seam,
        "boxes near the left edge": lambda rng: two_boxes(rng, turn=0.04, wide=0.03),
    }, example=(([600, 380, 700, 460], [596, 350, 696, 430], 1280, 0.3), [1.7, -0.08, -0.91])),
    Exercise("14.2", range_sigma, lambda rng: (*triangles(rng), rng.uniform(0.002, 0.02)), cases={
        "exact baseline": lambda rng: (*triangles(rng), 0.0),
        "exact angles": lambda rng: (*triangles(rng)[:4], 0.0, 0.01),
    }, example=(([2, 4], [-0.4, -0.2], [-0.27, -0.13], 0.3, 0.005, 0.01), [0.126, 0.41])),
    Exercise("14.3", range_from_matches, matches, verify=refused_range, cases={
        "one match far off": lambda rng: matches(rng, 5, 1, parallax=(0.5, 0.6)),
        "a stranger comes first": a_stranger_comes_first,
        "all matches diverge": lambda rng: (np.array([0.1, 0.2]), np.array([0.0, 0.1]), 0.3),
    }),
    Exercise("14.4", mean_error, triangles, "challenge", tolerance=5e-5, cases={  # a numerical derivative is right, too
        "rays as far above the horizon as below": rays_as_far_above_the_horizon_as_below,
    }),
]
