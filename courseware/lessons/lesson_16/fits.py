"""Points with their landmarks, matched or made up, and how well a pose can be fitted to them."""

from collections import namedtuple

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, fit_rigid_2d
from courseware.lessons.kit.room_data import in_body_frame, room_map, room_recording, room_scenes

SIGMA = 0.1  # metres, noise of a point in each direction where the lesson needs one (chosen: about what boxes give)
ROOM, LINE, MIRRORED = "in a room", "in a line", "mirrored"
LANDMARKS = {
    ROOM: [[1.0, 1.0], [5.0, 1.5], [4.5, 4.5], [1.5, 4.0], [3.2, 5.0], [2.6, 0.6]],
    LINE: [[0.5, 5.0], [1.2, 5.0], [2.1, 5.0], [3.4, 5.0], [4.6, 5.0], [5.5, 5.0]],
    "in one corner": [[5.0, 4.8], [5.2, 4.9], [5.1, 5.1], [4.9, 5.0], [5.3, 5.2], [5.0, 5.3]],
    "in one place": [[4.0, 4.0]] * 6,
    MIRRORED: [[1.0, 1.0], [5.0, 1.5], [4.5, 4.5], [1.5, 4.0], [3.2, 5.0], [2.6, 0.6]],
    "two objects only": [[1.0, 1.0], [4.5, 4.5]],
}

Matched = namedtuple("Matched", "source target pose landmarks")
"""Points `(n, 2)` [m] in the body frame, those in the world, the pose they should give, and the landmarks they show."""


def matched_points(name: str = "03_b") -> Matched:
    """Return the measured objects of a pair of photographs with their right landmarks: no matching takes part."""
    scene = room_scenes()[name]
    source = np.array([[one.x, one.y] for one in scene.observations])
    return Matched(source, room_map().positions[list(scene.true_landmarks)], scene.pose, scene.true_landmarks)


def pose_error(found: Pose2D, true: Pose2D) -> tuple[float, float]:
    """Return the errors of the place, metres, and of the heading, degrees without sign."""
    off = float(np.hypot(found.x - true.x, found.y - true.y))
    return off, float(np.rad2deg(abs(wrap_angle(found.theta - true.theta))))


def noisy_fits(target: np.ndarray, pose: Pose2D, sigma: float, n_trials: int, rng: np.random.Generator) -> np.ndarray:
    """Return errors `(n_trials, 3)` of x, y [m] and theta [rad] if each point is measured with noise sigma [m]."""
    exact = in_body_frame(target, pose)
    noise = rng.normal(0.0, sigma, (n_trials, *exact.shape))
    errors = np.array([fit_rigid_2d(exact + one, target) for one in noise]) - pose
    return np.column_stack([errors[:, :2], wrap_angle(errors[:, 2])])


def expected_sigmas(target: np.ndarray, pose: Pose2D, sigma: float) -> tuple[float, float]:
    """Return the standard deviation of the heading [rad], and the root mean square of the error of place [m].

    sigma_theta^2 = sigma^2 / sum |b_i|^2;  place: 2 sigma^2 / n + g^2 sigma_theta^2, g from camera to centroid.
    """
    of_heading = sigma / np.linalg.norm(target - target.mean(axis=0))
    arm = np.linalg.norm(target.mean(axis=0) - pose[:2])
    return of_heading, np.sqrt(2 * sigma**2 / len(target) + (arm * of_heading) ** 2)


def weighted_fits(sigma_pixels: float, n_trials: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Return errors of the fit `(n, 2)`, metres and degrees, of the room's poses: pairs alike, weights, covariances.

    Noise of sigma_pixels on both elevations moves each measured place along its ray (lesson 14, nearly level rays). It
    is drawn n_trials times for each pair of photographs. A covariance is that noise, of one pixel at least, plus
    `SIGMA` each way, since a box centre is no point of the object. The weight is 1 / variance along the ray.
    """
    baseline, pixel = room_recording(1).rig.baseline, 2 * np.pi / room_recording(1).width
    ways: dict[str, list] = {"all alike": [], "weights": [], "covariances": []}
    for points in [points for points in map(matched_points, room_scenes()) for _ in range(n_trials)]:
        ranges = np.linalg.norm(points.source, axis=1)
        off = np.sqrt(2) * ranges**2 / baseline * sigma_pixels * pixel * rng.standard_normal(len(ranges))
        source = points.source * (1 + off / ranges)[:, None]
        ranges, sigma = np.linalg.norm(source, axis=1)[:, None, None], max(sigma_pixels, 1.0) * pixel
        along, across = (np.sqrt(2) * ranges**2 / baseline * sigma) ** 2 + SIGMA**2, (ranges * sigma) ** 2 + SIGMA**2
        rays = np.einsum("ni,nj->nij", source, source) / ranges**2
        covariances = across * np.eye(2) + (along - across) * rays
        for way, how in zip(ways, ({}, {"weights": 1 / along.ravel()}, {"covariances": covariances}), strict=True):
            ways[way].append(pose_error(fit_rigid_2d(source, points.target, **how), points.pose))
    return {way: np.array(errors) for way, errors in ways.items()}


def ring_of_landmarks(n: int) -> np.ndarray:
    """Return landmarks `(n, 2)`, evenly on a circle of 2.5 m about (3, 3)."""
    turn = 2 * np.pi * np.arange(n) / n
    return 3.0 + 2.5 * np.column_stack([np.cos(turn), np.sin(turn)])


def mirrored_by_plain_svd(target: np.ndarray, sigma: float, n_trials: int, rng: np.random.Generator) -> int:
    """Return in how many of the noisy trials U V^T, without the sign, is a reflection and no rotation."""
    both = target - target.mean(axis=0) + rng.normal(0.0, sigma, (n_trials, 2, *target.shape))
    source, on_map = np.moveaxis(both - both.mean(axis=2, keepdims=True), 1, 0)
    u, _, vt = np.linalg.svd(np.swapaxes(on_map, 1, 2) @ source)
    return int(np.sum(np.linalg.det(u @ vt) < 0))


def landmarks_of(arrangement: str) -> np.ndarray:
    """Return the landmarks `(n, 2)` of one of the panel's arrangements, world, metres."""
    return np.array(LANDMARKS[arrangement])


def residual_over_heading(source: np.ndarray, target: np.ndarray, headings: np.ndarray) -> np.ndarray:
    """Return the root mean square residual [m] for each heading [rad], with the best translation for that heading."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    dot, cross = np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    squares = np.sum(a**2) + np.sum(b**2) - 2 * (dot * np.cos(headings) + cross * np.sin(headings))
    return np.sqrt(np.maximum(squares, 0.0) / len(a))
