"""Two answers to "where is the robot" made one: the semantic pose's, and the depth filter's. Beyond both papers.

A view of a bare wall leaves some of the six numbers open; the panoramas, and how a robot stands, know just these.
"""

from __future__ import annotations

import numpy as np

from course_lib.experiments.finale import LEVEL_SIGMA
from course_lib.geometry import wrap_angle

ON_THE_FLOOR = (0, 1, 5)  # of a state: x, y, yaw, what a semantic pose tells


def start_covariance(covariance: np.ndarray) -> np.ndarray:
    """Covariance `(6, 6)` of `start_state`: a semantic pose's own `(3, 3)`, and how high and level a robot stands.

    Metres and radians, squared, in the order of the state.
    """
    height, level = LEVEL_SIGMA
    known = np.diag([0.0, 0.0, height**2, level**2, level**2, 0.0])
    known[np.ix_(ON_THE_FLOOR, ON_THE_FLOOR)] = covariance
    return known


def joined(
    start: np.ndarray, covariance: np.ndarray, state: np.ndarray, state_covariance: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """State `(6,)` and covariance `(6, 6)` of two answers, each weighed by its covariance: a Kalman filter's update.

        K = P_0 (P_0 + P_1)^-1        x = x_0 + K (x_1 - x_0)        P = (1 - K) P_0

    start, covariance: what was known before the image. state, state_covariance: what the depth filter makes of the
    first image (its `error_covariance`). Differences of angles are taken on the circle; a robot stands nearly level,
    so they are rotations about its axes.
    """
    difference = state - start
    difference[3:] = wrap_angle(difference[3:])
    gain = covariance @ np.linalg.inv(covariance + state_covariance)
    found = start + gain @ difference
    found[3:] = wrap_angle(found[3:])
    return found, (np.eye(6) - gain) @ covariance
