"""Answers that students may give to lesson 09, for test_exercise_answers.py."""

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from course_lib.geometry import rotation_exp, rotation_log


def quaternion_mean(rotations, w):
    q = Rotation.from_matrix(rotations).as_quat()
    q *= np.sign(q @ q[0])[:, None]
    return Rotation.from_quat(w @ q).as_matrix()


def by_vectors(rotations, w, start=0, rounds=25):
    mean = Rotation.from_matrix(rotations[start])
    for _ in range(rounds):
        vectors = [(mean.inv() * Rotation.from_matrix(r)).as_rotvec() for r in rotations]
        mean = mean * Rotation.from_rotvec(sum(a * v for a, v in zip(w, vectors, strict=True)))
    return mean.as_matrix()


def until_still(rotations, w):
    mean, step = rotations[-1], np.ones(3)
    while np.linalg.norm(step) > 1e-10:
        step = w @ rotation_log(mean.T @ rotations)
        mean = mean @ rotation_exp(step)
    return mean.tolist()


def by_pseudo_inverse(errors, covariances):
    squares = [e @ np.linalg.pinv(c, rcond=1e-15) @ e for e, c in zip(errors, covariances, strict=True)]
    inside = sum(e[k] ** 2 <= 9 * c[k, k] for e, c in zip(errors, covariances, strict=True) for k in range(len(e)))
    return [sum(squares) / errors.size, inside / errors.size]


def first(e, c):
    return np.mean(np.einsum("ti,tij,tj->t", e, np.linalg.inv(c), e)) / e.shape[1]


def sigma(c):
    return np.sqrt(np.diagonal(c, axis1=1, axis2=2))


def walls(points, normals, offsets, scale, weight, steps=40, turn=1, freeze=False):
    x, y, a, w = 0.0, 0.0, 0.0, None
    for _ in range(steps):
        c, s = np.cos(a), turn * np.sin(a)
        moved = np.column_stack([c * points[:, 0] - s * points[:, 1] + x, s * points[:, 0] + c * points[:, 1] + y])
        r = np.einsum("ij,ij->i", normals, moved) - offsets
        lever = turn * (normals[:, 1] * (moved[:, 0] - x) - normals[:, 0] * (moved[:, 1] - y))
        if w is None or not freeze:
            w = weight(r / scale)
        root = np.sqrt(w)[:, None]
        step = np.linalg.lstsq(root * np.column_stack([normals, lever]), -root[:, 0] * r, rcond=None)[0]
        x, y, a = np.add((x, y, a), step)
    return [x, y, a]


def geman(u):
    return 1 / (1 + u**2) ** 2


def by_scipy(points, normals, offsets, scale):
    def r(m):
        c, s = np.cos(m[2]), np.sin(m[2])
        return (normals * (points @ np.array([[c, s], [-s, c]]) + m[:2])).sum(axis=1) - offsets

    def loss(z):
        return np.array([z / (1 + z), 1 / (1 + z) ** 2, -2 / (1 + z) ** 3])

    return least_squares(r, np.zeros(3), loss=loss, f_scale=scale, xtol=1e-14, ftol=1e-14, gtol=1e-14).x


def in_world(rotations, w):
    mean = rotations[0]
    for _ in range(20):
        mean = mean @ rotation_exp(w @ rotation_log(np.stack([r @ mean.T for r in rotations])))
    return mean


def lever_of_the_start(points, normals, offsets, scale):
    motion = np.zeros(3)
    lever = normals[:, 1] * points[:, 0] - normals[:, 0] * points[:, 1]
    jacobian = np.column_stack([normals, lever])
    for _ in range(40):
        turn = Rotation.from_euler("z", motion[2]).as_matrix()[:2, :2]
        r = np.sum(normals * (points @ turn.T + motion[:2]), axis=1) - offsets
        w = geman(r / scale)
        motion = motion - np.linalg.solve((jacobian.T * w) @ jacobian, (jacobian.T * w) @ r)
    return motion


