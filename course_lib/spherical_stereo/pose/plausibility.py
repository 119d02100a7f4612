"""Do the residuals of a fit contradict it? What the paper does not ask, and a wrong pose is found by (section 2.6).

A least-squares fit always answers. Where the pairs are wrong, or a length was typed in millimetres, the observed
objects do not land on their landmarks, and by how much they may miss them their covariances tell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag
from scipy.stats import chi2

from course_lib.spherical_stereo.pose.rigid_fit import (
    Pose2D,
    checked_covariances,
    checked_pairs,
    linearized,
    rotation_2d,
)

DOUBT = 0.001
"""Share of the right poses that may be called implausible, were the covariances exact."""
NOISE_FACTOR = 1.5
"""How much larger than their covariances say the errors may be (chosen beforehand, and looked at on generated rooms,
seeds 10,000 to 10,011, from exact boxes and from images: of 66 right poses none is rejected, of 54 wrong ones 50)."""


class Residuals(NamedTuple):
    """How large the residuals of a fit are, and how large they may be."""

    expected_rms: float
    """Metres: the root mean square that the points' covariances let expect."""
    chi_square: float
    """Least sum of r^T C^-1 r over all poses: of 2 n - 3 numbers, and their mean, when the covariances are right."""
    degrees_of_freedom: int
    """2 n - 3."""

    @property
    def greatest_chi_square(self) -> float:
        """What chi^2 may be: `NOISE_FACTOR`^2 times its quantile at `DOUBT`."""
        return NOISE_FACTOR**2 * float(chi2.isf(DOUBT, self.degrees_of_freedom))

    @property
    def contradict_the_pose(self) -> bool:
        """Whether no pose near this one explains the pairs."""
        return self.chi_square > self.greatest_chi_square

    @property
    def normalized(self) -> float:
        """sqrt(chi^2 / degrees of freedom): about 1 when pairs and covariances are right."""
        return (self.chi_square / self.degrees_of_freedom) ** 0.5


def residual_statistics(
    pose: Pose2D,
    source: np.ndarray,
    target: np.ndarray,
    noise: np.ndarray,
    covariances: np.ndarray | None = None,
) -> Residuals:
    """How large the residuals r_i = R s_i + t - m_i of a fit may be, and how large they are, under the points' noise.

    r = (I - J A^-1 J^T W) e, e ~ N:  expected_rms^2 = trace cov(r) / n,  chi_square = min_x (r - J x)^T N^-1 (r - J x)

    with J, W and A as in `fit_covariance`. pose, source, target, covariances: as given to, and returned by,
    `fit_rigid_2d`. noise: `(n, 2, 2)` covariances N of the source points in the body frame, the map taken as exact.
    The statistic depends on the pairs, not on how the fit weighed: it asks whether any pose near this one explains
    them. Two pairs leave one number, the difference of the two distances. Raises `RigidFitError` as `fit_rigid_2d`.
    Source: paper 2, section 2.6 gives none.
    """
    source, target, w, covariances = checked_pairs(source, target, None, covariances)
    n = len(source)
    residuals, jacobians, information = linearized(pose, source, target, w, covariances)
    rotation = rotation_2d(pose.theta)
    in_world = rotation @ checked_covariances(noise, slice(None), n) @ rotation.T
    j, r = jacobians.reshape(2 * n, 3), residuals.reshape(2 * n)
    weighted = np.einsum("nki,nkl->nli", jacobians, information).reshape(2 * n, 3)
    left_over = np.eye(2 * n) - j @ np.linalg.solve(weighted.T @ j, weighted.T)
    spread = block_diag(*in_world)
    root = np.linalg.cholesky(spread)
    whitened_j, whitened_r = np.linalg.solve(root, j), np.linalg.solve(root, r)
    unexplained = whitened_r - whitened_j @ np.linalg.lstsq(whitened_j, whitened_r, rcond=None)[0]
    expected = np.sqrt(np.trace(left_over @ spread @ left_over.T) / n)
    return Residuals(float(expected), float(unexplained @ unexplained), 2 * n - 3)
