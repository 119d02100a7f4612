"""Exercises of lesson 16: a pose with a compass, the scale, the pair that does not fit, weights, error bars."""

from collections.abc import Callable

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake
from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d

# 16.1: the place, with a compass


def place_from_heading(source: np.ndarray, target: np.ndarray, theta: float) -> tuple[float, float]:
    """x, y [m] of the body whose heading theta [rad] is known, from matched points (n, 2): t = m_G - R s_G."""
    x, y = target.mean(axis=0) - _rotation(theta) @ source.mean(axis=0)
    return float(x), float(y)


def _rotation(theta: float) -> np.ndarray:
    return np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])


def _points_and_heading(rng: np.random.Generator) -> tuple:
    source, target = _points(rng)
    return source, target, _angle(source, target)


def _one_point(rng: np.random.Generator) -> tuple:
    """One pair is enough for a place, where the heading is known."""
    return rng.uniform(-4, 4, (1, 2)), rng.uniform(0, 6, (1, 2)), rng.uniform(-np.pi, np.pi)


def _placed(place_of: Callable) -> Callable:
    """A mistake: the place is `place_of(source, target, theta)`."""

    def mistaken(source, target, theta):
        x, y = place_of(source, target, theta)
        return float(x), float(y)

    return mistaken


def _right_place(source, target, theta):
    return target.mean(axis=0) - _rotation(theta) @ source.mean(axis=0)


# The sums of a fit, which 16.2 to 16.5 share


def _sums(a: np.ndarray, b: np.ndarray) -> tuple[float, float]:
    """Sums of the dot and of the cross products."""
    return float(np.sum(a * b)), float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]))


def _angle(source: np.ndarray, target: np.ndarray) -> float:
    dot, cross = _sums(source - source.mean(axis=0), target - target.mean(axis=0))
    return float(np.arctan2(cross, dot))


def _points(rng: np.random.Generator) -> tuple:
    """Noisy points in the body frame and the world, all headings, two points among the numbers."""
    n = 2 if rng.random() < 0.3 else int(rng.integers(3, 9))
    source = rng.uniform(-4, 4, (n, 2)) + rng.uniform(-1, 1, 2)
    theta = rng.uniform(-np.pi, np.pi)
    return source, source @ _rotation(theta).T + rng.uniform(1, 5, 2) + rng.normal(0, 0.1, (n, 2))


# 16.2: the scale


def fitted_scale(source: np.ndarray, target: np.ndarray) -> float:
    """Umeyama's scale c: min over c, R, t of sum |c R s_i + t - m_i|^2."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return float(np.hypot(*_sums(a, b)) / np.sum(a**2))


def _scaled_points(rng: np.random.Generator) -> tuple:
    source, target = _points(rng)
    return source * rng.uniform(0.7, 1.4), target


def _mirrored_points(rng: np.random.Generator) -> tuple:
    """Points that were mirrored: the best rotation fits badly, and the scale is small."""
    source, target = _scaled_points(rng)
    source = np.vstack([source, rng.uniform(-4, 4, (2, 2))])
    return source * [1, -1], np.vstack([target, rng.uniform(1, 5, (2, 2))])


def _points_on_a_line(rng: np.random.Generator) -> tuple:
    source, target = _scaled_points(rng)
    return source * [1, 0], target


def _singular_values(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return float(np.linalg.svd(b.T @ a, compute_uv=False).sum() / np.sum(a**2))


def _spread_ratio(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return float(np.sqrt(np.sum(b**2) / np.sum(a**2)))


def _sums_of(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return a, b, *_sums(a, b)


def _length(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points, axis=1)


def _uncentred(source, target):
    return float(np.hypot(*_sums(source, target)) / np.sum(source**2))


# 16.3: the pair that does not fit


def odd_pair(source: np.ndarray, target: np.ndarray) -> int:
    """Index of the pair without which the fit's sum of squared residuals is least."""
    without = [_left_over(np.delete(source, k, axis=0), np.delete(target, k, axis=0)) for k in range(len(source))]
    return int(np.argmin(without))


