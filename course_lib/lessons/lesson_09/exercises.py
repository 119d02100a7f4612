"""Exercises of lesson 09: how many particles, the mean of rotations, an honest covariance, a robust fit in 2D."""

from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import rotation_exp, rotation_log, rotation_mean
from course_lib.lessons.kit.exercises import Exercise, Mistake

# 09.1: as dense in more dimensions


def particles_for(n: int, d: int, d_new: int) -> float:
    """How many particles lie as densely in `d_new` dimensions as `n` do in `d`."""
    return float(n) ** (d_new / d)


def _particles(rng: np.random.Generator) -> tuple:
    return int(rng.integers(20, 1000)), int(rng.integers(1, 7)), int(rng.integers(1, 7))


def _example_1(rng: np.random.Generator) -> tuple:
    return 200, 3, 6


def _the_other_way(rng: np.random.Generator) -> tuple:
    return 200, 3, 2


def _the_same_dimension(rng: np.random.Generator) -> tuple:
    return int(rng.integers(20, 1000)), 4, 4


# 09.2: the mean of rotations in their tangent space

_ROUNDS = 20


def mean_rotation(rotations: np.ndarray, w: np.ndarray) -> np.ndarray:
    """The rotation R (3, 3) about which sum w_i Log(R' R_i) is zero."""
    return _iterated(rotations, w, _ROUNDS)


def _iterated(rotations: np.ndarray, w: np.ndarray, rounds: int) -> np.ndarray:
    mean = rotations[0]
    for _ in range(rounds):
        mean = mean @ rotation_exp(w @ rotation_log(mean.T @ rotations))
    return mean


def _rotations(rng: np.random.Generator) -> tuple:
    """Up to eight rotations about a base that looks anywhere, often straight down or backwards."""
    n = int(rng.integers(2, 8))
    pitch = rng.choice([rng.uniform(-1.4, 1.4), np.pi / 2 - 0.05, -np.pi / 2 + 0.05])
    yaw = rng.choice([rng.uniform(-3, 3), np.pi - 0.02])
    base = Rotation.from_euler("ZYX", [yaw, pitch, rng.uniform(-1, 1)])
    apart = rng.standard_normal((n, 3))
    apart *= rng.uniform(0.4, 1.0, (n, 1)) / np.linalg.norm(apart, axis=1, keepdims=True)
    w = rng.uniform(0.2, 1.0, n)
    w[0] *= 3
    return (base * Rotation.from_rotvec(apart)).as_matrix(), w / w.sum()


def _half_a_radian_about_z(rng: np.random.Generator) -> tuple:
    return Rotation.from_rotvec([[0, 0, 0], [0, 0, 1], [0, 0, 1]]).as_matrix(), np.array([0.5, 0.25, 0.25])


def _one_rotation(rng: np.random.Generator) -> tuple:
    return Rotation.from_rotvec([[0.3, -2.0, 1.0]]).as_matrix(), np.ones(1)


def _equal_rotations(rng: np.random.Generator) -> tuple:
    return np.tile(Rotation.from_rotvec([0.1, 0.4, 2.5]).as_matrix(), (4, 1, 1)), np.array([0.4, 0.3, 0.2, 0.1])


def _mean_of_angles(rotations: np.ndarray, w: np.ndarray) -> np.ndarray:
    return Rotation.from_euler("ZYX", w @ Rotation.from_matrix(rotations).as_euler("ZYX")).as_matrix()


def _in_the_worlds_axes(rotations: np.ndarray, w: np.ndarray) -> np.ndarray:
    mean = rotations[0]
    for _ in range(_ROUNDS):
        mean = mean @ rotation_exp(w @ rotation_log(rotations @ mean.T))
    return mean


def _turned_on_the_other_side(rotations: np.ndarray, w: np.ndarray) -> np.ndarray:
    mean = rotations[0]
    for _ in range(_ROUNDS):
        mean = rotation_exp(w @ rotation_log(mean.T @ rotations)) @ mean
    return mean


# 09.3: is a covariance honest?


def honesty(errors: np.ndarray, covariances: np.ndarray) -> tuple[float, float]:
    """Mean of e' C^-1 e / d, and share of all components within three of their own sigma."""
    return _normalized(errors, covariances).mean() / errors.shape[1], np.mean(_in_sigmas(errors, covariances) <= 3)


def _normalized(errors: np.ndarray, covariances: np.ndarray) -> np.ndarray:
    return np.einsum("ti,ti->t", errors, np.linalg.solve(covariances, errors[..., None])[..., 0])


