"""Exercises of lesson 09: how many particles, the mean of rotations, an honest covariance, a robust fit in 2D."""

import numpy as np
from scipy.spatial.transform import Rotation

from course_lib.geometry import rotation_exp, rotation_log
from courseware.lessons.kit.exercises import Exercise
from courseware.lessons.kit.values import agree, as_numbers


def particles_for(n, d, d_new):
    """Number of particles that lie as densely in d_new dimensions as n do in d."""
    # n ** (1 / d) along an edge, and as many along each of d_new edges.
    return (n ** (1 / d)) ** d_new


def mean_rotation(rotations, w):
    """The rotation R (3, 3) with sum_i w_i Log(R' R_i) = 0."""
    # Where am I pulled, seen from here? Go there; look again.
    R = rotations[0]
    for _ in range(20):
        R = R @ rotation_exp(w @ rotation_log(R.T @ rotations))
    return R


def weighted_rotations(rng):
    """Two to seven rotations about a base that looks anywhere, often straight down or backwards."""
    n = int(rng.integers(2, 8))
    pitch = rng.choice([rng.uniform(-1.4, 1.4), np.pi / 2 - 0.05, -np.pi / 2 + 0.05])
    yaw = rng.choice([rng.uniform(-3, 3), np.pi - 0.02])
    base = Rotation.from_euler("ZYX", [yaw, pitch, rng.uniform(-1, 1)])
    apart = rng.standard_normal((n, 3))
    apart *= rng.uniform(0.4, 1.0, (n, 1)) / np.linalg.norm(apart, axis=1, keepdims=True)
    w = rng.uniform(0.2, 1.0, n) * np.where(np.arange(n), 1, 3)
    return (base * Rotation.from_rotvec(apart)).as_matrix(), w / w.sum()


def unbalanced(given, R):
    """Return what is wrong with a mean rotation: its shape, its columns, or the vectors to all others seen from it."""
    if agree(R, mean_rotation(*given), 1e-6):
        return None
    if (R := as_numbers(R)) is None or R.shape != (3, 3):
        return "The result must be a matrix of shape (3, 3)."
    if not np.allclose(R.T @ R, np.eye(3), atol=1e-6):
        return "Your matrix is no rotation: its columns must have length 1 and stand at right angles."
    return "Seen from your R the vectors do not balance: which rotation is turned back, and on which side do you step?"


def honesty(errors, covariances):
    """Mean normalized squared error, and share of single errors within three sigma."""
    # Image by image; solve instead of inverting; sigma is a square root.
    squared, within = [], []
    for e, C in zip(errors, covariances, strict=True):
        squared.append(e @ np.linalg.solve(C, e) / len(e))
        within.append(np.abs(e) <= 3 * np.sqrt(np.diag(C)))
    return np.mean(squared), np.mean(within)


def errors_and_covariances(rng):
    """Correlated errors of two to six components in unlike units; some lie beyond three sigma, above and below."""
    t, d = int(rng.integers(5, 12)), int(rng.integers(2, 7))
    roots, units = rng.standard_normal((t, d, d)) + np.eye(d), np.geomspace(0.01, 2.0, d)
    covariances = roots @ np.swapaxes(roots, 1, 2) * units[:, None] * units
    errors = np.einsum("tij,tj->ti", roots, rng.standard_normal((t, d))) * units
    far = rng.permutation(t)[:3]
    for column in (rng.integers(d, size=3), 0):
        errors[far, column] = np.sqrt(covariances[far, 0, 0]) * [4, -4, -5]
    return errors, covariances


def fit_motion(points, normals, offsets, scale):
    """[t_x, t_y, theta] that brings points (n, 2) onto their walls n . x = c, robustly."""
    # Move, residuals, derivatives, weights, solve; again.
    motion = np.zeros(3)
    for _ in range(40):
        c, s = np.cos(motion[2]), np.sin(motion[2])
        R, dR = np.array([[c, -s], [s, c]]), np.array([[-s, -c], [c, -s]])
        r = np.sum(normals * (points @ R.T + motion[:2]), axis=1) - offsets
        J = np.column_stack([normals, np.sum(normals * (points @ dR.T), axis=1)])
        w = 1 / (1 + (r / scale) ** 2) ** 2
        motion = motion - np.linalg.solve(J.T @ (w[:, None] * J), J.T @ (w * r))
    return motion