def _left_over(source: np.ndarray, target: np.ndarray) -> float:
    return float(np.sum(_residuals(source, target) ** 2))


def _residuals(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    x, y, theta = fit_weighted(source, target, np.ones(len(source)))
    return source @ _rotation(theta).T + [x, y] - target


def _points_with_an_odd_pair(rng: np.random.Generator) -> tuple:
    """Points near each other and an odd one far out, which drags the fit along; at times a right one still farther."""
    while True:
        n = int(rng.integers(5, 8))
        source = rng.uniform(-1, 1, (n, 2))
        k = int(rng.integers(n))
        source[k] = rng.uniform(3, 5) * np.array([1, rng.uniform(-0.3, 0.3)])
        if rng.random() < 0.5:  # else the farthest pair would be the odd one always, and nobody need look at targets
            source[k - 1] = rng.uniform(6, 7) * np.array([-1, rng.uniform(-0.3, 0.3)])
        theta = rng.uniform(-np.pi, np.pi)
        target = source @ _rotation(theta).T + rng.uniform(1, 5, 2) + rng.normal(0, 0.05, (n, 2))
        target[k] += _rotation(theta) @ [0, rng.choice([-1, 1]) * rng.uniform(1.5, 4)]
        try:
            for left_out in range(n):  # the library's fit, which an answer may use, must accept them all
                fit_rigid_2d(np.delete(source, left_out, axis=0), np.delete(target, left_out, axis=0))
        except RigidFitError:
            continue
        return source, target


def _where_they_differ(one: Callable, other: Callable) -> Callable:
    """A case: blurred points, drawn until `one(source, target)` and `other(source, target)` name different pairs."""

    def make(rng: np.random.Generator) -> tuple:
        while True:
            source, target = _points_with_an_odd_pair(rng)
            target = target + rng.normal(0, 0.7, target.shape)
            try:
                if one(source, target) != other(source, target):
                    return source, target
            except RigidFitError:
                continue

    return make


def _worst_left_out(source, target):
    without = [_left_over(np.delete(source, k, axis=0), np.delete(target, k, axis=0)) for k in range(len(source))]
    return int(np.argmax(without))


def _worst_of_one_fit(source, target):
    return int(np.argmax(np.sum(_residuals(source, target) ** 2, axis=1)))


def _moved_most(source, target):
    return int(np.argmax(np.sum((source - target) ** 2, axis=1)))


def _without(judged: Callable, choose: Callable) -> Callable:
    """A mistake: `choose` of `judged(fit without k, source, target, k)` over all k."""

    def mistaken(source, target):
        values = []
        for k in range(len(source)):
            fit = fit_rigid_2d(np.delete(source, k, axis=0), np.delete(target, k, axis=0))
            values.append(judged(fit, source, target, k))
        return choose(values)

    return mistaken


def _best_by(measure: Callable) -> Callable:
    """A mistake: the pair without which `measure` of the residuals' lengths is least."""

    def left(fit, source, target, k):
        return measure(np.linalg.norm(np.delete(fit.apply(source) - target, k, axis=0), axis=1))

    return _without(left, lambda values: int(np.argmin(values)))


def _squares_of_all(fit, source, target, k):
    return np.sum((fit.apply(source) - target) ** 2)


def _by_all_squares(source, target):
    return _without(_squares_of_all, lambda values: int(np.argmin(values)))(source, target)


def _squares_of_rest(fit, source, target, k):
    return np.sum(np.delete((fit.apply(source) - target) ** 2, k, axis=0))


def _own_square(fit, source, target, k):
    return np.sum((fit.apply(source[k : k + 1]) - target[k]) ** 2)


# 16.4: the weighted fit


def fit_weighted(source: np.ndarray, target: np.ndarray, weights: np.ndarray) -> tuple[float, float, float]:
    """x, y, theta that take source (n, 2) to target (n, 2) with the least weighted sum of squares; weights (n,)."""
    return _weighted(source, target, weights)


def _weighted(
    source: np.ndarray,
    target: np.ndarray,
    weights: np.ndarray,
    for_centroids: Callable = lambda w: w,
    for_products: Callable = lambda w: w,
    theta_of: Callable = lambda dot, cross, a, b, w: np.arctan2(cross, dot),
    place_of: Callable = lambda s_g, m_g, theta: m_g - _rotation(theta) @ s_g,
) -> tuple[float, float, float]:
    """The weighted fit, right by default; every argument is a mistake that is made."""
    w_g, w = for_centroids(weights), for_products(weights)
    s_g, m_g = (np.sum(w_g[:, None] * points, axis=0) / w_g.sum() for points in (source, target))
    a, b = source - s_g, target - m_g
    dot, cross = _sums(w[:, None] * a, b)
    theta = float(theta_of(dot, cross, a, b, w))
    x, y = place_of(s_g, m_g, theta)
    return float(x), float(y), theta


def _fitted(**parts: Callable) -> Callable:
    return lambda source, target, weights: _weighted(source, target, weights, **parts)


def _weighted_points(rng: np.random.Generator) -> tuple:
    """Three points or more of unequal noise, with weights that fit it."""
    source, target = _points(rng)
    while len(source) < 3:
        source, target = _points(rng)
    sigma = rng.uniform(0.05, 0.8, len(source))
    return source, target + sigma[:, None] * rng.standard_normal(target.shape), 1 / sigma**2


def _stranger_without_weight(rng: np.random.Generator) -> tuple:
    """A pair far off the others, with weight 0."""
    source, target, weights = _weighted_points(rng)
    return (
        np.vstack([source, rng.uniform(-4, 4, (1, 2))]),
        np.vstack([target, rng.uniform(8, 12, (1, 2))]),
        np.append(weights, 0.0),
    )


def _wall_that_looks_mirrored(rng: np.random.Generator) -> tuple:
    """Objects along a wall, whose noise happens to make a mirror image fit better than any rotation."""
    while True:
        source, theta = np.column_stack([np.linspace(-3, 3, 6), rng.normal(0, 0.05, 6)]), rng.uniform(-np.pi, np.pi)
        target = source @ _rotation(theta).T + rng.uniform(1, 5, 2) + rng.normal(0, 0.05, (6, 2))
        weights = rng.uniform(0.5, 2, 6)
        a, b = (points - weights @ points / weights.sum() for points in (source, target))
        if np.linalg.det((weights[:, None] * b).T @ a) < -0.1:
            return source, target, weights


def _equal_weights(rng: np.random.Generator) -> tuple:
    source, target, weights = _weighted_points(rng)
    return source, target, np.full(len(weights), 3.0)


def _backwards(rng: np.random.Generator) -> tuple:
    """A heading of nearly half a turn."""
    source, _, weights = _weighted_points(rng)
    target = source @ _rotation(np.pi - 0.05).T + rng.uniform(1, 5, 2) + rng.normal(0, 0.02, source.shape)
    return source, target, weights


def _of_first_pair(dot, cross, a, b, w):
    (first_a, first_b) = (points[1] - points[0] for points in (a, b))
    return wrap_angle(np.arctan2(first_b[1], first_b[0]) - np.arctan2(first_a[1], first_a[0]))


def _mean_of_angles(dot, cross, a, b, w):
    turns = wrap_angle(np.arctan2(b[:, 1], b[:, 0]) - np.arctan2(a[:, 1], a[:, 0]))
    return np.sum(w * turns) / np.sum(w)


def _lengths(a, b, w):
    return np.sqrt(np.sum(w[:, None] * a**2) * np.sum(w[:, None] * b**2))


def _arccos(dot, cross, a, b, w):
    return np.arccos(np.clip(dot / _lengths(a, b, w), -1, 1))


def _arcsin(dot, cross, a, b, w):
    return np.arcsin(np.clip(cross / _lengths(a, b, w), -1, 1))


def _with_a_plus(dot, cross, a, b, w):
    return np.arctan2(np.sum(w * (a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0])), dot)


