"""Ambiguity of a room before any run: from where would which objects be taken for which others?

At every place of a grid, what a rig would observe is drawn from the map, and a matcher says what it makes of it.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.evidence import detection_probabilities, free_space_costs
from course_lib.beyond.look_alikes.matchers import matcher
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from course_lib.spherical_stereo.ranging.object_positions import Noise
from course_lib.spherical_stereo.ranging.triangulation import triangulation_covariance
from course_lib.spherical_stereo.semantic_map.association import Association, Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

OBJECT_HEIGHT = 0.5  # m above the floor of an object's middle, which a 2D map does not know; chosen: a sofa's back
RIG = StereoRig(0.3, 1.32)  # the paper's, at its lower height


class AmbiguityMap(NamedTuple):
    """k places of a grid, and what would be believed there."""

    places: np.ndarray  # `(k, 2)` metres, on the map; only where a rig can stand
    confidence: np.ndarray  # `(k,)` mean confidence of the right pose, 0 where it is not the most believed one
    """Of a matcher without confidence: the share of draws in which all its matches are right."""
    confused: np.ndarray  # `(k, m, m)` share of the belief by which landmark i is taken for landmark j
    step: float  # Metres between neighbours

    def most_confused(self, n: int = 5) -> list[tuple[int, int, float]]:
        """Return the n pairs of landmarks that are confused most, (i, j, mean share over all places), i < j."""
        both = self.confused.mean(axis=0)
        both = both + both.T
        i, j = np.triu_indices(len(both), 1)
        order = np.argsort(-both[i, j])[:n]
        return [(int(i[k]), int(j[k]), float(both[i[k], j[k]])) for k in order if both[i[k], j[k]] > 0]


def imagined_observations(
    semantic_map: SemanticMap, pose: np.ndarray, rng: np.random.Generator
) -> tuple[list[Observation], list[int]]:
    """Draw what a rig at a pose `(3,)` [x, y, theta] would observe, and which landmark each observation shows.

    Every landmark is seen with its chance, with stereo noise, in the map's colour: confused is what its place confuses.
    """
    chance = detection_probabilities(semantic_map, np.asarray(pose, dtype=np.float64)[None])[0]
    seen = np.flatnonzero(rng.random(len(semantic_map)) < chance)
    places = (semantic_map.positions[seen] - pose[:2]) @ rotation_2d(pose[2])  # R^T (m - t), row by row
    observations = []
    for landmark, place in zip(seen, places, strict=True):
        covariance = stereo_covariance(place)
        x, y = rng.multivariate_normal(place, covariance)
        one = semantic_map.landmarks[landmark]
        observations.append(Observation(one.label, float(x), float(y), one.hue, one.saturation, covariance))
    return observations, [int(landmark) for landmark in seen]


def stereo_covariance(place: np.ndarray) -> np.ndarray:
    """Return the covariance `(2, 2)` of an object at a place `(2,)` in the body frame, as `position_objects` does."""
    upper = np.array([*place, OBJECT_HEIGHT - RIG.upper_height])
    lower = upper + np.array([0.0, 0.0, RIG.baseline])
    sigma, centroid, _ = Noise()
    return triangulation_covariance(upper, lower, RIG.baseline, sigma, sigma)[:2, :2] + centroid**2 * np.eye(2)


def ambiguity_map(
    semantic_map: SemanticMap,
    rng: np.random.Generator,
    step: float = 0.5,
    draws: int = 4,
    association: str = "consistent",
    progress: Callable = iter,
) -> AmbiguityMap:
    """Return the belief at every free place of a grid over the map, averaged over `draws` of what would be seen.

    step: metres between places. association: the matcher whose confusions are asked for.
    """
    outline = semantic_map.positions if semantic_map.walls is None else semantic_map.walls
    low, high = outline.min(axis=0), outline.max(axis=0)
    x, y = (np.arange(a + step / 2, b, step) for a, b in zip(low, high, strict=True))
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    grid = grid[free_space_costs(semantic_map, np.column_stack([grid, np.zeros(len(grid))])) == 0]
    confidence, confused = np.zeros(len(grid)), np.zeros((len(grid), len(semantic_map), len(semantic_map)))
    for k, place in enumerate(progress(grid)):
        for _ in range(draws):
            pose = np.array([*place, rng.uniform(-np.pi, np.pi)])
            observations, shown = imagined_observations(semantic_map, pose, rng)
            if not observations:
                continue
            found = matcher(association)(observations, semantic_map)
            right, wrong = judged_belief(found, shown, place, step)
            confidence[k] += right / draws
            for i, j, share in wrong:
                confused[k, i, j] += share / draws
    return AmbiguityMap(grid, confidence, confused, step)


def judged_belief(found: Association, shown: list[int], place: np.ndarray, near: float) -> tuple[float, list]:
    """Return the confidence in the right pose, and the wrong matches: (landmark shown, landmark taken, share).

    shown: the landmark of every observation. A pose is right within `near` metres of the place.
    """
    if found.confidence is None:
        wrong = [(shown[i], j, 1.0) for i, j in found.usable_pairs if shown[i] != j]
        return float(not wrong), wrong
    wrong = [(shown[i], j, one.share) for one in found.hypotheses for i, j in one.pairs if shown[i] != j]
    is_near = bool(found.hypotheses) and np.hypot(*(np.array(found.hypotheses[0].pose[:2]) - place)) < near
    return found.confidence if is_near else 0.0, wrong
