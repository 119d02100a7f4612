"""Matches of two panoramas, simulated and from the room, and the four motions of an essential matrix.

The second camera is at c in the first camera's frame, and R turns from its axes to those of the first: X1 = R X2 + c.
Directions are unit vectors `(n, 3)`, x1 and x2, each in the axes of its own camera.
"""

from collections.abc import Callable

import cv2
import numpy as np

from course_lib.geometry import rotation_angle, rotation_exp
from course_lib.spherical_stereo.matching.epipolar import RATIO
from course_lib.spherical_stereo.panorama import direction_from_angles
from courseware.lessons.kit.room_data import scene

PIXEL = 2 * np.pi / 1280  # radians of one pixel of the room's panoramas
TURN, PLACE = np.array([0.1, -0.2, 0.7]), np.array([0.5, 0.3, -0.1])  # of the simulated second camera: rad, m


def random_directions(rng: np.random.Generator, n: int) -> np.ndarray:
    vectors = rng.standard_normal((n, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def random_views(rng, n: int, R: np.ndarray, c: np.ndarray, sigma: float, wrong: float = 0.0) -> tuple:
    """Return directions x1, x2 of n points 1 to 5 m away, with noise sigma [rad]; a share `wrong` is wrong."""
    points = random_directions(rng, n) * rng.uniform(1, 5, (n, 1))
    noisy = [one / np.linalg.norm(one, axis=1, keepdims=True) for one in (points, (points - c) @ R)]
    noisy = [one + sigma * rng.standard_normal((n, 3)) for one in noisy]
    x1, x2 = (one / np.linalg.norm(one, axis=1, keepdims=True) for one in noisy)
    bad = rng.permutation(n)[: round(wrong * n)]
    x2[bad] = random_directions(rng, len(bad))
    return x1, x2


def room_views(name: str = "09_a") -> tuple[np.ndarray, np.ndarray]:
    """Return directions x1, x2 of the room's AKAZE matches at one place, found by look alone, without any geometry."""
    sides = [side.features for side in scene(name)[:2]]
    matcher = cv2.BFMatcher(cv2.NORM_HAMMING)
    forth = matcher.knnMatch(*(side.descriptors for side in sides), k=2)
    back = {(one.trainIdx, one.queryIdx) for one in matcher.match(*(side.descriptors for side in sides[::-1]))}
    clear = [best for best, second in forth if best.distance < RATIO * second.distance]
    pairs = np.array([(one.queryIdx, one.trainIdx) for one in clear if (one.queryIdx, one.trainIdx) in back]).T
    angles = [np.array(side.angles())[:, chosen] for side, chosen in zip(sides, pairs, strict=True)]
    return direction_from_angles(*angles[0]), direction_from_angles(*angles[1])


def four_motions(E: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the four (R, c), c of length one, that make E or -E. Source: Hartley and Zisserman, 9.6."""
    U, _, Vt = np.linalg.svd(E)
    quarter = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    turns = [U @ W @ Vt for W in (quarter, quarter.T)]
    return [((turn * np.linalg.det(turn)).T, sign * Vt[2]) for turn in turns for sign in (1, -1)]


def distances(x1, x2, R, c) -> np.ndarray:
    """Return distances `(2, n)` from both cameras to where their rays are nearest to each other; negative is behind."""
    y = x2 @ R.T
    cosine, along_1, along_2 = np.sum(x1 * y, axis=1), x1 @ c, y @ c
    return np.array([along_1 - cosine * along_2, cosine * along_1 - along_2]) / (1 - cosine**2)


def shares_in_front(E: np.ndarray, x1: np.ndarray, x2: np.ndarray) -> np.ndarray:
    """Return for each of the four motions the share of matches that it puts in front of both cameras."""
    return np.array([np.mean((distances(x1, x2, *motion) > 0).all(axis=0)) for motion in four_motions(E)])


def motion_errors(E: np.ndarray, x1, x2, R: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Return the errors of the turn and of the direction of c, degrees `(2,)`, of the motion with most in front."""
    turn, place = four_motions(E)[int(np.argmax(shares_in_front(E, x1, x2)))]
    cosine = np.clip(place @ c / np.linalg.norm(c), -1, 1)
    return np.rad2deg([rotation_angle(R.T @ turn), np.arccos(cosine)])


def trials(estimate: Callable, n: int, wrong: float = 0.0, baseline: float = 0.6, repeats: int = 25) -> np.ndarray:
    """Return the errors `(repeats, 2)` of `estimate(x1, x2)` on matches with one pixel of noise."""
    R, c = rotation_exp(TURN), baseline * PLACE / np.linalg.norm(PLACE)
    views = [random_views(np.random.default_rng(seed), n, R, c, PIXEL, wrong) for seed in range(repeats)]
    return np.array([motion_errors(estimate(*pair), *pair, R, c) for pair in views])