def _by_svd_without_sign(source, target, weights):
    s_g, m_g = (np.sum(weights[:, None] * points, axis=0) / weights.sum() for points in (source, target))
    u, _, vt = np.linalg.svd((weights[:, None] * (target - m_g)).T @ (source - s_g))
    turn = u @ vt
    x, y = m_g - turn @ s_g
    return float(x), float(y), float(np.arctan2(turn[1, 0], turn[0, 0]))


def _plain_centroids_for_the_place(source, target, weights):
    theta = fit_weighted(source, target, weights)[2]
    x, y = target.mean(axis=0) - _rotation(theta) @ source.mean(axis=0)
    return float(x), float(y), theta


def _centroids_not_divided(source, target, weights):
    """The weighted sums divided by the number of pairs, not by the sum of the weights."""
    s_g, m_g = (weights @ points / len(weights) for points in (source, target))
    dot, cross = _sums(weights[:, None] * (source - s_g), target - m_g)
    x, y = m_g - _rotation(float(np.arctan2(cross, dot))) @ s_g
    return float(x), float(y), float(np.arctan2(cross, dot))


def _points_times_weights(source, target, weights):
    return fit_weighted(source * weights[:, None], target * weights[:, None], np.ones(len(weights)))


def _without_zeros(source, target, weights):
    """Pairs of weight 0 go, all others count alike."""
    return fit_weighted(source, target, (weights > 0).astype(float))


