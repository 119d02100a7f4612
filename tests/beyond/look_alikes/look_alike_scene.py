"""A room that is the same after half a turn, and what a rig sees there without noise."""

import numpy as np

from course_lib.spherical_stereo.pose.rigid_fit import rotation_2d
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap

BLUE, RED = (240.0, 60.0), (0.0, 60.0)
SYMMETRIC = SemanticMap(
    [
        Landmark("sofa", 2.0, 1.0, *BLUE),
        Landmark("sofa", -2.0, -1.0, *BLUE),
        Landmark("sofa", 0.0, 0.0, *BLUE),
        Landmark("chair", 1.0, -2.0, *RED),
        Landmark("chair", -1.0, 2.0, *RED),
    ],
    walls=[[-3, -3], [3, -3], [3, 3], [-3, 3]],
)
POSE = np.array([1.2, -0.7, 0.4])
OTHER_POSE = np.array([-1.2, 0.7, 0.4 - np.pi])


PLANT = Landmark("potted plant", -1.5, -2.0, 120.0, 50.0)
PLANTED = SemanticMap((*SYMMETRIC.landmarks, PLANT), SYMMETRIC.walls)


def stereo_covariance(place):
    """Certain across the ray, less so along it, as a stereo camera's places are."""
    distance = np.hypot(*place)
    along = np.asarray(place) / distance
    across = np.array([-along[1], along[0]])
    return (0.05 + 0.02 * distance**2) ** 2 * np.outer(along, along) + 0.05**2 * np.outer(across, across)


def observed(semantic_map, pose, which=None, rng=None):
    """Observations of landmarks (all, or those of the indices) from a pose; rng: with noise of their covariances."""
    indices = range(len(semantic_map)) if which is None else which
    observations = []
    for index in indices:
        one = semantic_map.landmarks[index]
        place = rotation_2d(pose[2]).T @ (semantic_map.positions[index] - pose[:2])
        covariance = stereo_covariance(place)
        if rng is not None:
            place = rng.multivariate_normal(place, covariance)
        observations.append(Observation(one.label, *map(float, place), one.hue, one.saturation, covariance))
    return observations


def turned(semantic_map, angle, shift=(0.0, 0.0)):
    rotation = rotation_2d(angle)
    landmarks = [
        Landmark(one.label, *map(float, rotation @ (one.x, one.y) + shift), one.hue, one.saturation)
        for one in semantic_map.landmarks
    ]
    return SemanticMap(landmarks, np.asarray(semantic_map.walls) @ rotation.T + shift)


def scattered(rng):
    labels = ("sofa",) * 3 + ("chair",) * 2 + ("table",) * 2 + ("potted plant",)
    objects = [Landmark(label, *map(float, rng.uniform(-3, 3, 2).round(1)), *BLUE) for label in labels]
    return SemanticMap(objects, SYMMETRIC.walls)
