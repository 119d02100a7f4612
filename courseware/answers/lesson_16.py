"""Exercises of lesson 16: a pose with a compass, the scale, the pair that does not fit, weights, error bars."""

import numpy as np

from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d, rotation_2d
from courseware.lessons.kit.exercise import Exercise


def noisy_points(rng: np.random.Generator, fewest: int = 2) -> tuple:
    """Return noisy points in the body frame and the world, with all headings; often only two."""
    n = max(fewest, 2 if rng.random() < 0.3 else int(rng.integers(3, 9)))
    source = rng.uniform(-4, 4, (n, 2)) + rng.uniform(-1, 1, 2)
    return source, in_the_world(rng, source, rng.uniform(-np.pi, np.pi), 0.1)


def in_the_world(rng: np.random.Generator, source: np.ndarray, theta: float, sigma: float) -> np.ndarray:
    return source @ rotation_2d(theta).T + rng.uniform(1, 5, 2) + rng.normal(0, sigma, source.shape)


def place_from_heading(source, target, theta):
    """x, y [m] of the body in the world, from matched points (n, 2) and the heading theta [rad]."""
    # The landmarks' centroid minus the turned centroid of what was measured.
    R = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    x, y = target.mean(axis=0) - R @ source.mean(axis=0)
    return x, y


def fitted_scale(source, target):
    """Scale c by which the source (n, 2) must be stretched to fit the target (n, 2) best."""
    # The lowest place of the parabola c^2 A - 2 c B.
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    dot, cross = np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    return np.hypot(dot, cross) / np.sum(a**2)


def scaled_points(rng: np.random.Generator, factors=(1, 1), fewest: int = 2) -> tuple:
    source, target = noisy_points(rng, fewest)
    return source * rng.uniform(0.7, 1.4) * factors, target


def odd_pair(source, target):
    """Index of the pair without which the others fit best."""
    # Leave one out, and see which absence helps most.
    left_over = []
    for k in range(len(source)):
        s, m = np.delete(source, k, axis=0), np.delete(target, k, axis=0)
        left_over.append(np.sum((fit_rigid_2d(s, m).apply(s) - m) ** 2))
    return int(np.argmin(left_over))


def best_by(source, target, measure, of_all=False):
    """A mistake: without which pair is `measure` of the residuals' lengths least, of the others or of all pairs?"""
    left_over = []
    for k in range(len(source)):
        s, m = np.delete(source, k, axis=0), np.delete(target, k, axis=0)
        off = np.linalg.norm(fit_rigid_2d(s, m).apply(source) - target, axis=1)
        left_over.append(measure(off if of_all else np.delete(off, k)))
    return int(np.argmin(left_over))


def points_with_an_odd_pair(rng: np.random.Generator, sigma: float = 0.0, telling=odd_pair) -> tuple:
    """Return points near each other and an odd one far out, until the library fits them and they are `telling`.

    The odd one drags the fit along. At times a right one is farther out, so that one has to look at the targets.
    """
    while True:
        n = int(rng.integers(5, 8))
        source = rng.uniform(-1, 1, (n, 2))
        k, theta = int(rng.integers(n)), rng.uniform(-np.pi, np.pi)
        source[k] = rng.uniform(3, 5) * np.array([1, rng.uniform(-0.3, 0.3)])
        if rng.random() < 0.5:
            source[k - 1] = rng.uniform(6, 7) * np.array([-1, rng.uniform(-0.3, 0.3)])
        target = in_the_world(rng, source, theta, np.hypot(0.05, sigma))
        target[k] += rotation_2d(theta) @ [0, rng.choice([-1, 1]) * rng.uniform(1.5, 4)]
        try:
            if telling(source, target) is not False:
                return source, target
        except RigidFitError:
            continue


def other_measures_differ(s, m):
    return odd_pair(s, m) not in [best_by(s, m, measure) for measure in (np.sum, np.max, np.median)]


def the_one_left_out_decides(s, m):
    return best_by(s, m, lambda off: off @ off, True) not in (odd_pair(s, m), best_by(s, m, lambda off: -off @ off))


def fit_weighted(source, target, weights):
    """x, y [m] and theta [rad] of the body in the world, from matched points (n, 2) and weights (n,)."""
    # Weighted centroids, weighted sums of dot and cross products, then the turned centroid.
    s_G, m_G = (weights @ points / weights.sum() for points in (source, target))
    a, b = source - s_G, target - m_G
    theta = np.arctan2(weights @ (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]), weights @ np.sum(a * b, axis=1))
    R = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
    x, y = m_G - R @ s_G
    return x, y, theta


def weighted_points(rng: np.random.Generator) -> tuple:
    """Return three points or more of unequal noise, with weights that fit it."""
    source, target = noisy_points(rng, fewest=3)
    sigma = rng.uniform(0.05, 0.8, len(source))
    return source, target + sigma[:, None] * rng.standard_normal(target.shape), 1 / sigma**2


