"""Exercises of lesson 16: a pose with a compass, the scale, the pair that does not fit, weights, error bars."""

import numpy as np

from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d, rotation_2d
from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        R @ source => R.T @ source
        You turn by -theta. Check the signs in R, or on which side R stands.
        R @ source.mean => source.mean
        The centroid of the source is in the body frame. Turn it before you subtract it.
        target.mean(axis=0) - R @ source.mean(axis=0) => R @ (target.mean(axis=0) - source.mean(axis=0))
        The task asks for the place in the world. So turn the source, not the target or the difference.
        target.mean(axis=0) - R @ source.mean(axis=0) => target[0] - R @ source[0]
        You use the first pair only. The least squares are those of all pairs: take the centroids.
        mean(axis=0) => sum(axis=0)
        You add up what the pairs say. The centroids are means: divide by their number.
        np.cos(theta), -np.sin(theta) => np.cos(theta), np.sin(theta)
        One sign in R makes it no rotation: its determinant must be 1.
        mean(axis=0) - R => mean() - R
        A centroid has two coordinates. Take the mean over the points, not over all numbers.
    """),
    Exercise("16.2", fitted_scale, scaled_points, cases={
        "mirrored points": lambda rng: scaled_points(rng, (1, -1), 4),
        "points on a line": lambda rng: scaled_points(rng, (1, 0)),
    }, mistakes="""
        ... => return 1 / fitted_scale(target, source)
        You fit the target to the source and turn that around. With noise it is another number.
        np.hypot(dot, cross) / np.sum(a**2) => np.mean(np.linalg.norm(b, axis=1) / np.linalg.norm(a, axis=1))
        np.hypot(dot, cross) / np.sum(a**2) => np.sqrt(np.sum(b**2) / np.sum(a**2))
        A ratio of lengths or spreads counts noise as size. Use the sums C and S of dot and cross products.
        np.hypot(dot, cross) => np.linalg.svd(b.T @ a, compute_uv=False).sum()
        A sum of singular values lets a mirror fit. With a negative determinant the last one counts minus.
        ... => return 1 / fitted_scale(source, target)
        That is the inverse: the scale multiplies the source.
        np.sum(a**2) => np.sum(b**2)
        You divide by the spread of the target. The scale belongs to the source.
        np.hypot(dot, cross) => dot
        Dot products alone are right for a heading of 0 only. What is the largest that a rotation makes them?
        np.hypot(dot, cross) => (dot + cross)
        Sums of dot and cross products add as the sides of a right triangle: root of the sum of squares.
        a, b = source - source.mean(axis=0), target - target.mean(axis=0) => a, b = source, target
        Subtract each side's centroid first.
    """),
    Exercise("16.3", odd_pair, points_with_an_odd_pair, cases={
        "blurred points": lambda rng: points_with_an_odd_pair(rng, 0.7, other_measures_differ),
        "points that fit badly": lambda rng: points_with_an_odd_pair(rng, 0.7, the_one_left_out_decides),
    }, mistakes="""
        apply(s) - m) => apply(source[k : k + 1]) - target[k]) and also argmin => argmax
        You take the pair that is farthest off the fit of the others. How well do these others fit?
        ... => return best_by(source, target, np.sum)
        ... => return best_by(source, target, np.max)
        The task asks for the sum of the squares of all that is left: not of the lengths, and not the largest.
        ... => return int(np.argmax(np.sum((fit_rigid_2d(source, target).apply(source) - target) ** 2, axis=1)))
        The largest residual of the fit to all pairs can be another's, because the odd one drags the fit to itself.
        argmin => argmax
        Yours is the pair that fits best: without it the fit is worst. Which one's absence makes it best?
        ... => return int(np.argmax(np.sum((source - target) ** 2, axis=1)))
        Source and target are in different frames. Fit before you compare.
        ... => return int(np.argmax(np.linalg.norm(source - source.mean(axis=0), axis=1)))
        That is the pair farthest out, which may be right. Only source and target together tell.
        ... => return best_by(source, target, lambda off: off @ off, of_all=True)
        You fit the rest, but sum over all pairs. The residual of the one left out does not belong in the sum.
        int(np.argmin(left_over)) => min(left_over)
        That is the least sum itself. The task asks which pair was left out: np.argmin.
    """),
    Exercise("16.4", fit_weighted, weighted_points, tolerance=1e-4, cases={
        "a pair of weight 0": a_pair_of_weight_0, "nearly half a turn": nearly_half_a_turn,
        "equal weights": lambda rng: (*(points := noisy_points(rng, 3)), np.full(len(points[0]), 3.0)),
        "a wall that looks mirrored": a_wall_that_looks_mirrored,
    }, functions={by_svd_without_sign: "U V^T may be a mirror: the sign of the determinant is missing."}, mistakes="""
        m_G - R @ s_G => target.mean(axis=0) - R @ source.mean(axis=0)
        The heading is right. The place needs the *weighted* centroids as well: t = m_G - R s_G.
        / weights.sum() => / len(weights)
        A weighted centroid is the weighted sum divided by the sum of the *weights*, not by n.
        ... => return fit_weighted(source, target, np.ones(len(source)))
        Your fit counts every pair alike. A pair of a larger weight must count more.
        ... => return fit_weighted(source, target, 1 / np.maximum(weights, 1e-9))
        You divide by the weights. A large weight means that the pair counts more.
        weights @ points / weights.sum() => points.mean(axis=0)
        The centroids are weighted, too: a pair of weight 0 must not move them.
        theta = np.arctan2(weights @ => w = np.ones(len(a)); theta = np.arctan2(w @ and also , weights @ => , w @
        The centroids are weighted, but the dot and cross products are not.
        ... => return fit_weighted(source, target, weights**2)
        Each weight stands once, as it is, in front of a square: not w squared, its root, or on the points.
        m_G - R @ s_G => m_G - s_G
        The heading is right. The place is the target's centroid minus the source's, turned by theta.
        return x, y, theta => return x, y, theta % (2 * np.pi)
        The pose is right, but give theta from -pi to pi, as np.arctan2 does.
        weights @ (a[:, 0] => weights**2 @ (a[:, 0] and also weights @ np.sum => weights**2 @ np.sum
        Each pair's weight enters the sums squared: you multiply both sides by it. It belongs to the product once.
    """),
    Exercise("16.5", pose_sigmas, needles, "challenge", cases={
        "round errors": lambda rng: (rng.uniform(-2, 6, (5, 2)), rng.uniform(-3, 3), np.tile(np.eye(2), (5, 1, 1))),
        "two points": lambda rng: (rng.uniform(-2, 2, 2) + 3 * np.eye(2), 0.0, np.tile(0.04 * np.eye(2), (2, 1, 1))),
    }, mistakes="""
        covariances, row) => np.array([np.diag(np.diag(c)) for c in covariances]), row)
        You use the variances alone. But a needle's x and y err together: take the whole matrix.
        covariances, row) => np.array([np.trace(c) / 2 * np.eye(2) for c in covariances]), row)
        You make each needle round. Its direction decides how much it turns the fit.
        a[:, 1], -a[:, 0]] => a[:, 0], a[:, 1]]
        Your heading takes the errors *along* the line to the centroid. Only those across it turn the fit.
        np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y => x, y
        Your x and y are along the body's axes. The pose is in the world: turn by theta.
        x - np.sin(theta) * y => x + np.sin(theta) * y and also np.sin(theta) * x => -np.sin(theta) * x
        You turn by -theta from the body to the world: check the signs in R.
        rows = => covariances = rotation_2d(theta) @ covariances @ rotation_2d(theta).T; rows =
        You turn the covariances to the world, but the points are in the body frame. Turn the result, once.
        + s_y * turn => and also - s_x * turn =>
        Only the centroid's error is in your place. A wrong heading swings the camera around it: the lever.
        + s_y * turn => - s_y * turn and also - s_x * turn => + s_x * turn
        The lever has the wrong sign: when the fit turns left, the camera moves to the other side.
        a = source - [s_x, s_y] => a = source
        The turn is about the centroid. Take the points' places from there, not from the camera.
        np.sqrt(np.einsum("ni,nij,nj->", row, covariances, row)) => np.einsum("ni,nij,nj->", row, covariances, row)
        These are variances. The task asks for standard deviations.
    """),
]
