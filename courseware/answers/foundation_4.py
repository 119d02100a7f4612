"""Exercises of F4: where each camera sees the other, distances from any two views, and their error."""

import numpy as np

from course_lib.geometry import rotation_exp
from courseware.lessons.foundation_4.two_views import random_directions
from courseware.lessons.kit.exercises import Exercise


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
    }, mistakes="""
        c / np.linalg.norm(c) => c
        A direction is a vector of length one. Yours is as long as the baseline.
        -R.T @ forth => R.T @ forth
        The second camera looks back along the baseline: look at the sign of your second direction.
        -R.T @ forth => -R @ forth
        R turns from the second camera's axes to the first one's. You need the way back, which is its transpose.
        -R.T @ forth => -forth
        The second panorama counts in the axes of its own camera, which may be turned.
        np.array([forth, -R.T @ forth]) => np.array([-R.T @ forth, forth])
        The first direction belongs to the first panorama. Here c is the second camera's place in the first frame.
        np.array([forth, -R.T @ forth]) => np.array([R.T @ forth, -R.T @ forth])
        np.array([forth, -R.T @ forth]) => np.array([R @ forth, -forth])
        c already counts in the first camera's axes. Turn nothing there.
        np.array([forth, -R.T @ forth]) => np.array([-forth, R.T @ forth])
        Both directions are opposite to the right ones. Does c lead to the second camera, or away from it?
        c / np.linalg.norm(c) => c / np.linalg.norm(c[:2])
        The baseline may have a part along z. Divide by the length in space.
        np.array([forth, -R.T @ forth]) => np.array([forth, forth])
        Both of your directions are the same. Stand at the second camera: where is the first one?
    """),
    Exercise("F4.2", distance_along, sights, cases={
        "an upright rig": lambda rng: sights(rng, motion=upright(rng)),
        "all points in front": in_front,
        "one match": lambda rng: in_front(rng, n=1),
    }, mistakes="""
        np.where((d1 > 0) & (d2 > 0), d1, np.nan) => d1
        np.where((d1 > 0) & (d2 > 0), d1, np.nan) => np.abs(d1)
        Where rays meet behind a camera there is no point. The answer is NaN.
        (d1 > 0) & (d2 > 0) => d1 > 0
        (d1 > 0) & (d2 > 0) => d2 > 0
        (d1 > 0) & (d2 > 0) => (d1 > 0) | (d2 > 0)
        You look at one of the cameras. The point must be in front of both.
        x2 @ R.T => x2
        Your rays count in two frames. Turn the second ray into the first camera's axes.
        x2 @ R.T => x2 @ R
        You turn the second ray the wrong way. For rows, R x becomes x @ R.T.
        (d2 > 0), d1, np.nan) => (d2 > 0), d2, np.nan)
        That is the distance from the second camera.
        (along_1 - cosine * along_2) / (1 - cosine**2) => along_1
        (along_1 - cosine * along_2) / (1 - cosine**2) => along_1 - cosine * along_2
        That is a projection of the baseline. Ask for which d1 and d2 both rays reach the same point.
        ... => return np.linalg.norm(c) * np.sqrt(1 - x2[:, 2]**2) / np.sin(np.arcsin(x2[:, 2]) - np.arcsin(x1[:, 2]))
        That is lesson 14's equation. It holds for an upright rig alone.
        x1 @ c, y @ c => x1 @ c / np.linalg.norm(c), y @ c / np.linalg.norm(c)
        Your baseline has length one. The distances are in metres, because c is.
        np.nan => 0.0
        np.nan => np.inf
        Where there is no point, the answer is NaN, and no number.
        ... => return distance_along(x1, x2, R.T, -R.T @ c)
        You read R and c the other way round. R turns from the second to the first, and c is in the first frame.
        ... => return np.linalg.norm(c) / np.linalg.norm(np.cross(x1, x2 @ R.T), axis=1)
        ... => return np.linalg.norm(c) / np.arccos(np.sum(x1 * (x2 @ R.T), axis=1))
        Baseline over parallax holds far away and beside the rig. Which angle lies opposite to your distance?
    """),
    Exercise("F4.3", distance_sigma, lambda rng: (*in_front(rng), rng.uniform(0.001, 0.01)), "challenge", cases={
        "an upright rig": lambda rng: (*in_front(rng, motion=upright(rng)), 0.005),
        "exact directions": lambda rng: (*in_front(rng), 0.0),
    }, mistakes="""
        (d1 * cosine) ** 2 + d2**2 => d2**2
        The first camera's own error turns its ray, too, so the meeting point moves along it.
        (d1 * cosine) ** 2 + d2**2 => (d1 * cosine) ** 2
        The second camera's error is missing. It is the larger part.
        (d1 * cosine) ** 2 => d1**2
        A cosine is missing: if the rays cross at a right angle, the first one's error does not change d1 at all.
        (d1 * cosine) ** 2 + d2**2 => (d2 * cosine) ** 2 + d1**2
        d1 and d2 are exchanged. How far does the second ray's error move it across, at the point?
        np.sqrt((d1 * cosine) ** 2 + d2**2) => (np.abs(d1 * cosine) + d2)
        Two independent errors add as squares.
        sigma / sine => sigma
        The crossing is oblique. Divide by the sine of the parallax.
        sigma / sine => sigma / sine**2
        You divide by the sine of the parallax once too often: d1 and d2 hold it already.
        ... => return sigma * distance_along(x1, x2, R, c) * distance_along(x2, x1, R.T, -R.T @ c) / np.linalg.norm(c)
        ... => return sigma * np.sqrt(2) * distance_along(x1, x2, R, c) ** 2 / np.linalg.norm(c)
        That is the rule for far points beside the rig, square over baseline. Here the rays may lie anywhere.
        x2 @ R.T => x2
        Your rays count in two frames. Turn the second ray into the first camera's axes.
        sigma / sine * np.sqrt => sigma**2 / sine**2 * np.square
        sigma / sine * np.sqrt((d1 * cosine) ** 2 + d2**2) => sigma**2 / sine**2 * ((d1 * cosine) ** 2 + d2**2)
        That is a variance, or its square. The task asks for the standard deviation.
    """),
]
