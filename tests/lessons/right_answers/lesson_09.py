"""Right answers to lesson 09 by other ways than its solutions."""

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from course_lib.geometry import rotation_exp, rotation_log


def by_vectors(rotations, w, start=0):
    mean = Rotation.from_matrix(rotations[start])
    for _ in range(25):
        vectors = [(mean.inv() * Rotation.from_matrix(r)).as_rotvec() for r in rotations]
        mean = mean * Rotation.from_rotvec(sum(a * v for a, v in zip(w, vectors, strict=True)))
    return mean.as_matrix()


def until_still(rotations, w):
    mean, step = rotations[-1], np.ones(3)
    while np.linalg.norm(step) > 1e-10:
        step = w @ rotation_log(mean.T @ rotations)
        mean = mean @ rotation_exp(step)
    return mean.tolist()


def in_the_world(rotations, w):
    """Both in the world's axes: the turns seen from there, and the step on the left."""
    mean = rotations[0]
    for _ in range(20):
        mean = rotation_exp(w @ rotation_log(rotations @ mean.T)) @ mean
    return mean


def by_inverse(e, c):
    squared = np.mean(np.einsum("ti,tij,tj->t", e, np.linalg.inv(c), e)) / e.shape[1]
    return np.array([squared, 1 - np.mean(abs(e) > 3 * np.sqrt(np.diagonal(c, axis1=1, axis2=2)))])


def by_scipy(points, normals, offsets, scale):
    def r(m):
        c, s = np.cos(m[2]), np.sin(m[2])
        return (normals * (points @ np.array([[c, s], [-s, c]]) + m[:2])).sum(axis=1) - offsets

    def loss(z):
        return np.array([z / (1 + z), 1 / (1 + z) ** 2, -2 / (1 + z) ** 3])

    return least_squares(r, np.zeros(3), loss=loss, f_scale=scale, xtol=1e-14, ftol=1e-14, gtol=1e-14).x


ANSWERS = {
    "09.1": [lambda n, d, k: np.exp(k / d * np.log(n))],
    "09.2": [
        by_vectors,
        until_still,
        in_the_world,
        lambda rotations, w: by_vectors(rotations, w, start=-1),
        lambda rotations, w: by_vectors(rotations, w).round(9),
        lambda rotations, w: by_vectors(rotations, w, start=int(w.argmax())).tolist(),
    ],
    "09.3": [by_inverse],
    "09.4": [by_scipy],
}
RIGHT = [(number, answer) for number, answers in ANSWERS.items() for answer in answers]
