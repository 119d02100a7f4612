"""How well h poses explain the observations and the missing ones. Each kind of evidence is a function.

Costs are negative logarithms of probabilities, in nats, so that they add up: a cost of 3 is odds of 20 to 1.
"""

from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.hypotheses import MAP_SIGMA, Scene, seen_from
from course_lib.spherical_stereo.semantic_map.association import hue_difference
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

# Measured on rooms 10,100 to 10,103: errors of places are larger than their covariances say (1.1 along the ray, with
# heavier tails), and 1 in 50 observations shows nothing of the map.
NOISE_FACTOR = 1.2
CLUTTER_DENSITY = 1e-3  # false observations a square metre
HUE_SPREAD = 600.0  # degrees times percent: the standard deviation of a hue is this over the saturation
MIN_HUE_SIGMA = 12.0  # Degrees, for the most colourful of things: light differs from survey to survey.
SATURATION_SIGMA = 15.0  # Percent, standard deviation of a saturation between survey and photograph.
MAX_COLOUR_COST = 3.0  # Nats. A wrong colour never costs more.
DETECTION_NEAR, DETECTION_FAR = 0.95, 0.65  # probability that a landmark in plain sight is observed, to `FAR_RANGE`
FAR_RANGE = 6.0  # Metres.
DETECTION_HIDDEN = 0.5  # Probability that a landmark behind another is observed all the same: over it, or past it.
OBJECT_RADIUS = 0.4  # metres: half the width of a piece of furniture, which hides what is behind it
BODY_RADIUS = 0.2  # Metres about a landmark's centroid where no rig can stand.
OUTSIDE_COST = 20.0  # Nats for a pose inside a piece of furniture or outside the walls.


class Evidence(NamedTuple):
    """Which parts of the score count: all of them, or for an ablation all but one."""

    one_to_one: bool = True  # an assignment; False: every observation takes the landmark it likes best
    stereo_covariance: bool = True  # residuals weighed by their covariance; False: by one number in every direction
    colour: bool = True
    refit: bool = True  # The pose fitted to all its matches; False: the pose of the two it came from.
    negative: bool = True  # What should be seen and is not.
    free_space: bool = True
    absolute: bool = True  # Confidence asks for an absolute fit too; False: for the gap to the other poses alone.


def place_distances(scene: Scene, poses: np.ndarray, pose_covariances: np.ndarray | None = None) -> tuple:
    """Return squared Mahalanobis distances `(h, n, m)` of every observation to every landmark, and log|S| `(h, n)`.

    d^2 = r^T S^-1 r, r = R z + t - m, S = f^2 R C R^T + s_map^2 I + J P J^T, f = `NOISE_FACTOR`, P: of the poses
    """
    places, jacobians, spread = seen_from(poses, scene.places[None], scene.covariances[None])
    spread = NOISE_FACTOR**2 * spread + MAP_SIGMA**2 * np.eye(2)
    if pose_covariances is not None:
        spread = spread + jacobians @ pose_covariances[:, None] @ np.swapaxes(jacobians, -1, -2)
    residuals = places[:, :, None] - scene.semantic_map.positions
    squared = ((residuals @ np.linalg.inv(spread)) * residuals).sum(axis=-1)
    return squared, np.log(np.linalg.det(spread))


def colour_costs(scene: Scene) -> np.ndarray:
    """Return the cost `(n, m)` of the colours of every observation and landmark: 0 where they are the same.

    dh^2 / (2 s_h^2) + ds^2 / (2 s_s^2), at most `MAX_COLOUR_COST`; s_h = `HUE_SPREAD` / the lesser saturation.
    """
    landmarks = scene.semantic_map
    d_hue = hue_difference(scene.hues[:, None], landmarks.hues[None])
    lesser = np.minimum(scene.saturations[:, None], landmarks.saturations[None])
    sigma = np.maximum(HUE_SPREAD / np.maximum(lesser, 1e-6), MIN_HUE_SIGMA)
    d_saturation = scene.saturations[:, None] - landmarks.saturations[None]
    cost = np.where(np.isnan(d_hue), 0.0, (d_hue / sigma) ** 2 / 2) + (d_saturation / SATURATION_SIGMA) ** 2 / 2
    return np.minimum(cost, MAX_COLOUR_COST)


def detection_probabilities(semantic_map: SemanticMap, poses: np.ndarray, max_range: float = np.inf) -> np.ndarray:
    """Return the probability `(h, m)` that each landmark is observed from each pose: what makes evidence of a miss.

    It falls with the distance, and is small for a landmark behind another one, and 0 beyond max_range, metres.
    """
    away = semantic_map.positions[None] - poses[:, None, :2]
    distance, azimuth = np.linalg.norm(away, axis=-1), np.arctan2(away[..., 1], away[..., 0])
    chance = DETECTION_NEAR + (DETECTION_FAR - DETECTION_NEAR) * np.clip(distance / FAR_RANGE, 0.0, 1.0)
    apart = np.abs((azimuth[:, :, None] - azimuth[:, None] + np.pi) % (2 * np.pi) - np.pi)
    width = np.arctan2(OBJECT_RADIUS, distance)[:, None]
    nearer = distance[:, None] < distance[:, :, None] - OBJECT_RADIUS
    hidden = (nearer & (apart < width)).any(axis=-1)
    chance = np.where(hidden, np.minimum(chance, DETECTION_HIDDEN), chance)
    return np.where(distance > max_range, 0.0, chance)


def free_space_costs(semantic_map: SemanticMap, poses: np.ndarray) -> np.ndarray:
    """Return costs `(h,)`: `OUTSIDE_COST` for a pose inside furniture or outside the walls, as far as known; else 0."""
    distance = np.linalg.norm(semantic_map.positions[None] - poses[:, None, :2], axis=-1)
    blocked = (distance < BODY_RADIUS).any(axis=1)
    if semantic_map.walls is not None:
        blocked |= ~inside_polygon(poses[:, :2], semantic_map.walls)
    return np.where(blocked, OUTSIDE_COST, 0.0)


def inside_polygon(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return whether points `(h, 2)` are inside a polygon `(k, 2)`: an odd number of its edges is to their right."""
    x, y = points[:, 0, None], points[:, 1, None]
    ends = np.roll(corners, -1, axis=0)
    crosses = (corners[:, 1] > y) != (ends[:, 1] > y)
    rise = np.where(ends[:, 1] == corners[:, 1], 1.0, ends[:, 1] - corners[:, 1])
    at = corners[:, 0] + (y - corners[:, 1]) / rise * (ends[:, 0] - corners[:, 0])
    return (crosses & (x < at)).sum(axis=1) % 2 == 1
