"""Points with their landmarks, matched or made up, and how well a pose can be fitted to them."""

from typing import NamedTuple

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.lessons.kit.room_observations import in_body_frame, room_scenes
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, fit_rigid_2d

PAIR = "03_b"  # the same photographs as in lesson 15
SIGMA = 0.1  # metres, noise of a point in each direction where the lesson needs one (chosen: about what boxes give)
ROOM, LINE, CORNER, ONE_PLACE = "in a room", "in a line", "in one corner", "in one place"
MIRRORED, TWO = "mirrored", "two objects only"
LANDMARKS = {
    ROOM: [[1.0, 1.0], [5.0, 1.5], [4.5, 4.5], [1.5, 4.0], [3.2, 5.0], [2.6, 0.6]],
    LINE: [[0.5, 5.0], [1.2, 5.0], [2.1, 5.0], [3.4, 5.0], [4.6, 5.0], [5.5, 5.0]],
    CORNER: [[5.0, 4.8], [5.2, 4.9], [5.1, 5.1], [4.9, 5.0], [5.3, 5.2], [5.0, 5.3]],
    ONE_PLACE: [[4.0, 4.0]] * 6,
    MIRRORED: [[1.0, 1.0], [5.0, 1.5], [4.5, 4.5], [1.5, 4.0], [3.2, 5.0], [2.6, 0.6]],
    TWO: [[1.0, 1.0], [4.5, 4.5]],
}
_PLACE = (2.5, 2.5)  # where the panel's camera stands, metres


class Matched(NamedTuple):
    """Matched points, and the pose that they should give."""

    source: np.ndarray
    """`(n, 2)` body frame, metres."""
    target: np.ndarray
    """`(n, 2)` world, metres."""
    pose: Pose2D
    landmarks: tuple[int, ...] = ()
    """The landmarks that the points really show."""


def matched_points(name: str = PAIR) -> Matched:
    """Measured objects of a pair of photographs with their right landmarks: no matching takes part."""
    scene = room_scenes()[name]
    source = np.array([[one.x, one.y] for one in scene.observations])
    return Matched(source, room_map().positions[list(scene.true_landmarks)], scene.pose, scene.true_landmarks)


def pose_error(found: Pose2D, true: Pose2D) -> tuple[float, float]:
    """Metres, and degrees without sign."""
    off = float(np.hypot(found.x - true.x, found.y - true.y))
    return off, float(np.rad2deg(abs(wrap_angle(found.theta - true.theta))))


def noisy_fits(target: np.ndarray, pose: Pose2D, sigma: float, n_trials: int, rng: np.random.Generator) -> np.ndarray:
    """Errors `(n_trials, 3)` of x, y [m] and theta [rad] when each point is measured with noise sigma [m]."""
    exact = in_body_frame(target, pose)
    errors = np.empty((n_trials, 3))
    for k in range(n_trials):
        found = fit_rigid_2d(exact + rng.normal(0.0, sigma, exact.shape), target)
        errors[k] = found.x - pose.x, found.y - pose.y, wrap_angle(found.theta - pose.theta)
    return errors


def expected_sigmas(target: np.ndarray, pose: Pose2D, sigma: float) -> tuple[float, float]:
    """Standard deviation of the heading [rad], and root mean square of the error of place [m].

    sigma_theta^2 = sigma^2 / sum |b_i|^2;  place: 2 sigma^2 / n + g^2 sigma_theta^2, g from camera to centroid.
    """
    centred = target - target.mean(axis=0)
    of_heading = sigma / np.sqrt((centred**2).sum())
    arm = np.hypot(*(target.mean(axis=0) - [pose.x, pose.y]))
    return float(of_heading), float(np.sqrt(2 * sigma**2 / len(target) + (arm * of_heading) ** 2))


