"""Exercises of lesson 16: the fit in a few lines, the scale it leaves out, the pair that does not fit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.exercises import Exercise, Mistake
from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d

# 16.1: the pose


def fit_pose(source: np.ndarray, target: np.ndarray) -> tuple:
    """x, y, theta that take source (n, 2) to target (n, 2) with the least sum of squares."""
    theta = _angle(source, target)
    x, y = target.mean(axis=0) - _rotation(theta) @ source.mean(axis=0)
    return float(x), float(y), float(theta)


def _rotation(theta: float) -> np.ndarray:
    return np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])


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


def _posed(theta_of: Callable, place_of: Callable) -> Callable:
    """A mistake: theta from `theta_of(source, target)`, the place from `place_of(source, target, theta)`."""

    def mistaken(source, target):
        theta = theta_of(source, target)
        x, y = place_of(source, target, theta)
        return float(x), float(y), float(theta)

    return mistaken


def _right_place(source, target, theta):
    return target.mean(axis=0) - _rotation(theta) @ source.mean(axis=0)


def _about_the_origin(source, target):
    dot, cross = _sums(source, target)
    return np.arctan2(cross, dot)


def _of_first_pair(source, target):
    a, b = (points[1] - points[0] for points in (source, target))
    return wrap_angle(np.arctan2(b[1], b[0]) - np.arctan2(a[1], a[0]))


def _mean_of_angles(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return np.mean(wrap_angle(np.arctan2(b[:, 1], b[:, 0]) - np.arctan2(a[:, 1], a[:, 0])))


def _half_plane(source, target):
    dot, cross = _sums(source - source.mean(axis=0), target - target.mean(axis=0))
    return np.arctan(cross / dot)


def _with_a_plus(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return np.arctan2(np.sum(a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0]), np.sum(a * b))


def _about_one_number(source, target):
    dot, cross = _sums(source - source.mean(), target - target.mean())
    return np.arctan2(cross, dot)


def _by_svd_without_sign(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    u, _, vt = np.linalg.svd(b.T @ a)
    turn = u @ vt
    x, y = target.mean(axis=0) - turn @ source.mean(axis=0)
    return float(x), float(y), float(np.arctan2(turn[1, 0], turn[0, 0]))


def _inverse(source, target):
    return fit_pose(target, source)


def _in_degrees(source, target):
    x, y, theta = fit_pose(source, target)
    return x, y, float(np.rad2deg(theta))


# 16.2: the scale


def fitted_scale(source: np.ndarray, target: np.ndarray) -> float:
    """Umeyama's scale c: min over c, R, t of sum |c R s_i + t - m_i|^2."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return float(np.hypot(*_sums(a, b)) / np.sum(a**2))


def _scaled_points(rng: np.random.Generator) -> tuple:
    source, target = _points(rng)
    return source * rng.uniform(0.7, 1.4), target


def _spread_ratio(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return float(np.sqrt(np.sum(b**2) / np.sum(a**2)))


def _sums_of(source, target):
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    return a, b, *_sums(a, b)


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
    x, y, theta = fit_pose(source, target)
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


def _squares_of_all(fit, source, target, k):
    return np.sum((fit.apply(source) - target) ** 2)


def _squares_of_rest(fit, source, target, k):
    return np.sum(np.delete((fit.apply(source) - target) ** 2, k, axis=0))


EXERCISES = [
    Exercise(
        number="16.1",
        reference=fit_pose,
        inputs=_points,
        mistakes=(
            Mistake(
                _posed(lambda s, t: -_angle(s, t), _right_place),
                "Your rotation goes the wrong way: the cross product is a_x b_y - a_y b_x.",
            ),
            Mistake(
                _posed(_angle, lambda s, t, theta: t.mean(axis=0) - s.mean(axis=0)),
                "The heading is right. But the centroid of the source must be turned before it is subtracted.",
            ),
            Mistake(
                _posed(_angle, lambda s, t, theta: t.mean(axis=0)),
                "That is the centroid of the landmarks. The camera stands at the body frame's origin, not there.",
            ),
            Mistake(
                _posed(_angle, lambda s, t, theta: t.mean(axis=0) - _rotation(-theta) @ s.mean(axis=0)),
                "The heading is right. You turn the centroid of the source by -theta: check the signs in R.",
            ),
            Mistake(
                _posed(_about_the_origin, _right_place),
                "Subtract each side's centroid before the dot and cross products.",
            ),
            Mistake(
                _posed(_of_first_pair, _right_place),
                "You use the first two pairs only. Sum over all of them.",
            ),
            Mistake(
                _posed(_mean_of_angles, _right_place),
                "A mean of angles fails at the wrap, and lets near points count as much as far ones. Sum the products.",
            ),
            Mistake(
                _posed(_half_plane, _right_place),
                "arctan knows half of the circle only. Use arctan2(cross, dot).",
            ),
            Mistake(_inverse, "That takes the world to the body. Asked is the pose: from the body to the world."),
            Mistake(_in_degrees, "Give theta in radians."),
            Mistake(
                _posed(lambda s, t: wrap_angle(np.pi / 2 - _angle(s, t)), _right_place),
                "np.arctan2 takes the cross product first, then the dot product.",
            ),
            Mistake(
                _posed(_angle, lambda s, t, theta: t.mean(axis=0) + _rotation(theta) @ s.mean(axis=0)),
                "The heading is right. Subtract the turned centroid of the source; you add it.",
            ),
            Mistake(
                _posed(_angle, lambda s, t, theta: t[0] - _rotation(theta) @ s[0]),
                "The heading is right. The place comes from the centroids, not from the first pair alone.",
            ),
            Mistake(
                _posed(_with_a_plus, _right_place),
                "The cross product has a minus: a_x b_y - a_y b_x.",
            ),
            Mistake(
                _posed(_about_one_number, _right_place),
                "source.mean() is one number, of x and y together. The centroid is a point: mean over axis 0.",
            ),
            Mistake(
                _posed(lambda s, t: _angle(s, t) % (2 * np.pi), _right_place),
                "The pose is right, but give theta from -pi to pi, as np.arctan2 does.",
            ),
            Mistake(
                _by_svd_without_sign,
                "U V^T may be a mirror, which turns the pose round: the sign of the determinant is missing.",
            ),
        ),
    ),
    Exercise(
        number="16.2",
        reference=fitted_scale,
        inputs=_scaled_points,
        mistakes=(
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
        mistakes=(
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
                _without(_squares_of_all, lambda values: int(np.argmin(values))),
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
]
