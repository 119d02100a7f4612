"""Exercises of lesson 14: a place from two boxes, the error of a range, a range from many matches, its mean error."""

import numpy as np

from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        np.cos(e_u) * np.cos(a), np.cos(e_u) * np.sin(a), np.sin(e_u) => np.cos(a), np.sin(a), np.tan(e_u)
        You go d along the floor. But d runs along the slanted ray, and along the floor it is d cos e_u.
        baseline * np.cos(e_l) / np.sin(e_l - e_u) => baseline / (np.tan(e_l) - np.tan(e_u))
        You go the horizontal range along a slanted direction. Multiply by d.
        return d => e_u = e_l; return d
        You measure d from the upper camera, so it goes with the upper direction.
        u / width => (u + (box_lower[0] + box_lower[2]) / 2) / 2 / width
        d belongs to the upper camera's ray, and so does the azimuth. Take neither the lower box's nor an average.
        box[2:]) / 2 => box[2:] % [width, np.inf]) / 2
        Across the seam u_max is greater than the width, and must stay so. With a remainder or a cut the middle jumps.
        np.sin(e_l - e_u) => np.sin(e_u - e_l)
        Your point lies behind the camera. The angle at the point is e_l - e_u. Or did you exchange the boxes?
        baseline * np.cos(e_l) => baseline * np.cos(e_u)
        The numerator of d has the cosine of the lower elevation. Look at the law of sines once more.
        0.5 - u / width => u / width - 0.5
        Left and right are swapped. Azimuth decreases to the right, a = (1/2 - u/W) 2 pi.
        (box[:2] + box[2:]) / 2 => box[:2]
        You took the boxes' corners (u_min, v_min). The centre is the mean of both corners.
        2 * v / width => v / width and also 2 * v_lower / width => v_lower / width
        You divide the row by the width. But a panorama is half as high as it is wide, H = W / 2.
    """),
    Exercise("14.2", range_sigma, lambda rng: (*triangles(rng), rng.uniform(0.002, 0.02)), cases={
        "exact baseline": lambda rng: (*triangles(rng), 0.0),
        "exact angles": lambda rng: (*triangles(rng)[:4], 0.0, 0.01),
    }, mistakes="""
        by_baseline = rho / baseline => by_baseline = (rho / baseline) ** 2
        The range is proportional to the baseline. Differentiate B / slope by B, and put rho = B / slope in.
        + by_baseline**2 =>
        The baseline is not known exactly either. Its error is still missing.
        np.sqrt(by_upper**2 + by_lower**2 + by_baseline**2) => by_upper + by_lower + by_baseline
        Independent errors neither cancel nor simply add up. Take the root of the sum of their squares.
        / np.cos(e_u) ** 2 => and also / np.cos(e_l) ** 2 =>
        That holds for level rays. Each elevation counts with 1 / cos^2 of its own.
        np.cos(e_u) ** 2 => np.cos(e_u) and also np.cos(e_l) ** 2 => np.cos(e_l)
        Under the root you need the square of 1 / cos^2, which is 1 / cos^4.
        by_upper**2 + by_lower**2 => by_upper**2
        You use the noise of one camera alone. The other camera's noise belongs there, too.
        rho**2 / baseline => rho / baseline
        The angles' error grows with the square of the range.
        rho**2 / baseline => rho**2 / baseline**2
        The baseline counts once. Twice the baseline gives half the error.
        np.sqrt(by_upper**2 + by_lower**2 + by_baseline**2) => np.sqrt(by_upper**2 + by_lower**2) + by_baseline
        The baseline's error is independent of the others, too. So its part adds as a square, under the root.
        rho / baseline * sigma_baseline => rho**2 / baseline * sigma_baseline
        The baseline's part is too large by a factor of rho. Differentiate rho = B / s by B, with the slope s fixed.
    """),
    Exercise("14.3", range_from_matches, matches, verify=refused_range, cases={
        "one match far off": lambda rng: matches(rng, 5, 1, parallax=(0.5, 0.6)),
        "a stranger comes first": a_stranger_comes_first,
        "all matches diverge": lambda rng: (np.array([0.1, 0.2]), np.array([0.0, 0.1]), 0.3),
    }, mistakes="""
        np.median => np.mean
        np.median => np.mean and also if slope > 0 else np.nan =>
        One match on something else spoils a mean, but hardly moves a median.
        ... => return np.mean(baseline / (np.tan(e_l) - np.tan(e_u)))
        A mean of ranges follows the slope that is nearest 0. Take a median, and take it of the slopes.
        ... => return np.median(baseline * np.cos(e_l) / np.sin(e_l - e_u))
        You have d, along the slanted ray. The task asks for the horizontal range, so use the difference of tangents.
        np.tan(e_l) - np.tan(e_u) => e_l - e_u
        B / rho is the difference of the two tangents, not of the angles, and not the tangent of their difference.
        np.median(np.tan(e_l) - np.tan(e_u)) => np.tan(np.median(e_l)) - np.tan(np.median(e_u))
        Subtract match by match first, because the two medians may belong to different features.
        slope > 0 => (e_l > e_u).all()
        Your result is NaN as soon as one match diverges. But one may be a stranger. Give NaN only if all diverge.
        if slope > 0 else np.nan =>
        This is right while there is a range. But where the matches diverge, your range is negative. It must be NaN.
        baseline / slope => slope / baseline
        The range is B / slope. A slope alone has no metres, and a larger slope means nearer.
    """),
    Exercise("14.4", mean_error, triangles, "challenge", tolerance=5e-5, cases={  # a numerical derivative is right, too
        "rays as far above the horizon as below": rays_as_far_above_the_horizon_as_below,
    }, mistakes="""
        bent_range + bent_slope => bent_range / 2 + bent_slope
        return sigma**2 => return 2 * sigma**2
        return sigma**2 => return sigma**2 / 2
        Something is off by a factor of two. Is it the half of Taylor's series, or the 2 of d2(1/s)/ds2 = 2 / s^3?
        ... => return 0 * rho
        Zero is the first order. The second order does not cancel, because B / slope is a curve.
        + bent_slope =>
        The slope is a curve over e, too, because tan e is one. Its second derivative gives a second part.
        bent_range + =>
        You differentiated the tangents twice. But B / slope itself is a curve, and this part is missing.
        bent_range + bent_slope => bent_range - bent_slope
        The sign of the tangents' part is wrong, because the upper elevation has a minus in the slope.
        ... => return 2 * sigma**2 * rho**3 / baseline**2
        That holds for level rays. Each elevation counts with 1 / cos of its own.
        ... => return range_sigma(rho, e_u, e_l, baseline, sigma, 0)
        That is the standard deviation. The task asks for the mean of the error, which is much smaller.
    """),
]