def a_pair_of_weight_0(rng: np.random.Generator) -> tuple:
    source, target, weights = weighted_points(rng)
    source, target = np.vstack([source, rng.uniform(-4, 4, (1, 2))]), np.vstack([target, rng.uniform(8, 12, (1, 2))])
    return source, target, np.append(weights, 0.0)


def a_wall_that_looks_mirrored(rng: np.random.Generator) -> tuple:
    """Return objects along a wall. Their noise makes a mirror image fit better than any rotation."""
    while True:
        source = np.column_stack([np.linspace(-3, 3, 6), rng.normal(0, 0.05, 6)])
        target, weights = in_the_world(rng, source, rng.uniform(-np.pi, np.pi), 0.05), rng.uniform(0.5, 2, 6)
        a, b = (points - weights @ points / weights.sum() for points in (source, target))
        if np.linalg.det((weights[:, None] * b).T @ a) < -0.1:
            return source, target, weights


def nearly_half_a_turn(rng: np.random.Generator) -> tuple:
    source, _, weights = weighted_points(rng)
    return source, in_the_world(rng, source, np.pi - 0.05, 0.02), weights


def by_svd_without_sign(source, target, weights):
    s_g, m_g = (weights @ points / weights.sum() for points in (source, target))
    u, _, vt = np.linalg.svd((weights[:, None] * (target - m_g)).T @ (source - s_g))
    return *(m_g - u @ vt @ s_g), np.arctan2((u @ vt)[1, 0], (u @ vt)[0, 0])


def pose_sigmas(source, theta, covariances):
    """Standard deviations of x, y [m] and theta [rad] of the plain fit to points with these covariances."""
    # Derivatives by each point's two coordinates (body axes), turned to the world, then row C column.
    (s_x, s_y), n = source.mean(axis=0), len(source)
    a = source - [s_x, s_y]
    turn = np.column_stack([a[:, 1], -a[:, 0]]) / np.sum(a**2)  # d theta by each point
    x, y = -np.tile([1, 0], (n, 1)) / n + s_y * turn, -np.tile([0, 1], (n, 1)) / n - s_x * turn
    rows = [np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y, turn]
    return tuple(np.sqrt(np.einsum("ni,nij,nj->", row, covariances, row)) for row in rows)


def needles(rng: np.random.Generator) -> tuple:
    """Return objects around a rig, whose errors are needles that point at it, as in lesson 14."""
    n = int(rng.integers(3, 9))
    range_, azimuth = rng.uniform(1, 6, n), rng.uniform(-np.pi, np.pi, n)
    turns = np.array([rotation_2d(angle) for angle in azimuth])
    along_and_across = np.stack([0.023 * range_**2, 0.005 * range_], axis=1)
    covariances = np.einsum("nij,nj,nkj->nik", turns, along_and_across**2, turns)
    return range_[:, None] * turns[:, :, 0], rng.uniform(-np.pi, np.pi), covariances


# fmt: off
EXERCISES = [
    Exercise("16.1", place_from_heading, lambda rng: (*noisy_points(rng), rng.uniform(-3, 3)), "warm-up", cases={
        "one point": lambda rng: (rng.uniform(-4, 4, (1, 2)), rng.uniform(0, 6, (1, 2)), rng.uniform(-3, 3)),
    }),
    Exercise("16.2", fitted_scale, scaled_points, cases={
        "mirrored points": lambda rng: scaled_points(rng, (1, -1), 4),
        "points on a line": lambda rng: scaled_points(rng, (1, 0)),
    }, example=(([[0, 0], [2, 0]], [[1, 1], [1, 4]]), 1.5)),
    Exercise("16.3", odd_pair, points_with_an_odd_pair, cases={
        "blurred points": lambda rng: points_with_an_odd_pair(rng, 0.7, other_measures_differ),
        "points that fit badly": lambda rng: points_with_an_odd_pair(rng, 0.7, the_one_left_out_decides),
    }),
    Exercise("16.4", fit_weighted, weighted_points, tolerance=1e-4, cases={
        "a pair of weight 0": a_pair_of_weight_0, "nearly half a turn": nearly_half_a_turn,
        "equal weights": lambda rng: (*(points := noisy_points(rng, 3)), np.full(len(points[0]), 3.0)),
        "a wall that looks mirrored": a_wall_that_looks_mirrored,
    }, functions={by_svd_without_sign: "U V^T may be a mirror: the sign of the determinant is missing."},
             example=(([[1, 0], [3, 0], [0, 2]], [[2, 2], [2, 4], [0, 0]], [1, 1, 0]), (2, 1, 1.571))),
    Exercise("16.5", pose_sigmas, needles, "challenge", cases={
        "round errors": lambda rng: (rng.uniform(-2, 6, (5, 2)), rng.uniform(-3, 3), np.tile(np.eye(2), (5, 1, 1))),
        "two points": lambda rng: (rng.uniform(-2, 2, 2) + 3 * np.eye(2), 0.0, np.tile(0.04 * np.eye(2), (2, 1, 1))),
    }),
]