WRONG = [
    ("09.2", in_world, "in the world's axes"),
    ("09.4", lever_of_the_start, "that of theta = 0"),
    ("09.1", lambda n, d, k: n ** (k // d), "without remainder"),
    ("09.1", lambda n, d, k: round(n ** (k / d)), "nearest whole"),
    ("09.1", lambda n, d, k: n * (k / d), "multiply by the number of dimensions"),
    ("09.1", lambda n, d, k: n ** (1 / d) ** k, "set brackets"),
    ("09.1", lambda n, d, k: (1 / n) ** (1 / d), "That is the spacing"),
    ("09.2", lambda rot, w: sum(a * r for a, r in zip(w, rot, strict=True)), "columns are shorter than 1"),
    ("09.2", lambda rot, w: Rotation.from_matrix(rot).mean(w).as_matrix(), "chordal"),
    ("09.2", quaternion_mean, "Right on"),
    ("09.2", lambda rot, w: by_vectors(rot, w, rounds=1), "One round"),
    ("09.2", lambda rot, w: by_vectors(rot, np.ones(len(w)) / len(w)), "where are the weights"),
    ("09.2", lambda rot, w: Rotation.from_matrix(by_vectors(rot, w)).as_rotvec(), "asks for the matrix"),
    ("09.3", lambda e, c: (first(e, c), np.mean(abs(e) < 3 * sigma(c) ** 2)), "square root of the variance"),
    ("09.3", lambda e, c: (first(e, c) * e.shape[1], np.mean(abs(e) <= 3 * sigma(c))), "divide by d"),
    ("09.3", lambda e, c: (np.mean((e / sigma(c)) ** 2), np.mean(abs(e) <= 3 * sigma(c))), "diagonal of C alone"),
    ("09.3", lambda e, c: (first(e, c), np.mean(e <= 3 * sigma(c))), "absolute value"),
    ("09.3", lambda e, c: (first(e, c), np.mean(np.all(abs(e) <= 3 * sigma(c), axis=1))), "whole images"),
    ("09.3", lambda e, c: (np.mean(abs(e) <= 3 * sigma(c)), first(e, c)), "in another order"),
    ("09.3", lambda e, c: first(e, c), "Return 2 values"),
    ("09.4", lambda p, n, c, s: walls(p, n, c, s, lambda u: np.ones(len(u))), "the person pulls"),
    ("09.4", lambda p, n, c, s: walls(p, n, c, s, lambda u: 1 / (1 + u**2)), "outer square"),
    ("09.4", lambda p, n, c, s: walls(p, n, c, s, geman, steps=1), "first step"),
    ("09.4", lambda p, n, c, s: walls(p, n, c, s, geman, turn=-1), "clockwise"),
    ("09.4", lambda p, n, c, s: walls(p, n, c, s, geman, freeze=True), "weights of the first step"),
    ("09.4", lambda p, n, c, s: np.degrees(walls(p, n, c, s, geman)) * [np.pi / 180, np.pi / 180, 1], "degrees"),
]
RIGHT = [
    ("09.1", lambda n, d, k: np.exp(k / d * np.log(n))),
    ("09.1", lambda n, d, k: np.array([(n ** (1 / d)) ** k])[0]),
    ("09.2", by_vectors),
    ("09.2", until_still),
    ("09.2", lambda rot, w: by_vectors(rot, w, start=-1, rounds=20)),
    ("09.2", lambda rot, w: by_vectors(rot, w).astype(np.float64).round(9)),
    ("09.3", by_pseudo_inverse),
    ("09.3", lambda e, c: np.array([first(e, c), 1 - np.mean(abs(e) > 3 * sigma(c))])),
    ("09.4", lambda p, n, c, s: walls(p, n, c, s, geman)),
    ("09.4", lambda p, n, c, s: np.array(walls(p, n, c, s, geman, steps=25), dtype=np.float32)),
    ("09.4", by_scipy),
]