def _in_degrees(source, target, weights):
    x, y, theta = fit_weighted(source, target, weights)
    return x, y, float(np.rad2deg(theta))


# 16.5: the error bars of a pose


def pose_sigmas(source: np.ndarray, theta: float, covariances: np.ndarray) -> tuple[float, float, float]:
    """Standard deviations of x, y [m] and theta [rad] of the plain fit, from those of the points, to first order.

    source: true places (n, 2) in the body frame; theta: the heading; covariances (n, 2, 2) of the measured places, body
    frame. d theta = -sum a_i x delta_i / sum |a_i|^2, and d t = -R (mean delta + d theta (-s_Gy, s_Gx)).
    """
    return _sigmas(source, theta, covariances)


def _sigmas(
    source: np.ndarray, theta: float, covariances: np.ndarray, lever: float = 1.0, turned: bool = True, about=None
) -> tuple[float, float, float]:
    n, centre = len(source), source.mean(axis=0)
    a = source - (centre if about is None else about)
    by_point = np.zeros((3, n, 2))  # derivatives of x, y (body axes) and theta by each point's two coordinates
    by_point[2] = -np.column_stack([-a[:, 1], a[:, 0]]) / np.sum(a**2)
    by_point[:2] = -np.eye(2)[:, None, :] / n
    by_point[:2] -= lever * np.array([-centre[1], centre[0]])[:, None, None] * by_point[2]
    if turned:
        by_point[:2] = np.einsum("ij,jnk->ink", _rotation(theta), by_point[:2])
    variances = np.einsum("ink,nkl,inl->i", by_point, covariances, by_point)
    return tuple(float(sigma) for sigma in np.sqrt(variances))


def _needles(rng: np.random.Generator) -> tuple:
    """Objects around a rig whose errors are needles that point at it, as in lesson 14."""
    n = int(rng.integers(3, 9))
    range_, azimuth = rng.uniform(1, 6, n), rng.uniform(-np.pi, np.pi, n)
    ways = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1)
    across = np.stack([-ways[:, 1], ways[:, 0]], axis=1)
    along_sigma, across_sigma = 0.023 * range_**2, 0.005 * range_
    covariances = np.einsum("n,ni,nj->nij", along_sigma**2, ways, ways)
    covariances += np.einsum("n,ni,nj->nij", across_sigma**2, across, across)
    return range_[:, None] * ways, rng.uniform(-np.pi, np.pi), covariances


def _round_errors(rng: np.random.Generator) -> tuple:
    """The lesson's own case: the same round error everywhere."""
    source, theta, _ = _needles(rng)
    return source + np.array([4.0, 0.0]), theta, np.tile(0.01 * np.eye(2), (len(source), 1, 1))


def _two_points(rng: np.random.Generator) -> tuple:
    source = rng.uniform(-2, 2, (1, 2)) + np.array([[3.0, 0.0], [0.0, 2.0]])
    return source, 0.0, np.tile(0.04 * np.eye(2), (2, 1, 1))


