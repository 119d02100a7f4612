"""Check whether the images fit the camera's intrinsics. A wrong focal length moves the pose, which hides most of it.

Let c be the correction to add to the given (log f, cx / width, cy / height). The point of a pixel,
p = ((u - cx) z / fx, (v - cy) z / fy, z), moves with c by

    dp/dc = -(p_x, p_y, 0),    -(z width / fx, 0, 0),    -(0, z height / fy, 0)

so the residual r = n . (p - q) of refinement.py has the derivatives J = (n, p x n) by the pose and C = n . dp/dc by c.
In one image a motion of the camera explains nearly all of C c. But each image has its own pose, and all images have the
same c. So we eliminate the poses by the Schur complement, and sum over images:

    c = -A^-1 b,    A = 1 / PRIOR^2 + sum s (C'WC - C'WJ (J'WJ)^-1 J'WC),    b = sum s (C'Wr - C'WJ (J'WJ)^-1 J'Wr)

A^-1 is the covariance of c, and the scale s of an image is that of covariance.py. An error of c moves a pose by K c,
K = (J'WJ)^-1 J'WC. On development recordings c had 60 to 95 % of an error of 5 %, because wrong poses hide the rest.
"""

from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.covariance import INDEPENDENT_PIXELS, MIN_SIGMA, SCALE
from course_lib.beyond.six_dof.refinement import DAMPING, surface_normals
from course_lib.rendering.camera import DepthCamera

# Chosen on the kitchen, the rooms of a HoloLens and the shipped corridor.
PIXELS = 4_800  # of an image that are used, which saves time
PRIOR = 0.02  # standard deviation of log f, cx / width and cy / height before any image
MAP_SIGMA = 0.004  # their least standard deviation after any number of images, because the map has errors, too
SIGNIFICANT = 4.0  # standard deviations by which intrinsics must be off before we doubt them
ROUNDS = 3  # of reweighting: a residual that the pose and c explain shall count fully


class Calibration(NamedTuple):
    """An estimate of the error of a camera's intrinsics."""

    correction: np.ndarray  # `(3,)` to add to the given log f, cx / width and cy / height.
    covariance: np.ndarray  # `(3, 3)` of its error.
    images: int  # How many images were used.

    @property
    def doubted(self) -> np.ndarray:
        """Return which of the three `(3,)` are off by more than `SIGNIFICANT` standard deviations."""
        return np.abs(self.correction) > SIGNIFICANT * np.sqrt(np.diag(self.covariance))

    def sentence(self, camera: DepthCamera) -> str | None:
        """Return in one sentence which intrinsics of the given camera are doubted; None if none are."""
        size = np.array([1.0, camera.width, camera.height])
        (log_f, x, y), (sigma, *sigmas) = self.correction * size, np.sqrt(np.diag(self.covariance)) * size
        percent = f"{100 * np.expm1(log_f):+.1f} +- {100 * sigma:.1f} %"
        given = camera.fx
        changes = [f"a focal length of {given * np.exp(log_f):.0f} px better than the given {given:.0f} ({percent})"]
        for name, off, error in zip(("cx", "cy"), (x, y), sigmas, strict=True):
            given = getattr(camera, name)
            changes.append(f"{name} = {given + off:.1f} px better than the given {given:.1f} (+- {error:.1f} px)")
        doubts = [change for change, doubted in zip(changes, self.doubted, strict=True) if doubted]
        return f"the images fit {' and '.join(doubts)}" if doubts else None


class CalibrationCheck:
    """Collect images from known poses, and estimate which intrinsics fit them. The images may differ in size."""

    def __init__(self) -> None:
        self._information = np.eye(3) / PRIOR**2
        self._vector = np.zeros(3)
        self._images = 0

    def add(self, measured: np.ndarray, image: np.ndarray, camera: DepthCamera) -> None:
        """Take an image from a known pose into account.

        measured, image: `(H, W)` depth, of the camera and of the map from this pose.
        """
        matrix, vector = _system(measured, image, camera, self.estimate().correction)
        gain = np.linalg.solve(matrix[:6, :6], np.column_stack([matrix[:6, 6:], vector[:6]]))
        self._information += matrix[6:, 6:] - matrix[6:, :6] @ gain[:, :3]
        self._vector += vector[6:] - matrix[6:, :6] @ gain[:, 3]
        self._images += 1

    def estimate(self) -> Calibration:
        """Return the estimate from all images until now; without any, the correction is 0."""
        covariance = np.linalg.inv(self._information)
        return Calibration(-covariance @ self._vector, covariance + MAP_SIGMA**2 * np.eye(3), self._images)

    def pose_covariance(self, measured: np.ndarray, image: np.ndarray, camera: DepthCamera) -> np.ndarray:
        """Return the covariance `(6, 6)` of the pose's error that wrong intrinsics cause, along and about its axes.

        K (c c' + P) K', with P the covariance of c. Arguments as in `add`.
        """
        correction, covariance, _ = self.estimate()
        matrix, _ = _system(measured, image, camera, correction)
        by_c = np.linalg.solve(matrix[:6, :6], matrix[:6, 6:])
        return by_c @ (np.outer(correction, correction) + covariance) @ by_c.T


def _system(
    measured: np.ndarray, image: np.ndarray, camera: DepthCamera, correction: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the normal equations `(9, 9)`, `(9,)` of a pose and c, times the scale s, from about `PIXELS` pixels."""
    k = max(1, round(np.sqrt(measured.size / PIXELS)))
    measured, image = (np.asarray(one, dtype=np.float64)[::k, ::k] for one in (measured, image))
    seen = camera.every(k)
    p = seen.points(measured)
    (q,), (n,) = surface_normals(image[None], seen)
    r = np.sum(n * (p - q), axis=-1)
    used = np.isfinite(r)
    p, n, r = p[used], n[used], r[used]
    size = np.array([camera.width / camera.fx, camera.height / camera.fy])
    by_c = -np.column_stack([np.sum(n[:, :2] * p[:, :2], axis=1), n[:, :2] * p[:, 2:] * size])
    by_pose = np.concatenate([n, np.cross(p, n)], axis=1)
    jacobian, explained, left = np.concatenate([by_pose, by_c], axis=1), r + by_c @ correction, r
    for _ in range(ROUNDS):
        w = 1.0 / (1.0 + (left / SCALE) ** 2) ** 2
        total = np.sum(w) + 1e-9
        matrix = (jacobian * w[:, None]).T @ jacobian
        matrix[:6, :6] += DAMPING * total * np.eye(6)  # along what the image does not show, the pose stays
        left = explained - by_pose @ np.linalg.solve(matrix[:6, :6], by_pose.T @ (w * explained))
    scale = INDEPENDENT_PIXELS / (total * max(np.sum(w * left**2) / total, MIN_SIGMA**2))
    return scale * matrix, scale * (jacobian.T @ (w * r))
