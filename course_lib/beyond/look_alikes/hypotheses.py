"""Poses of two matches: every pair of observations is laid on every pair of landmarks that it may show.

If objects look alike, no match can be believed alone, but two give a pose that everything else can judge.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.detection.detected_object import canonical_label
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

DISTANCE_GATE = 3.5  # standard deviations by which two distances may differ and still be one (chosen)
MIN_DISTANCE = 0.5  # Metres between two landmarks, and between two observations. Nearer ones tell no useful heading.
UNKNOWN_SIGMA = 0.3  # Metres, standard deviation of a position without a covariance (chosen).
MAP_SIGMA = 0.02  # metres, standard deviation of a landmark's coordinates
# Steps for every pose of two matches: thousands at once, of which the best are refitted. On P2's practice rooms nine of
# ten poses near the true one are then within 0.1 mm and 1e-4 radians of where forty steps end.
GAUSS_NEWTON_STEPS = 4


class Scene(NamedTuple):
    """n observations and a map of m landmarks as arrays, made once for all parts of the search."""

    places: np.ndarray  # `(n, 2)`, body frame, metres
    covariances: np.ndarray  # `(n, 2, 2)` of the places
    hues: np.ndarray  # `(n,)` degrees, NaN for grey
    saturations: np.ndarray  # `(n,)` percent
    like: np.ndarray  # `(n, m)` bool: do the classes of an observation and a landmark agree?
    semantic_map: SemanticMap


class PairPoses(NamedTuple):
    """h poses of pairs of matches."""

    poses: np.ndarray  # `(h, 3)` [x, y, theta], metres and radians
    covariances: np.ndarray  # `(h, 3, 3)`, what two matches leave open
    observations: np.ndarray  # `(h, 2)` indices
    landmarks: np.ndarray  # `(h, 2)` indices of what they were laid on


class PoseHypothesis(NamedTuple):
    """One pose, and how well it explains what was seen."""

    pose: Pose2D
    covariance: np.ndarray  # `(3, 3)` of [x, y, theta], metres and radians, squared.
    pairs: tuple[tuple[int, int], ...]  # (observation, landmark) that it matches.
    score: float  # log-likelihood ratio in nats: 0 means that clutter explains the observations as well
    chi_square: float  # Sum of squared normalized residuals of the pairs, of 2 n - 3 numbers.
    missed: tuple[int, ...]  # Landmarks that were probably visible from there, and were not seen.
    share: float = 0.0  # Of the belief, among all distinct poses and "none of them": 0 to 1.


def scene_of(observations: Sequence[Observation], semantic_map: SemanticMap) -> Scene:
    """Return the arrays of observations and map."""
    n = len(observations)
    labels = np.array([canonical_label(one.label) for one in observations], dtype=object)
    unknown = UNKNOWN_SIGMA**2 * np.eye(2)
    return Scene(
        np.array([[one.x, one.y] for one in observations], dtype=np.float64).reshape(n, 2),
        np.array([unknown if one.covariance is None else one.covariance for one in observations]).reshape(n, 2, 2),
        np.array([one.hue for one in observations], dtype=np.float64),
        np.array([one.saturation for one in observations], dtype=np.float64),
        labels[:, None] == np.array(semantic_map.labels, dtype=object)[None],
        semantic_map,
    )


def pairs_of_matches(scene: Scene, gate: float = DISTANCE_GATE) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of matches that can both be right: indices `(h, 2)` of observations and of landmarks.

    Like classes, landmarks `MIN_DISTANCE` apart, and | |z_i - z_k| - |m_j - m_l| | <= gate sigma, with sigma^2 = u^T
    (C_i + C_k) u along the line u between the observations.
    """
    i, j = np.nonzero(scene.like)
    first, second = np.nonzero(i[:, None] < i[None])
    observations = np.stack([i[first], i[second]], axis=1)
    landmarks = np.stack([j[first], j[second]], axis=1)
    seen = scene.places[observations[:, 1]] - scene.places[observations[:, 0]]
    true = scene.semantic_map.positions[landmarks[:, 1]] - scene.semantic_map.positions[landmarks[:, 0]]
    seen_length, true_length = np.linalg.norm(seen, axis=1), np.linalg.norm(true, axis=1)
    along = seen / np.maximum(seen_length, 1e-9)[:, None]
    noise = scene.covariances[observations].sum(axis=1) + 2 * MAP_SIGMA**2 * np.eye(2)
    sigma = np.sqrt(np.einsum("hi,hij,hj->h", along, noise, along))
    kept = (np.abs(seen_length - true_length) <= gate * sigma) & (np.minimum(seen_length, true_length) >= MIN_DISTANCE)
    return observations[kept], landmarks[kept]