def _of_covariances(change: Callable) -> Callable:
    """A mistake: right but for the covariances, each (2, 2) changed by `change`."""
    return lambda source, theta, covariances: _sigmas(source, theta, np.array([change(c) for c in covariances]))


def _along_instead_of_across(source, theta, covariances):
    x, y, _ = pose_sigmas(source, theta, covariances)
    a = source - source.mean(axis=0)
    return x, y, float(np.sqrt(np.einsum("ni,nij,nj->", a, covariances, a)) / np.sum(a**2))


def _averaged(covariances: np.ndarray) -> np.ndarray:
    """Round errors of the mean size of the needles."""
    size = np.trace(covariances, axis1=1, axis2=2).mean() / 2
    return np.tile(size * np.eye(2), (len(covariances), 1, 1))


def _apart(source, theta, covariances):
    """Mean and turn added as if they were independent of each other."""
    n, centre = len(source), source.mean(axis=0)
    in_world = _rotation(theta) @ covariances @ _rotation(theta).T
    of_heading = pose_sigmas(source, theta, covariances)[2]
    arm = _rotation(theta) @ [-centre[1], centre[0]] * of_heading
    x, y = np.hypot(np.sqrt(np.diagonal(in_world.sum(axis=0))) / n, np.abs(arm))
    return float(x), float(y), of_heading


