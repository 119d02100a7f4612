"""Compute how far off a refined pose may be, from the image in some directions and from the prediction in the others.

Errors of the map and the camera shift thousands of pixels at once, so an image counts as a few independent pixels. A
direction that it does not show keeps the prediction's variance. Without this, the pose would slide on the roughness of
a bare wall.
"""

from collections.abc import Sequence

import numpy as np

from course_lib.beyond.six_dof.poses import local
from course_lib.beyond.six_dof.prediction import Rival
from course_lib.beyond.six_dof.refinement import surface_normals
from course_lib.geometry import BODY_FROM_OPTICAL, rotation_exp
from course_lib.rendering.camera import DepthCamera

# Chosen on the kitchen, the shipped corridor, and walks through rooms (seeds from 10,041 on).
INDEPENDENT_PIXELS = 20.0  # an image counts as so many, because its errors shift thousands of pixels at once
SCALE = 0.05  # metres: robust scale of the residuals, as in the last steps of the refinement
MIN_SIGMA = 0.005  # metres: no map and no camera are better
SIGNIFICANT = 2.0  # information along a direction, in units of the information that roughness gives there by chance
PREDICTED = 0.4  # standard deviation of a prediction's error, as a share of the cloud's spread
NEAR = 3.0  # standard deviations along each of six directions, on average, up to which two poses are the same
RIVAL_SCALE = 0.02  # of raw score: a rival that is worse by this much is e times less likely


def pose_information(measured: np.ndarray, image: np.ndarray, camera: DepthCamera) -> np.ndarray:
    """Return the inverse covariance `(6, 6)` of a pose, along and about the camera's axes, from its image alone.

    measured, image: `(H, W)` depth, of the camera and of the map from this pose. The equation is in `information`.
    """
    p = camera.points(measured)
    (q,), (n,) = surface_normals(image[None].astype(np.float64), camera)
    _, (m,) = surface_normals(np.asarray(measured, dtype=np.float64)[None], camera)
    r = np.sum(n * (p - q), axis=-1)
    used = np.isfinite(r) & np.isfinite(m).all(axis=-1)
    return information(p[used], n[used], m[used], r[used])


def information(p: np.ndarray, n: np.ndarray, m: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Return the inverse covariance `(6, 6)` of a pose from residuals `(K,)` of points `(K, 3)` to a surface, metres.

    I = N (sum w J K' + K J') / (2 sum w s^2),    s^2 = sum w r^2 / sum w

    J = (n, p x n) with the normals n of the surface, K = (m, p x m) with the normals m of the measured one. Roughness
    that only one of the two shows adds nothing on average. A direction u whose information is below `SIGNIFICANT`
    sqrt(sum (w J.u K.u)^2) has information 0. N is `INDEPENDENT_PIXELS`.
    """
    if not len(r):
        return np.zeros((6, 6))
    w = 1.0 / (1.0 + (r / SCALE) ** 2) ** 2
    of_map, of_image = (np.concatenate([normal, np.cross(p, normal)], axis=1) for normal in (n, m))
    shared = (of_map * w[:, None]).T @ of_image
    shown, directions = np.linalg.eigh((shared + shared.T) / 2)
    by_chance = np.sqrt(np.sum((w[:, None] * (of_map @ directions) * (of_image @ directions)) ** 2, axis=0))
    shown = np.where(shown < SIGNIFICANT * by_chance, 0.0, shown)
    variance = max(np.sum(w * r**2) / np.sum(w), MIN_SIGMA**2)
    return INDEPENDENT_PIXELS / (np.sum(w) * variance) * (directions * shown) @ directions.T


def carried(covariance: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Return the covariance `(6, 6)` of a pose after a known motion, along and about the new pose's axes: A P A'.

    T Exp(x) M = T M Exp(A x), A x = (R' (v + w x t), R' w). motion: `(6,)`, M, in the frame of the pose before.
    """
    turned_back = rotation_exp(motion[3:]).T
    carry = np.zeros((6, 6))
    carry[:3, :3] = carry[3:, 3:] = turned_back
    carry[:3, 3:] = turned_back @ np.cross(np.eye(3), motion[:3]).T
    return carry @ covariance @ carry.T


def predicted_covariance(covariance: np.ndarray, motion: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Return the covariance `(6, 6)` of the predicted pose, along and about its own axes.

    (1 + 1/a) P + (1 + a) Q,    a^2 = mean of P_ii / Q_ii

    P: the given covariance, carried along. noise: Q `(6, 6)`, the covariance of the motion `(6,)`. This sum covers any
    dependence of the two errors. P + Q would be too sure: before a bare wall, motions are wrong in the same way frame
    after frame.
    """
    before = carried(covariance, motion)
    ratio = np.sqrt(np.mean(np.diag(before) / np.diag(noise)))
    return (1 + 1 / ratio) * before + (1 + ratio) * noise


def fused(prior: np.ndarray, information: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the covariance `(6, 6)` of prediction and image together, and the gain `(6, 6)` from prediction to image.

    Along each eigenvector of L' I L (P = L L' the prior, I the image's information) the surer of the two counts alone.
    Kalman's gain would become surer with every frame. But an image's errors are mostly the map's, which are the same in
    the next frame.
    """
    lower = np.linalg.cholesky(prior)
    share, directions = np.linalg.eigh(lower.T @ information @ lower)
    surer = np.maximum(share, 1.0)
    basis = lower @ directions
    covariance = (basis / surer) @ basis.T
    gain = (basis * (1.0 - 1.0 / surer)) @ np.linalg.inv(basis)
    return covariance, gain


def is_near(apart: np.ndarray, covariance: np.ndarray) -> bool:
    """Return whether a motion d `(6,)` may be an error of this covariance P `(6, 6)`: d' P^-1 d <= 6 `NEAR`^2."""
    return bool(apart @ np.linalg.solve(covariance, apart) <= 6 * NEAR**2)


def with_rivals(covariance: np.ndarray, pose: np.ndarray, rivals: Sequence[Rival]) -> np.ndarray:
    """Return the covariance `(6, 6)` about a pose `(4, 4)` if one of its rivals may be the right pose instead.

    P + sum_k p_k d_k d_k', p_k = exp(evidence_k / RIVAL_SCALE) / 2, d: motion from the pose to the rival
    """
    for rival in rivals:
        apart = local(pose, rival.pose)
        covariance = covariance + 0.5 * np.exp(rival.evidence / RIVAL_SCALE) * np.outer(apart, apart)
    return covariance


def in_world_and_body(covariance: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Return a covariance `(6, 6)` along and about the camera's axes along the world's and about the body's axes."""
    turn = np.zeros((6, 6))
    turn[:3, :3] = pose[:3, :3]
    turn[3:, 3:] = BODY_FROM_OPTICAL
    return turn @ covariance @ turn.T
