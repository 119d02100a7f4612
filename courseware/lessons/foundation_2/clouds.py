"""Clouds of orientations, and how far three kinds of mean are from their middle."""

import numpy as np

from course_lib.depth_mcl.motion import TANGENT_SPACE
from course_lib.depth_mcl.particle_filter import weighted_mean_pose, weighted_mean_state
from course_lib.geometry import pose_matrix, rotation_angle

MEANS = ("plain numbers", "angles on a circle", "rotations")


def cloud_about(angles: np.ndarray, sigma: float, n: int = 200, seed: int = 0) -> np.ndarray:
    """Return states `(n, 6)` about roll, pitch, yaw `(3,)`, turned by sigma [rad] about each axis of the body."""
    state = np.concatenate([np.zeros(3), angles])
    noise = np.repeat([0.0, sigma], 3)
    return TANGENT_SPACE.propagate(np.tile(state, (n, 1)), noise, np.random.default_rng(seed))


def means_of(states: np.ndarray) -> np.ndarray:
    """Return three mean states `(3, 6)` in the order of `MEANS`. The last two are those of the filter."""
    w = np.full(len(states), 1 / len(states))
    plain = np.concatenate([np.zeros(3), states[:, 3:].mean(axis=0)])
    return np.array([plain, weighted_mean_state(states, w), weighted_mean_pose(states, w)])


def mean_errors(pitch: float, sigma: float, trials: int = 40) -> np.ndarray:
    """Return how far the three means are from the middle of clouds, radians `(trials, 3)`; pitch, sigma: radians."""
    middle = np.array([0.2, pitch, 0.6])
    rotation = pose_matrix(np.concatenate([np.zeros(3), middle]))[:3, :3]
    means = [means_of(cloud_about(middle, sigma, seed=seed)) for seed in range(trials)]
    return rotation_angle(rotation.T @ pose_matrix(np.array(means))[..., :3, :3])