def walls_at(angles, offsets, rng, shift, turn, before=0.0):
    """Points (n, 2), one on each wall or so far before it, as seen after a shift and a turn; the normals (n, 2)."""
    normals = np.column_stack([np.cos(angles), np.sin(angles)])
    along = rng.uniform(-1.2, 1.5, (len(angles), 1)) * normals[:, ::-1] * [-1, 1]
    c, s = np.cos(turn), np.sin(turn)
    return ((offsets - before)[:, None] * normals + along - shift) @ np.array([[c, -s], [s, c]]), normals


def points_on_walls(rng):
    """Points on three or four walls of a room, seen from nearly the right place, and a person before one of them."""
    walls, scale = int(rng.integers(3, 5)), float(rng.choice([0.15, 0.2, 0.25]))
    which = np.repeat(np.arange(walls), int(rng.integers(8, 14)))
    angles = rng.uniform(-np.pi, np.pi) + np.pi / 2 * np.arange(walls) + rng.normal(0, 0.05, walls)
    away, before = rng.uniform(1.5, 4.0, walls)[which], rng.normal(0, 0.004, len(which))
    person = rng.permutation(len(which))[: len(which) // 6]
    before[person] += rng.uniform(0.25, 0.7, len(person))
    turn = rng.choice([-1, 1]) * np.deg2rad(rng.uniform(1.5, 3.0))
    return *walls_at(angles[which], away, rng, rng.uniform(-0.06, 0.06, 2), turn, before), away, scale


def a_large_turn(rng):
    """Fifteen degrees and four decimetres, nobody in the way: the first steps' shifts turn with the later steps."""
    angles, offsets = np.repeat(np.deg2rad([10.0, 100.0, 190.0]), 8), np.full(24, 3.0)
    return *walls_at(angles, offsets, rng, [0.3, -0.25], np.deg2rad(15)), offsets, 1.5


# fmt: off
EXERCISES = [
    Exercise("09.1", particles_for, lambda rng: tuple(rng.integers([20, 1, 1], [1000, 7, 7]).tolist()), "warm-up", {
        "fewer dimensions": lambda rng: (200, 3, 2),
        "the same dimension": lambda rng: (int(rng.integers(20, 1000)), 4, 4),
    }, mistakes="""
        n ** (1 / d) => int(n ** (1 / d))
        You make the d-th root a whole number, so the spacing changes. Leave all numbers as they come.
        ... => return int(n ** (d_new / d))
        You make it a whole number of particles. Leave the number as it is.
        ... => return n ** (1 / d_new)
        You take the root of the new dimension, but n fill the *old* one. Take the d-th root, then the power d_new.
        (n ** (1 / d)) ** d_new => n ** (1 / d) ** d_new
        a ** b ** c is a ** (b ** c) in Python: set brackets around the d-th root.
        (n ** (1 / d)) ** d_new => n ** (1 / d) * d_new
        You multiply by d_new. n ** (1 / d) lie along one edge; they fill d_new edges by a power, not a product.
        ... => return n ** (d / d_new)
        Your exponent is upside down: more dimensions need more particles, not fewer.
        ... => return n ** (d_new - d)
        From 1 dimension to 2 the number is squared, from 2 to 3 the exponent is 1.5: it is a ratio.
        ... => return n ** d_new
        You take n for the number along one axis. It is the number in d dimensions: take its d-th root first.
    """),
    Exercise("09.2", mean_rotation, weighted_rotations, verify=unbalanced, cases={
        "one rotation": lambda rng: (Rotation.from_rotvec([[0.3, -2.0, 1.0]]).as_matrix(), np.ones(1)),
        "equal rotations": lambda rng: (Rotation.from_rotvec([[0.1, 0.4, 2.5]] * 4).as_matrix(), np.arange(1, 5) / 10),
    }, mistakes="""
        return R => return R.T
        Your matrix is transposed: it is the rotation back.
        range(20) => range(1)
        One round is not enough: from the new R the vectors look different. Repeat until nothing moves.
        R = R @ rotation_exp => S = rotation_exp and also rotations)) => rotations)); R = S @ R
        Log(R' R_i) is meant in R's own axes, so the step belongs on the right: R Exp(step).
        R.T @ rotations => rotations @ R.T
        Log(R_i R') is a turn in the world's axes. In R's own axes it is Log(R' R_i).
        R.T @ rotations => R @ rotations
        R R_i is no difference of two rotations: where R_i = R it must be the identity. Which of them is turned back?
        R = rotations[0] => R = rotations[0]; w = np.full(len(w), 1 / len(w))
        All rotations count alike in your mean: where are the weights?
        ... => return np.tensordot(w, rotations, 1)
        The mean of matrices is no rotation: its columns are shorter than 1. Average Log(R' R_i) instead.
        ... => return Rotation.from_matrix(rotations).mean(w).as_matrix()
        You give the rotation nearest to the mean matrix (chordal). It is near, but its sum of w Log is not zero.
        ... => return rotation_exp(w @ rotation_log(rotations))
        You average rotation vectors seen from the identity, which may be far away. Take them seen from R.
        ... => return Rotation.from_euler("ZYX", w @ Rotation.from_matrix(rotations).as_euler("ZYX")).as_matrix()
        You average roll, pitch and yaw. At a seam, or if you look straight down, this is no mean at all.
    """),
    Exercise("09.3", honesty, errors_and_covariances, cases={
        "one component": lambda rng: (rng.normal(0, 2, (6, 1)), rng.uniform(0.2, 1.0, (6, 1, 1))),
    }, mistakes="""
        np.abs(e) <= 3 * np.sqrt(np.diag(C)) => np.all(np.abs(e) <= 3 * np.sqrt(np.diag(C)))
        You count whole images. Count every component by itself, each by its own sigma.
        3 * np.sqrt => np.sqrt
        Your limit is one sigma. The task asks for three.
        np.abs(e) <= => e <=
        An error of +4 sigma is outside, and so is one of -4 sigma: take its absolute value.
        <= 3 => > 3
        You count the errors outside three sigma. Count the others.
        solve(C, e) => solve(covariances.mean(axis=0), e)
        You use one mean covariance for all images. Each image has claimed its own.
        e @ np.linalg.solve(C, e) / len(e) => np.mean(e**2 / np.diag(C))
        You use the diagonal of C alone. Errors that go together need the whole inverse: e' C^-1 e.
        np.linalg.solve(C, e) => C @ e
        You multiply by C. A large covariance must make the number small: use its inverse.
        / len(e) =>
        Your first number grows with the number of components: divide by d, which is errors.shape[1].
        np.mean(within) => 100 * np.mean(within)
        Your second number is in percent. Give a share between 0 and 1.
    """),
    Exercise("09.4", fit_motion, points_on_walls, "challenge", tolerance=1e-4, cases={
        "two walls and a person": lambda rng: (np.array([[2.1, 0.5], [2.1, -0.5], [1, 0], [0.5, 1], [-0.5, 1]]),
                                               np.repeat(np.eye(2), [3, 2], axis=0), np.array([2.0, 2, 2, 1, 1]), 0.1),
        "a large turn": a_large_turn,
    }, mistakes="""
        motion - np.linalg => motion + np.linalg and also 40 => 10
        motion - np.linalg => motion + np.linalg and also 40 => 20
        Your steps lead away from the walls: motion *minus* what the system gives, because r falls along -J.
        return motion => return motion * [1, 1, 180 / np.pi]
        Your angle is in degrees. Give radians.
        r / scale => r
        You leave `scale` out: r / scale says what is far.
        w = 1 / (1 + (r / scale) ** 2) ** 2 => w = np.ones(len(r))
        All points count alike, and the person pulls. Weigh each by 1 / (1 + (r / scale)^2)^2.
        (1 + (r / scale) ** 2) ** 2 => (1 + (r / scale) ** 2)
        Your weight is 1 / (1 + (r / scale)^2). The outer square is missing.
        range(40) => range(1)
        You take the first step only. Move the points, compute residuals and weights anew, and step again.
        [[c, -s], [s, c]] => [[c, s], [-s, c]] and also [[-s, -c], [c, -s]] => [[-s, c], [-c, -s]]
        Your theta has the wrong sign: it turns clockwise. [cos, -sin] is the first row of R.
        (w[:, None] * J), => (w[:, None] * J) + np.diag([0, 0, 1]), and also [[-s, -c], [c, -s]] => [[0, 0], [0, 0]]
        Your points are shifted, never turned: the third column of J is n . (dR/dtheta p).
        [[-s, -c], [c, -s]] => [[0, -1], [1, 0]]
        Your dR/dtheta is the one at theta = 0. Take it at the theta of each step.
        w = 1 / (1 + (r / scale) ** 2) ** 2 => w = w if _ else 1 / (1 + (r / scale) ** 2) ** 2
        You weigh the points once, at the start. Their residuals change with every step, so weigh them anew each time.
    """),
]
