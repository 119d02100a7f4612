"""Exercises of F4: where each camera sees the other, distances from any two views, and their error."""

import numpy as np

from course_lib.geometry import rotation_exp
from courseware.lessons.foundation_4.two_views import random_directions
from courseware.lessons.kit.exercise import Exercise


def other_camera(R, c):
    """Directions (2, 3) in which the first panorama shows the second camera, and the second panorama the first."""
    # The way there, and the way back in the second camera's own axes.
    forth = c / np.linalg.norm(c)
    return np.array([forth, -R.T @ forth])


def a_motion(rng: np.random.Generator) -> tuple:
    return rotation_exp(rng.uniform(-1.5, 1.5, 3)), random_directions(rng, 1)[0] * rng.uniform(0.3, 2.0)


def distance_along(x1, x2, R, c):
    """Distances (n,) [m] from the first camera to the points in directions x1, x2 (n, 3); NaN where there is none."""
    # Where d1 x1 - d2 R x2 = c: multiply by either ray, and solve for both distances.
    y = x2 @ R.T
    cosine, along_1, along_2 = np.sum(x1 * y, axis=1), x1 @ c, y @ c
    d1 = (along_1 - cosine * along_2) / (1 - cosine**2)
    d2 = (cosine * along_1 - along_2) / (1 - cosine**2)
    return np.where((d1 > 0) & (d2 > 0), d1, np.nan)


def sights(rng: np.random.Generator, n: int = 6, behind: bool = True, motion: tuple | None = None) -> tuple:
    """Return directions that meet exactly, clearly not parallel. behind: one pair meets behind each camera or both."""
    R, c = a_motion(rng) if motion is None else motion
    points = random_directions(rng, 40) * rng.uniform(1, 5, (40, 1))
    parallax = np.linalg.norm(np.cross(points, points - c), axis=1)
    parallax /= np.linalg.norm(points, axis=1) * np.linalg.norm(points - c, axis=1)
    points = points[parallax > 0.05][:n]
    x1, x2 = (one / np.linalg.norm(one, axis=1, keepdims=True) for one in (points, (points - c) @ R))
    if behind:
        x1[0], x2[1], x1[2], x2[2] = -x1[0], -x2[1], -x1[2], -x2[2]
    return x1, x2, R, c


def in_front(rng: np.random.Generator, n: int = 6, motion: tuple | None = None) -> tuple:
    return sights(rng, n, False, motion)


def upright(rng: np.random.Generator) -> tuple:
    return np.eye(3), np.array([0.0, 0.0, -rng.uniform(0.2, 0.6)])


def distance_sigma(x1, x2, R, c, sigma):
    """Standard deviations (n,) [m] of distances from the first camera; errors sigma [rad] of both directions."""
    # Both derivatives of d1 = |c| sin(angle at the second camera) / sin(parallax), added as squares.
    y = x2 @ R.T
    sine, cosine = np.linalg.norm(np.cross(x1, y), axis=1), np.sum(x1 * y, axis=1)
    d1 = np.linalg.norm(np.cross(c, y), axis=1) / sine
    d2 = np.linalg.norm(np.cross(c, x1), axis=1) / sine
    return sigma / sine * np.sqrt((d1 * cosine) ** 2 + d2**2)


# fmt: off
EXERCISES = [
    Exercise("F4.1", other_camera, a_motion, "warm-up", cases={
        "an upright rig": upright,
        "cameras with the same axes": lambda rng: (np.eye(3), a_motion(rng)[1]),
    }),
    Exercise("F4.2", distance_along, sights, cases={
        "an upright rig": lambda rng: sights(rng, motion=upright(rng)),
        "all points in front": in_front,
        "one match": lambda rng: in_front(rng, n=1),
    }),
    Exercise("F4.3", distance_sigma, lambda rng: (*in_front(rng), rng.uniform(0.001, 0.01)), "challenge", cases={
        "an upright rig": lambda rng: (*in_front(rng, motion=upright(rng)), 0.005),
        "exact directions": lambda rng: (*in_front(rng), 0.0),
    }),
]