EXERCISES = [
    Exercise(
        number="16.1",
        reference=place_from_heading,
        inputs=_points_and_heading,
        level="warm-up",
        cases=(_one_point, lambda rng: (*_one_point(rng)[:2], np.pi), lambda rng: (*_points(rng), 0.0)),
        mistakes=(
            Mistake(
                _placed(lambda s, t, theta: t.mean() - _rotation(theta) @ s.mean(axis=0)),
                "mean() without an axis is one number, of x and y together. The centroid is a point: mean(axis=0).",
            ),
            Mistake(
                _placed(lambda s, t, theta: len(s) * _right_place(s, t, theta)),
                "You add up what the pairs say. The centroids are means: divide by their number.",
            ),
            Mistake(
                _placed(lambda s, t, theta: np.median(t - s @ _rotation(theta).T, axis=0)),
                "Least squares asks for the mean of what the pairs say, not for their median.",
            ),
            Mistake(
                _placed(lambda s, t, theta: -_right_place(s, t, theta)),
                "Your place has the wrong sign: landmarks minus turned measurements, t = m_G - R s_G.",
            ),
            Mistake(
                _placed(lambda s, t, theta: t.mean(axis=0) - s.mean(axis=0)),
                "The centroid of the source is in the body frame: turn it before you subtract it.",
            ),
            Mistake(
                _placed(lambda s, t, theta: t.mean(axis=0)),
                "That is the centroid of the landmarks. The camera stands at the body frame's origin, not there.",
            ),
            Mistake(
                _placed(lambda s, t, theta: t.mean(axis=0) - _rotation(-theta) @ s.mean(axis=0)),
                "You turn by -theta: check the signs in R, or which side R stands on.",
            ),
            Mistake(
                _placed(lambda s, t, theta: t.mean(axis=0) + _rotation(theta) @ s.mean(axis=0)),
                "Subtract the turned centroid of the source; you add it.",
            ),
            Mistake(
                _placed(lambda s, t, theta: t[0] - _rotation(theta) @ s[0]),
                "That is what the first pair says. All pairs together say it better.",
            ),
            Mistake(
                _placed(lambda s, t, theta: _rotation(theta) @ (t.mean(axis=0) - s.mean(axis=0))),
                "Only the measured centroid is turned. The landmarks are in the world already.",
            ),
            Mistake(
                _placed(lambda s, t, theta: s.mean(axis=0) - _rotation(-theta) @ t.mean(axis=0)),
                "That is where the world's origin lies, seen from the body. Asked is the body in the world.",
            ),
            Mistake(
                _placed(lambda s, t, theta: _right_place(s, t, np.deg2rad(theta))),
                "theta is in radians already.",
            ),
            Mistake(
                _placed(lambda s, t, theta: np.median(t, axis=0) - _rotation(theta) @ np.median(s, axis=0)),
                "Least squares asks for the centroids, which are means, not medians.",
            ),
        ),
    ),
    Exercise(
        number="16.2",
        reference=fitted_scale,
        inputs=_scaled_points,
        cases=(_mirrored_points, _points_on_a_line),
        mistakes=(
            Mistake(
                lambda source, target: 1 / fitted_scale(target, source),
                "You fit the target to the source and turn that around. With noise it is another number.",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: np.mean(_length(b) / _length(a)))(
                    *_sums_of(source, target)
                ),
                "A mean of ratios trusts near points as much as far ones, and noise adds length. Use the sums C and S.",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: _length(b).mean() / _length(a).mean())(
                    *_sums_of(source, target)
                ),
                "A ratio of mean lengths counts noise as size. Use the sums of dot and cross products.",
            ),
            Mistake(
                _singular_values,
                "A sum of singular values lets a mirror fit. With a negative determinant the last one counts minus.",
            ),
            Mistake(
                lambda source, target: 1 / fitted_scale(source, target),
                "That is the inverse: the scale multiplies the source.",
            ),
            Mistake(
                _spread_ratio,
                "The ratio of the spreads counts noise as size. Use the sums of dot and cross products.",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: np.hypot(dot, cross) / np.sum(b**2))(
                    *_sums_of(source, target)
                ),
                "You divide by the spread of the target. The scale belongs to the source.",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: dot / np.sum(a**2))(*_sums_of(source, target)),
                "Dot products alone are right for a heading of 0 only. What is the largest that a rotation makes them?",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: (dot + cross) / np.sum(a**2))(
                    *_sums_of(source, target)
                ),
                "Sums of dot and cross products add as the sides of a right triangle: root of the sum of squares.",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: np.hypot(dot, cross))(*_sums_of(source, target)),
                "The division by the squared spread of the source is missing.",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: np.hypot(dot, cross) / len(a))(
                    *_sums_of(source, target)
                ),
                "You divide by the number of pairs. Divide by the sum of the squared lengths of the source.",
            ),
            Mistake(_uncentred, "Subtract each side's centroid first."),
            Mistake(
                lambda source, target: _spread_ratio(source, target) ** 2,
                "That is the ratio of squared spreads, with noise counted as size. Above stands the root of C² + S².",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: (dot**2 + cross**2) / np.sum(a**2))(
                    *_sums_of(source, target)
                ),
                "The root of the sum of squares is missing above the fraction line.",
            ),
            Mistake(
                lambda source, target: (lambda a, b, dot, cross: np.hypot(dot, cross) / np.linalg.norm(a))(
                    *_sums_of(source, target)
                ),
                "Below stands the sum of the squared lengths itself, without a root.",
            ),
            Mistake(
                lambda source, target: fitted_scale(source, target) / _spread_ratio(source, target),
                "That is a correlation, never above 1. Divide by the squared spread of the source alone.",
            ),
            Mistake(
                lambda source, target: 2 * fitted_scale(source, target),
                "Yours is twice too large: the derivative of c² A - 2 c B is 2 c A - 2 B, and the twos cancel.",
            ),
        ),
    ),
    Exercise(
        number="16.3",
        reference=odd_pair,
        inputs=_points_with_an_odd_pair,
        cases=(
            *(_where_they_differ(odd_pair, _best_by(measure)) for measure in (np.sum, np.max, np.median)),
            _where_they_differ(_worst_left_out, _by_all_squares),
        ),
        mistakes=(
            Mistake(
                _without(_own_square, lambda values: int(np.argmax(values))),
                "You take the pair that is farthest off the fit of the others. Asked is how well these others fit.",
            ),
            Mistake(_best_by(np.sum), "You add the lengths of the residuals. Asked is the sum of their squares."),
            Mistake(_best_by(np.max), "You take the largest residual left. Asked is the sum of all the squares."),
            Mistake(_best_by(np.median), "You take the median of what is left. Asked is the sum of all the squares."),
            Mistake(
                _worst_of_one_fit,
                "The largest residual of the fit to all pairs can be another's: the odd one drags the fit to itself.",
            ),
            Mistake(
                _worst_left_out,
                "Yours is the pair that fits best: without it the fit is worst. Which one's absence makes it best?",
            ),
            Mistake(
                _moved_most,
                "Source and target are in different frames: fit before you compare.",
            ),
            Mistake(
                lambda source, target: odd_pair(source, target) + 1,
                "You count pairs from 1. Python counts from 0.",
            ),
            Mistake(
                lambda source, target: int(np.argmax(np.linalg.norm(source - source.mean(axis=0), axis=1))),
                "That is the pair farthest out, which may be right. Only source and target together tell.",
            ),
            Mistake(
                _by_all_squares,
                "You fit the rest, but sum over all pairs: the residual of the one left out does not belong in it.",
            ),
            Mistake(
                _without(_squares_of_rest, lambda values: float(min(values))),
                "That is the least sum itself. Asked is which pair was left out: np.argmin.",
            ),
            Mistake(
                _without(_squares_of_rest, lambda values: int(np.argmin(values[:-1]))),
                "You never leave out the last pair: range(len(source)) counts up to it.",
            ),
        ),
    ),
    Exercise(
        number="16.4",
        reference=fit_weighted,
        inputs=_weighted_points,
        tolerance=1e-4,
        cases=(
            _stranger_without_weight,
            _backwards,
            _equal_weights,
            _wall_that_looks_mirrored,
        ),
        mistakes=(
            Mistake(
                _plain_centroids_for_the_place,
                "The heading is right. The place needs the *weighted* centroids as well: t = m_G - R s_G.",
            ),
            Mistake(
                _centroids_not_divided,
                "A weighted centroid is the weighted sum divided by the sum of the *weights*, not by n.",
            ),
            Mistake(
                _points_times_weights,
                "You multiply the points by their weights, which moves them. Weigh the squares, not the places.",
            ),
            Mistake(
                _without_zeros,
                "You leave out pairs of weight 0 and count all others alike: the other weights matter, too.",
            ),
            Mistake(
                lambda source, target, weights: fit_weighted(source, target, 1 / np.maximum(weights, 1e-9)),
                "You divide by the weights. A large weight means: count this pair more.",
            ),
            Mistake(
                lambda source, target, weights: fit_weighted(source, target, np.ones(len(source))),
                "Your fit counts every pair alike: the weights are not used.",
            ),
            Mistake(
                _fitted(for_centroids=np.ones_like),
                "The centroids are weighted, too: a pair of weight 0 must not move them.",
            ),
            Mistake(
                _fitted(for_products=np.ones_like),
                "The centroids are weighted, but the dot and cross products are not.",
            ),
            Mistake(
                lambda source, target, weights: fit_weighted(source, target, weights**2),
                "Your weights come in twice, as w squared: once in each sum is enough.",
            ),
            Mistake(
                lambda source, target, weights: fit_weighted(source, target, np.sqrt(weights)),
                "You weigh with the root. In the sum of squares the weight stands as it is.",
            ),
            Mistake(
                _fitted(theta_of=lambda dot, cross, a, b, w: -np.arctan2(cross, dot)),
                "Your rotation goes the wrong way: the cross product is a_x b_y - a_y b_x.",
            ),
            Mistake(
                _fitted(place_of=lambda s_g, m_g, theta: m_g - s_g),
                "The heading is right. But the centroid of the source must be turned before it is subtracted.",
            ),
            Mistake(
                _fitted(place_of=lambda s_g, m_g, theta: m_g - _rotation(-theta) @ s_g),
                "The heading is right. You turn the centroid of the source by -theta: check the signs in R.",
            ),
            Mistake(
                _fitted(place_of=lambda s_g, m_g, theta: m_g + _rotation(theta) @ s_g),
                "The heading is right. Subtract the turned centroid of the source; you add it.",
            ),
            Mistake(_fitted(theta_of=_of_first_pair), "You use the first two pairs only. Sum over all of them."),
            Mistake(
                _fitted(theta_of=_mean_of_angles),
                "A mean of angles fails at the wrap, and lets near points count as much as far ones. Sum the products.",
            ),
            Mistake(
                _fitted(theta_of=lambda dot, cross, a, b, w: np.arctan(cross / dot)),
                "arctan knows half of the circle only. Use arctan2(cross, dot).",
            ),
            Mistake(
                _fitted(theta_of=_arccos),
                "An arccosine loses the sign of the turn, and noise makes its cosine too small. Two sums, and arctan2.",
            ),
            Mistake(
                _fitted(theta_of=_arcsin),
                "An arcsine knows no turn beyond a quarter, and noise makes its sine too small. Two sums, and arctan2.",
            ),
            Mistake(
                lambda source, target, weights: fit_weighted(target, source, weights),
                "That takes the world to the body. Asked is the pose: from the body to the world.",
            ),
            Mistake(_in_degrees, "Give theta in radians."),
            Mistake(
                _fitted(theta_of=lambda dot, cross, a, b, w: wrap_angle(np.arctan2(dot, cross))),
                "np.arctan2 takes the cross product first, then the dot product.",
            ),
            Mistake(_fitted(theta_of=_with_a_plus), "The cross product has a minus: a_x b_y - a_y b_x."),
            Mistake(
                _fitted(theta_of=lambda dot, cross, a, b, w: np.arctan2(cross, dot) % (2 * np.pi)),
                "The pose is right, but give theta from -pi to pi, as np.arctan2 does.",
            ),
            Mistake(
                _by_svd_without_sign,
                "U V^T may be a mirror, which turns the pose round: the sign of the determinant is missing.",
            ),
        ),
    ),
    Exercise(
        number="16.5",
        reference=pose_sigmas,
        inputs=_needles,
        level="challenge",
        cases=(
            _round_errors,
            _two_points,
        ),
        mistakes=(
            Mistake(
                _of_covariances(lambda c: np.diag(np.diag(c))),
                "You use the variances alone. A needle's x and y err together: take the whole matrix.",
            ),
            Mistake(
                _of_covariances(lambda c: np.trace(c) / 2 * np.eye(2)),
                "You make each needle round. Which way it points decides how much it turns the fit.",
            ),
            Mistake(
                _along_instead_of_across,
                "Your heading takes the errors *along* the line to the centroid. Only those across it turn the fit.",
            ),
            Mistake(
                lambda source, theta, covariances: pose_sigmas(source, -theta, covariances),
                "You turn by -theta from the body to the world: check the signs in R.",
            ),
            Mistake(
                lambda source, theta, covariances: pose_sigmas(source, theta, _averaged(covariances)),
                "You take all errors for round and alike. Only the part across the line to the centroid turns the fit.",
            ),
            Mistake(
                lambda source, theta, covariances: _sigmas(source, theta, covariances, lever=0.0),
                "Only the centroid's error is in your place. A wrong heading swings the camera around it: the lever.",
            ),
            Mistake(
                _apart,
                "The centroid's error and the heading's come from the same points: add the derivatives, then square.",
            ),
            Mistake(
                lambda source, theta, covariances: _sigmas(source, theta, covariances, turned=False),
                "Your x and y are along the body's axes. The pose is in the world: turn by theta.",
            ),
            Mistake(
                lambda source, theta, covariances: _sigmas(source, theta, covariances, lever=-1.0),
                "The lever's sign: when the fit turns left, the camera moves to the other side than you say.",
            ),
            Mistake(
                lambda source, theta, covariances: tuple(v**2 for v in pose_sigmas(source, theta, covariances)),
                "These are variances; asked are standard deviations.",
            ),
            Mistake(
                lambda source, theta, covariances: (
                    *pose_sigmas(source, theta, covariances)[:2],
                    float(np.rad2deg(pose_sigmas(source, theta, covariances)[2])),
                ),
                "The last one is in degrees; give radians.",
            ),
            Mistake(
                lambda source, theta, covariances: _sigmas(source, theta, covariances, about=np.zeros(2)),
                "The turn is about the centroid: take the points' places from there, not from the camera.",
            ),
        ),
    ),
]