def _variances(covariances: np.ndarray) -> np.ndarray:
    return np.diagonal(covariances, axis1=1, axis2=2)


def _in_sigmas(errors: np.ndarray, covariances: np.ndarray) -> np.ndarray:
    return np.abs(errors) / np.sqrt(_variances(covariances))


def _errors_and_covariances(rng: np.random.Generator) -> tuple:
    """Correlated errors of two to six components in unlike units; some lie beyond three sigma, above and below."""
    t, d = int(rng.integers(5, 12)), int(rng.integers(2, 7))
    roots = rng.standard_normal((t, d, d)) + np.eye(d)
    units = np.geomspace(0.01, 2.0, d)
    covariances = roots @ np.swapaxes(roots, 1, 2) * units[:, None] * units
    errors = np.einsum("tij,tj->ti", roots, rng.standard_normal((t, d))) * units
    far = rng.permutation(t)[:3]
    errors[far, rng.integers(d, size=3)] = np.sqrt(_variances(covariances)[far, 0]) * [4, -4, -5]
    errors[far, 0] = np.sqrt(_variances(covariances)[far, 0]) * [4, -4, -5]
    return errors, covariances


def _example_3(rng: np.random.Generator) -> tuple:
    return np.array([[0.1, 0.0], [0.1, 0.2]]), np.tile(0.01 * np.eye(2), (2, 1, 1))


def _one_component(rng: np.random.Generator) -> tuple:
    return rng.normal(0, 2, (6, 1)), rng.uniform(0.2, 1.0, (6, 1, 1))


def _second_kept(first: Callable) -> Callable:
    return lambda e, c: (first(e, c), honesty(e, c)[1])


def _first_kept(second: Callable) -> Callable:
    return lambda e, c: (honesty(e, c)[0], second(e, c))


# 09.4: a robust fit of points to walls, in the plane


def fit_motion(points: np.ndarray, normals: np.ndarray, offsets: np.ndarray, scale: float) -> np.ndarray:
    """[t_x, t_y, theta] that brings points (n, 2) onto their walls n . x = c, robustly, from no motion at all."""
    return _fitted(points, normals, offsets, scale)


def _fitted(
    points: np.ndarray,
    normals: np.ndarray,
    offsets: np.ndarray,
    scale: float,
    *,
    steps: int = 40,
    power: float = 2.0,
    backwards: bool = False,
    fresh_weights: bool = True,
    turns: bool = True,
    lever_before: bool = False,
) -> np.ndarray:
    motion, w = np.zeros(3), None
    sign = -1.0 if backwards else 1.0
    for _ in range(steps):
        c, s = np.cos(motion[2]), sign * np.sin(motion[2])
        moved = points @ np.array([[c, s], [-s, c]]) + motion[:2]
        r = (normals * moved).sum(axis=1) - offsets
        turned = points if lever_before else points @ np.array([[c, s], [-s, c]])
        turning = sign * (normals * (turned @ np.array([[0, 1], [-1, 0]]))).sum(axis=1)
        jacobian = np.column_stack([normals, turning if turns else 0 * turning])
        if w is None or fresh_weights:
            w = (1 + (r / scale) ** 2) ** -power
        left = jacobian.T @ (w[:, None] * jacobian)
        right = jacobian.T @ (w * r)
        motion = motion - np.linalg.lstsq(left, right, rcond=None)[0]
    return motion