def pair_poses(scene: Scene, gate: float = DISTANCE_GATE) -> PairPoses:
    """Return the pose of every pair of matches with its covariance, by `fit_poses`, begun line on line."""
    observations, landmarks = pairs_of_matches(scene, gate)
    places, targets = scene.places[observations], scene.semantic_map.positions[landmarks]
    seen, true = places[:, 1] - places[:, 0], targets[:, 1] - targets[:, 0]
    theta = np.arctan2(true[:, 1], true[:, 0]) - np.arctan2(seen[:, 1], seen[:, 0])
    middle = targets.mean(axis=1) - (rotation_2d(theta) @ places.mean(axis=1)[..., None])[..., 0]
    start = np.column_stack([middle, theta])
    poses, covariances = fit_poses(start, places, targets, scene.covariances[observations])
    return PairPoses(poses, covariances, observations, landmarks)


def fit_poses(
    start: np.ndarray, places: np.ndarray, targets: np.ndarray, covariances: np.ndarray, used: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return the anisotropic fits of many poses at once: poses `(h, 3)` and their covariances `(h, 3, 3)`.

    Gauss-Newton steps from `start` `(h, 3)` on sum_k r_k^T (R C_k R^T + `MAP_SIGMA`^2 I)^-1 r_k, r_k = R z_k + t - m_k.
    places, targets: `(h, k, 2)`. covariances: `(h, k, 2, 2)`, body frame. used: `(h, k)` bool, two or more a pose.
    """
    poses = np.array(start, dtype=np.float64).reshape(-1, 3)
    normal = np.tile(np.eye(3), (len(poses), 1, 1))
    for _ in range(GAUSS_NEWTON_STEPS if len(poses) else 0):
        turned, jacobians, spread = seen_from(poses, places, covariances)
        information = np.linalg.inv(spread + MAP_SIGMA**2 * np.eye(2))
        if used is not None:
            information = information * used[..., None, None]
        weighted = np.swapaxes(jacobians, -1, -2) @ information
        normal = (weighted @ jacobians).sum(axis=1)
        slope = (weighted @ (turned - targets)[..., None]).sum(axis=1)
        poses = poses - np.linalg.solve(normal, slope)[..., 0]
    poses[:, 2] = wrap_angle(poses[:, 2])
    return poses, np.linalg.inv(normal)


def seen_from(poses: np.ndarray, places: np.ndarray, covariances: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return places `(h, k, 2)` on the map, their derivative by the pose `(h, k, 2, 3)`, and R C R^T `(h, k, 2, 2)`."""
    rotation = rotation_2d(poses[:, 2])[:, None]
    turned = (rotation @ places[..., None])[..., 0]
    jacobians = np.zeros((*turned.shape, 3))
    jacobians[..., 0, 0] = jacobians[..., 1, 1] = 1.0
    jacobians[..., 0, 2], jacobians[..., 1, 2] = -turned[..., 1], turned[..., 0]
    return turned + poses[:, None, :2], jacobians, rotation @ covariances @ np.swapaxes(rotation, -1, -2)