def weighted_fits(sigma_pixels: float, n_trials: int, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Errors of the fit `(n, 2)`, metres and degrees, of the room's poses: pairs alike, with weights, with covariances.

    Every measured place of every pair of photographs is moved n_trials times along its ray, as noise of sigma_pixels on
    both elevations moves it (lesson 14, nearly level rays), and a new one is fitted each time. A covariance is that
    noise, of one pixel at least, plus `SIGMA` each way, since a box centre is no point of the object; the weight is one
    over the variance along the ray.
    """
    baseline, pixel = room_recording(1).rig.baseline, 2 * np.pi / room_recording(1).width
    errors: dict[str, list] = {"all alike": [], "weights": [], "covariances": []}
    for name in room_scenes():
        points = matched_points(name)
        ranges = np.linalg.norm(points.source, axis=1)
        for _ in range(n_trials):
            off = np.sqrt(2) * ranges**2 / baseline * sigma_pixels * pixel * rng.standard_normal(len(ranges))
            source = points.source * (1 + off / ranges)[:, None]
            covariances, along = _needles(source, baseline, max(sigma_pixels, 1.0) * pixel)
            fits = (
                fit_rigid_2d(source, points.target),
                fit_rigid_2d(source, points.target, weights=1 / along**2),
                fit_rigid_2d(source, points.target, covariances=covariances),
            )
            for way, fit in zip(errors, fits, strict=True):
                errors[way].append(pose_error(fit, points.pose))
    return {way: np.array(found) for way, found in errors.items()}


def _needles(source: np.ndarray, baseline: float, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """Covariances `(n, 2, 2)` of places whose rays are off by sigma radians, and deviations `(n,)` along the ray."""
    ranges = np.linalg.norm(source, axis=1)
    ray = source / ranges[:, None]
    left = np.column_stack([-ray[:, 1], ray[:, 0]])
    along, across = np.hypot(np.sqrt(2) * ranges**2 / baseline * sigma, SIGMA), np.hypot(ranges * sigma, SIGMA)
    parts = [np.einsum("n,ni,nj->nij", size**2, way, way) for size, way in ((along, ray), (across, left))]
    return parts[0] + parts[1], along


def ring_of_landmarks(n: int) -> np.ndarray:
    """Landmarks `(n, 2)`, evenly on a circle of 2.5 m about (3, 3)."""
    turn = 2 * np.pi * np.arange(n) / n
    return 3.0 + 2.5 * np.column_stack([np.cos(turn), np.sin(turn)])


def mirrored_by_plain_svd(target: np.ndarray, sigma: float, n_trials: int, rng: np.random.Generator) -> int:
    """In how many of the noisy trials U V^T, without the sign, is a reflection and no rotation."""
    exact = target - target.mean(axis=0)
    count = 0
    for _ in range(n_trials):
        source, noisy_map = (exact + rng.normal(0.0, sigma, exact.shape) for _ in range(2))
        u, _, vt = np.linalg.svd((noisy_map - noisy_map.mean(axis=0)).T @ (source - source.mean(axis=0)))
        count += int(np.linalg.det(u @ vt) < 0)
    return count


def landmarks_of(arrangement: str) -> np.ndarray:
    """Landmarks `(n, 2)` of one of the panel's arrangements, world, metres."""
    return np.array(LANDMARKS[arrangement])


def residual_over_heading(source: np.ndarray, target: np.ndarray, headings: np.ndarray) -> np.ndarray:
    """Root mean square residual [m] for each heading [rad], with the best translation for that heading."""
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    dot, cross = np.sum(a * b), np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    squares = np.sum(a**2) + np.sum(b**2) - 2 * (dot * np.cos(headings) + cross * np.sin(headings))
    return np.sqrt(np.maximum(squares, 0.0) / len(a))


def scene_of(
    arrangement: str, heading_deg: float, noise: float, seed: int, moved: int, forward: float, left: float
) -> Matched:
    """The panel's points: exact ones, then noise, then one object moved in the body frame (moved counts from 1)."""
    target = landmarks_of(arrangement)
    pose = Pose2D(*_PLACE, float(wrap_angle(np.deg2rad(heading_deg))))
    source = in_body_frame(target, pose)
    if arrangement == MIRRORED:
        source = source * [1.0, -1.0]
    source = source + noise * np.random.default_rng(seed).standard_normal(source.shape)
    source[min(moved, len(source)) - 1] += [forward, left]
    return Matched(source, target, pose)