def _points_and_walls(rng: np.random.Generator) -> tuple:
    """Points on three or four walls of a room, seen from nearly the right place, and a person before one of them."""
    walls = int(rng.integers(3, 5))
    angles = rng.uniform(-np.pi, np.pi) + np.pi / 2 * np.arange(walls) + rng.normal(0, 0.05, walls)
    away = rng.uniform(1.5, 4.0, walls)
    which = np.repeat(np.arange(walls), int(rng.integers(8, 14)))
    normals = np.column_stack([np.cos(angles), np.sin(angles)])[which]
    along = np.column_stack([-normals[:, 1], normals[:, 0]])
    offsets = away[which] + rng.normal(0, 0.004, len(which))
    world = offsets[:, None] * normals + rng.uniform(-1.2, 1.5, (len(which), 1)) * along
    person = rng.permutation(len(which))[: len(which) // 6]
    world[person] -= rng.uniform(0.25, 0.7, (len(person), 1)) * normals[person]
    turn, shift = rng.choice([-1, 1]) * np.deg2rad(rng.uniform(1.5, 3.0)), rng.uniform(-0.06, 0.06, 2)
    c, s = np.cos(turn), np.sin(turn)
    points = (world - shift) @ np.array([[c, -s], [s, c]])
    return points, normals, away[which].astype(float), float(rng.choice([0.15, 0.2, 0.25]))


def _example_4(rng: np.random.Generator) -> tuple:
    points = np.array([[2.1, 0.5], [2.1, -0.5], [1.0, 0.0], [0.5, 1.0], [-0.5, 1.0]])
    normals = np.array([[1.0, 0.0]] * 3 + [[0.0, 1.0]] * 2)
    return points, normals, np.array([2.0, 2.0, 2.0, 1.0, 1.0]), 0.1


def _far_turned(rng: np.random.Generator) -> tuple:
    """Fifteen degrees and four decimetres, nobody in the way: the first steps' shifts turn with the later steps."""
    angles = np.repeat(np.deg2rad([10.0, 100.0, 190.0]), 8)
    normals = np.column_stack([np.cos(angles), np.sin(angles)])
    along = np.column_stack([-normals[:, 1], normals[:, 0]])
    world = 3.0 * normals + rng.uniform(-1.2, 1.5, (len(angles), 1)) * along
    c, s = np.cos(np.deg2rad(15)), np.sin(np.deg2rad(15))
    return (world - [0.3, -0.25]) @ np.array([[c, -s], [s, c]]), normals, np.full(len(angles), 3.0), 1.5


def _shifts_never_turned(points: np.ndarray, normals: np.ndarray, offsets: np.ndarray, scale: float) -> np.ndarray:
    """Each step is right about the points where they are; the sum of the steps is not the motion."""
    motion, moved = np.zeros(3), points
    for _ in range(40):
        jacobian = np.column_stack([normals, normals[:, 1] * moved[:, 0] - normals[:, 0] * moved[:, 1]])
        r = (normals * moved).sum(axis=1) - offsets
        w = (1 + (r / scale) ** 2) ** -2.0
        left, right = jacobian.T @ (w[:, None] * jacobian), jacobian.T @ (w * r)
        step = -np.linalg.lstsq(left, right, rcond=None)[0]
        c, s = np.cos(step[2]), np.sin(step[2])
        moved, motion = moved @ np.array([[c, s], [-s, c]]) + step[:2], motion + step
    return motion


EXERCISES = [
    Exercise(
        number="09.1",
        solution=particles_for,
        inputs=_particles,
        cases=(
            _example_1,
            _the_other_way,
            _the_same_dimension,
        ),
        mistakes=(
            Mistake(
                lambda n, d, d_new: float(int(n ** (1 / d))) ** d_new,
                "You cut the d-th root to a whole number: so the spacing changes. Leave all numbers as they come.",
            ),
            Mistake(
                lambda n, d, d_new: float(round(n ** (1 / d))) ** d_new,
                "You round the d-th root: so the spacing changes. Leave all numbers as they come.",
            ),
            Mistake(
                lambda n, d, d_new: float(int(n ** (d_new / d))),
                "You cut the decimals off. Leave the number as it is.",
            ),
            Mistake(
                lambda n, d, d_new: max(float(n), float(n) ** (d_new / d)),
                "In fewer dimensions fewer particles are as dense: the number may be smaller than n.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** (1 / d_new),
                "You take the root of the new dimension: n fill the *old* one. The d-th root, then to the power d_new.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** ((1 / d) ** d_new),
                "a ** b ** c is a ** (b ** c) in Python: set brackets around the d-th root.",
            ),
            Mistake(
                lambda n, d, d_new: n * d_new / d,
                "You multiply by the number of dimensions. Spacing is an edge of a cube: its d-th power is a volume.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** (d / d_new),
                "Your exponent is upside down: more dimensions need more particles, not fewer.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** (d_new - d),
                "Going from 1 dimension to 2 squares the number. Does yours? The exponent is a ratio, no difference.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** d_new,
                "You take n for the number along one axis; it is the number in d dimensions. Take its d-th root first.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** (1 / d) * d_new,
                "The d-th root is right: so many lie along one axis. They fill d_new axes by a power, not a product.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** (-1 / d),
                "That is the spacing, as a share of the width. The task asks for the number that has this spacing.",
            ),
            Mistake(
                lambda n, d, d_new: float(n) ** (d_new // d),
                "// divides without remainder: from 2 dimensions to 3 the exponent is 1.5, not 1.",
            ),
            Mistake(
                lambda n, d, d_new: np.ceil(float(n) ** (d_new / d)),
                "You round to whole particles. Leave the number as it is.",
            ),
            Mistake(
                lambda n, d, d_new: np.rint(float(n) ** (d_new / d)),
                "You round to the nearest whole number. Leave it as it is.",
            ),
        ),
        level="warm-up",
    ),
    Exercise(
        number="09.2",
        solution=mean_rotation,
        inputs=_rotations,
        cases=(
            _half_a_radian_about_z,
            _one_rotation,
            _equal_rotations,
        ),
        mistakes=(
            Mistake(
                lambda rotations, w: mean_rotation(rotations, w).T,
                "Your matrix is transposed: that is the rotation back.",
            ),
            Mistake(
                lambda rotations, w: rotations[0],
                "You give the start back, R_1: the step is never taken.",
            ),
            Mistake(
                lambda rotations, w: rotation_exp(w @ rotation_log(rotations[0].T @ rotations)),
                "That is the first step alone, a turn seen from R_1. Put it onto R_1, and repeat.",
            ),
            Mistake(
                _mean_of_angles,
                "You average roll, pitch and yaw: at a seam or looking straight down that is no mean at all.",
            ),
            Mistake(
                lambda rotations, w: np.tensordot(w, rotations, 1),
                "The mean of matrices is no rotation: its columns are shorter than 1. Average Log(R' R_i) instead.",
            ),
            Mistake(
                lambda rotations, w: rotation_mean(rotations),
                "That is the rotation nearest to the mean matrix, without weights. Let the weighted sum of Log vanish.",
            ),
            Mistake(
                rotation_mean,
                "That is the rotation nearest to the mean matrix (chordal): near, but its sum of w Log is not zero.",
            ),
            Mistake(
                lambda rotations, w: _iterated(rotations, np.full(len(w), 1 / len(w)), _ROUNDS),
                "Your mean lets all count alike: where are the weights?",
            ),
            Mistake(
                lambda rotations, w: _iterated(rotations, w, 1),
                "One round is not enough: from the new R the vectors look different. Repeat until nothing moves.",
            ),
            Mistake(
                lambda rotations, w: rotation_exp(w @ rotation_log(rotations)),
                "You average rotation vectors seen from the identity, which may be far away. Take them seen from R.",
            ),
            Mistake(
                _turned_on_the_other_side,
                "Log(R' R_i) is meant in R's own axes, so the step belongs on the right: R Exp(step).",
            ),
            Mistake(
                _in_the_worlds_axes,
                "Log(R_i R') is a turn in the world's axes. In R's own axes it is Log(R' R_i).",
            ),
            Mistake(
                lambda rotations, w: rotation_log(_iterated(rotations, w, _ROUNDS)),
                "You give back a rotation vector; the task asks for the matrix.",
            ),
        ),
    ),
    Exercise(
        number="09.3",
        solution=honesty,
        inputs=_errors_and_covariances,
        cases=(
            _example_3,
            _one_component,
        ),
        mistakes=(
            Mistake(
                _first_kept(lambda e, c: np.mean(_normalized(e, c) <= 9)),
                "Those are whole images in the ellipsoid of three sigma. Take single errors, each by its own sigma.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.sum(_in_sigmas(e, c) <= 3)),
                "You count the errors within. A share is that count divided by their number, T d.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean(_in_sigmas(e, c) <= 1)),
                "Your limit is one sigma. Three are asked for.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean(e**2 <= 3 * _variances(c))),
                "Squared, the limit is nine variances, not three.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean(np.abs(e) <= 3 * np.sqrt(np.linalg.eigvalsh(c)))),
                "Roots of eigenvalues are sigmas along the ellipsoid's axes. The diagonal has those of the components.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean(e >= -3 * np.sqrt(_variances(c)))),
                "An error of +4 sigma is outside, too: take its absolute value.",
            ),
            Mistake(
                _second_kept(lambda e, c: honesty(e, np.tile(c.mean(axis=0), (len(e), 1, 1)))[0]),
                "You use one mean covariance for all images. Each image has claimed its own.",
            ),
            Mistake(
                _second_kept(lambda e, c: _normalized(e, c).mean()),
                "Your first number grows with the number of components: divide by d.",
            ),
            Mistake(
                _second_kept(lambda e, c: np.mean(e**2 / _variances(c))),
                "You use the diagonal of C alone. Errors that go together need the whole inverse: e' C^-1 e.",
            ),
            Mistake(
                _second_kept(lambda e, c: np.mean(np.einsum("ti,tij,tj->t", e, c, e)) / e.shape[1]),
                "You multiply by C. A large covariance must make the number small: use its inverse.",
            ),
            Mistake(
                _second_kept(lambda e, c: np.sqrt(_normalized(e, c) / e.shape[1]).mean()),
                "You take the root in every image; the mean is of the squares.",
            ),
            Mistake(
                _second_kept(lambda e, c: _normalized(e, c).sum() / e.shape[1]),
                "Your first number grows with the number of images: take the mean over them.",
            ),
            Mistake(
                _second_kept(lambda e, c: _normalized(e, c).mean() / 6),
                "There are not always six components: d is errors.shape[1].",
            ),
            Mistake(
                _second_kept(lambda e, c: np.median(_normalized(e, c)) / e.shape[1]),
                "You take the median over the images; the mean is asked for.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean(np.abs(e) <= 3 * _variances(c))),
                "Sigma is the square root of the variance that stands on the diagonal.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean(e <= 3 * np.sqrt(_variances(c)))),
                "An error of -4 sigma is outside, too: take its absolute value.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean((_in_sigmas(e, c) <= 3).all(axis=1))),
                "You count whole images. Count every component by itself.",
            ),
            Mistake(
                _first_kept(lambda e, c: 100 * honesty(e, c)[1]),
                "Your second number is in percent; a share is between 0 and 1.",
            ),
            Mistake(
                _first_kept(lambda e, c: np.mean(_in_sigmas(e, c) > 3)),
                "You count those outside three sigma. Count those within.",
            ),
        ),
    ),
    Exercise(
        number="09.4",
        solution=fit_motion,
        inputs=_points_and_walls,
        tolerance=1e-4,
        cases=(
            _example_4,
            _far_turned,
        ),
        mistakes=(
            Mistake(
                lambda p, n, c, s: fit_motion(p, n, c, s)[[2, 0, 1]],
                "The values are right, in another order: t_x, t_y, theta.",
            ),
            Mistake(
                lambda p, n, c, s: fit_motion(p, n, c, 1.0),
                "You leave `scale` out: r / scale says what is far.",
            ),
            Mistake(
                lambda p, n, c, s: fit_motion(p, n, c, 0.2),
                "Your scale is always 0.2 m: use the argument.",
            ),
            Mistake(
                lambda p, n, c, s: fit_motion(p, n, c, 0.1),
                "Your scale is always 0.1 m, as in the example: use the argument.",
            ),
            Mistake(
                lambda p, n, c, s: fit_motion(p, n, c, 0.15),
                "Your scale is always 0.15 m, as in the lesson: use the argument.",
            ),
            Mistake(
                _shifts_never_turned,
                "You move the points step by step and add up the steps. A turn also turns the shifts before it: move "
                "the points by the whole motion so far.",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, power=0.0),
                "All points count alike, and the person pulls. Weigh each by 1 / (1 + (r / scale)^2)^2.",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, power=1.0),
                "Your weight is 1 / (1 + (r / scale)^2). The outer square is missing.",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, power=4.0),
                "Your weights count twice, as if squared: use them once, between J' and J, and between J' and r.",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, steps=1),
                "That is the first step. Move the points, compute residuals and weights anew, and step again.",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, fresh_weights=False),
                "You keep the weights of the first step. Compute them from the residuals of every step.",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, backwards=True),
                "Your theta has the wrong sign: it turns clockwise. [cos, -sin] is the first row of R.",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, turns=False),
                "Your points are shifted, never turned: the third column of J is n . (dR/dtheta p).",
            ),
            Mistake(
                lambda p, n, c, s: _fitted(p, n, c, s, lever_before=True),
                "Your dR/dtheta is that of theta = 0. Take it at the theta reached so far, anew in every step.",
            ),
            Mistake(
                lambda p, n, c, s: fit_motion(p, n, c, s) * [1, 1, 180 / np.pi],
                "Your angle is in degrees; give radians.",
            ),
            Mistake(
                lambda p, n, c, s: -fit_motion(p, n, c, s),
                "Signs are turned round: the motion that brings the points onto the walls, not the one back.",
            ),
        ),
        level="challenge",
    ),
]
