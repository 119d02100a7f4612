"""How far off a refined pose may be: what the image says of each direction, and where it says nothing, the prediction.

The normal equations at the pose say how much the residuals would grow along every direction. Were the pixels
independent, their inverse would be the covariance: tenths of a millimetre. They are not: the map's errors, the
camera's, and things that moved shift thousands of pixels at once. So the whole image counts as a number of independent
pixels, which is calibrated where nothing is reported from. Directions that the image does not show (along a smooth
wall) keep what the prediction knew, and grow from frame to frame.

Not solved: before a bare wall the pose slides along it from frame to frame and this covariance does not grow as fast
(RESULTS 1.3). Likely, not proven: the map's noise seems to show something along the wall, and is counted anew in every
frame; and the prediction takes the slide for a motion.
"""

from __future__ import annotations

import numpy as np

from course_lib.depth_mcl.annealed.compiled_refinement import normal_equations
from course_lib.depth_mcl.camera import DepthCamera
from course_lib.geometry import BODY_FROM_OPTICAL

INDEPENDENT_PIXELS = 20.0
SCALE = 0.05  # metres: the robust scale at which residuals are counted (the refinement's own at its end)
LEAST_SIGMA = 0.005  # metres: no map and no camera are better in everything at once


def pose_information(measured: np.ndarray, image: np.ndarray, camera: DepthCamera) -> np.ndarray:
    """Inverse covariance `(6, 6)` of a pose, along and about the camera's axes, from its image alone.

    I = n (sum w J J') / (sum w s^2),    s^2 = sum w r^2 / sum w

    measured, image: `(H, W)` depth, of the camera and of the map from the pose. n is `INDEPENDENT_PIXELS`. Zero where
    no pixel of both has a surface.
    """
    system = normal_equations(measured, image[None], camera, SCALE)
    if system.weights[0] == 0:
        return np.zeros((6, 6))
    variance = max(system.squares[0] / system.weights[0], LEAST_SIGMA**2)
    return INDEPENDENT_PIXELS * system.matrices[0] / (system.weights[0] * variance)


def fused(prior: np.ndarray, information: np.ndarray) -> np.ndarray:
    """Covariance `(6, 6)` of what was known before and what an image says: (P^-1 + I)^-1, without inverting I."""
    return np.linalg.solve(np.eye(6) + prior @ information, prior)


def in_world_and_body(covariance: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Covariance `(6, 6)` along and about the camera's axes as estimates have it: metres along the world's axes,
    radians about the body's. pose: camera-to-world `(4, 4)`, optical."""
    turn = np.zeros((6, 6))
    turn[:3, :3] = pose[:3, :3]
    turn[3:, 3:] = BODY_FROM_OPTICAL
    return turn @ covariance @ turn.T
