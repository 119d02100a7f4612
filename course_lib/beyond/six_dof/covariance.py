"""How far off a refined pose may be: what the image says of each direction, and where it says nothing, the prediction.

The normal equations at the pose say how much the residuals would grow along every direction. Were the pixels
independent, their inverse would be the covariance: tenths of a millimetre. They are not: the map's errors, the
camera's, and things that moved shift thousands of pixels at once. So the whole image counts as a number of independent
pixels, which is calibrated where nothing is reported from. Directions that the image does not show (along a smooth
wall) keep what the prediction knew, and grow from frame to frame.

What an image shows and what it does not is decided direction by direction (`fused`). Otherwise a bare wall is a trap:
the map's roughness seems to show something along it, the pose slides, the prediction takes the slide for a motion, and
the filter is as sure as ever.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from course_lib.beyond.six_dof.prediction import Rival
from course_lib.beyond.six_dof.refinement import surface_normals
from course_lib.beyond.six_dof.twists import motion_between
from course_lib.geometry import BODY_FROM_OPTICAL, rotation_exp
from course_lib.rendering.camera import DepthCamera

# Chosen on development recordings: the kitchen, the shipped corridor, and walks through rooms (seeds from 10,041 on).
INDEPENDENT_PIXELS = 20.0
SCALE = 0.05  # metres: the robust scale at which residuals are counted (the refinement's own at its end)
LEAST_SIGMA = 0.005  # metres: no map and no camera are better in everything at once
SIGNIFICANT = 2.0  # what is shown along a direction, in units of what roughness may show there by chance
PREDICTED = 0.4  # standard deviation of a prediction's error, as a share of the spread with which the cloud is drawn
RIVAL_SCALE = 0.02  # of raw score: a rival that fits worse by as much is e times less likely


def pose_information(measured: np.ndarray, image: np.ndarray, camera: DepthCamera) -> np.ndarray:
    """Inverse covariance `(6, 6)` of a pose, along and about the camera's axes, from its image alone.

    I = n (sum w J K' + K J') / (2 sum w s^2),    s^2 = sum w r^2 / sum w

    J = (n, p x n) with the normals n of the map, K = (m, p x m) with those of the measured surface: what only one of
    them shows, its roughness, is noise, and on the average adds nothing; J J' would take a rough map of a bare wall for
    a view full of corners. Zero along a direction u in which it is less than `SIGNIFICANT` times what independent
    normals would give by chance, sqrt(sum (w J.u K.u)^2).

    measured, image: `(H, W)` depth, of the camera and of the map from the pose; small images serve best, since their
    normals are less rough. n is `INDEPENDENT_PIXELS`. Zero where no pixel of both has a surface.
    """
    p = camera.points(measured)
    (q,), (n,) = surface_normals(image[None].astype(np.float64), camera)
    _, (m,) = surface_normals(np.asarray(measured, dtype=np.float64)[None], camera)
    r = np.sum(n * (p - q), axis=-1)
    used = np.isfinite(r) & np.isfinite(m).all(axis=-1)
    if not used.any():
        return np.zeros((6, 6))
    p, n, m, r = p[used], n[used], m[used], r[used]
    w = 1.0 / (1.0 + (r / SCALE) ** 2) ** 2
    of_map, of_image = (np.concatenate([normal, np.cross(p, normal)], axis=1) for normal in (n, m))
    shared = (of_map * w[:, None]).T @ of_image
    shown, directions = np.linalg.eigh((shared + shared.T) / 2)
    by_chance = np.sqrt(np.sum((w[:, None] * (of_map @ directions) * (of_image @ directions)) ** 2, axis=0))
    shown = np.where(shown < SIGNIFICANT * by_chance, 0.0, shown)
    variance = max(np.sum(w * r**2) / np.sum(w), LEAST_SIGMA**2)
    return INDEPENDENT_PIXELS / (np.sum(w) * variance) * (directions * shown) @ directions.T


def predicted_covariance(covariance: np.ndarray, motion: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """Covariance `(6, 6)` of the predicted pose, along and about its own axes.

    covariance: P `(6, 6)` of the pose before, about its axes. motion: `(6,)` predicted, in that pose's frame. spread:
    `(6,)` of the cloud about the prediction, whose own errors, covariance Q, are `PREDICTED` as large.

    Carried along: T Exp(x) M = T M Exp(A x), with A x = (R' (v + w x t), R' w), so that a direction that was not seen
    stays where it is in the world while the camera turns. Then P + Q at their worst, since a wrong velocity is wrong
    the same way frame after frame: deviations add, not variances,

    (1 + a) P + (1 + 1/a) Q,    a^2 = mean of Q's variances over P's

    which no dependence between the two exceeds.
    """
    turned_back = rotation_exp(motion[3:]).T
    carry = np.zeros((6, 6))
    carry[:3, :3] = carry[3:, 3:] = turned_back
    carry[:3, 3:] = turned_back @ np.cross(np.eye(3), motion[:3]).T
    variances = (PREDICTED * spread) ** 2
    before, noise = carry @ covariance @ carry.T, np.diag(variances)
    ratio = np.sqrt(np.mean(np.diag(before) / variances))
    return (1 + 1 / ratio) * before + (1 + ratio) * noise


def fused(prior: np.ndarray, information: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Covariance `(6, 6)` of what was predicted and what an image says, and the gain `(6, 6)`: how much of the way from
    the predicted to the image's pose to go.

    prior: P, of the prediction. information: I, inverse covariance of the image's pose; it need not have an inverse.
    Along each direction in which they are independent (eigenvectors of L' I L, with P = L L') the surer one is
    believed: where the image is less sure than the prediction it changes nothing, and where it is surer the result is
    as sure as the image alone and no more. Kalman's gain would average, and become surer with every frame; but an
    image's errors are mostly the map's, and the same in the next frame.
    """
    lower = np.linalg.cholesky(prior)
    share, directions = np.linalg.eigh(lower.T @ information @ lower)
    surer = np.maximum(share, 1.0)
    basis = lower @ directions
    covariance = (basis / surer) @ basis.T
    gain = (basis * (1.0 - 1.0 / surer)) @ np.linalg.inv(basis)
    return covariance, gain


def with_rivals(covariance: np.ndarray, pose: np.ndarray, rivals: Sequence[Rival]) -> np.ndarray:
    """Covariance `(6, 6)` about a pose `(4, 4)` of which it is not sure that it, and not a rival, is the place.

    P + sum_k p_k d_k d_k',    p_k = exp(evidence_k / RIVAL_SCALE) / 2

    d: motion from the pose to the rival. A rival that fits as well counts for one half.
    """
    for rival in rivals:
        apart = motion_between(pose, rival.pose)
        covariance = covariance + 0.5 * np.exp(rival.evidence / RIVAL_SCALE) * np.outer(apart, apart)
    return covariance


def sigmas(covariance: np.ndarray) -> np.ndarray:
    """Standard deviations `(2,)` of a pose's position and rotation along the direction that is known least: metres and
    radians."""
    return np.sqrt([np.linalg.eigvalsh(part)[-1] for part in (covariance[:3, :3], covariance[3:, 3:])])


def in_world_and_body(covariance: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Covariance `(6, 6)` along and about the camera's axes as estimates have it: metres along the world's axes,
    radians about the body's. pose: camera-to-world `(4, 4)`, optical."""
    turn = np.zeros((6, 6))
    turn[:3, :3] = pose[:3, :3]
    turn[3:, 3:] = BODY_FROM_OPTICAL
    return turn @ covariance @ turn.T
