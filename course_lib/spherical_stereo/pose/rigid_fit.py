"""The pose from matched points: Umeyama's least-squares fit in the plane with scale one (paper 2, section 2.6).

source: points in the body frame; target: the same points in the world. A least-squares fit always answers, even if the
pairs are wrong; `residual_statistics` asks if the residuals can be those of a right pose. The paper does not ask.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag
from scipy.stats import chi2

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.outcomes import Reason

MIN_SPREAD = 1e-3  # Metres, root mean square about the centroid. Points nearer together give no heading.
MIN_WIDTH = 0.2  # width over length: a narrower point set counts as a line, on which a mirror image does not show
MIRROR_ADVANTAGE = 3.0  # mirrored: the fit with a reflection leaves a residual smaller by this factor
GAUSS_NEWTON_STEPS = 10  # At most. On P2's practice rooms every fit is then within 0.01 mm of where a hundred end.
DOUBT = 0.001  # Share of the right poses that may be called implausible, if the covariances are exact.
NOISE_FACTOR = 1.5
"""How much larger than their covariances say the errors may be (chosen beforehand, and looked at on generated rooms,
seeds 10,000 to 10,011, from exact boxes and from images: of 66 right poses none is rejected, of 54 wrong ones 50)."""


class Pose2D(NamedTuple):
    """Pose of the body in the world: s = [x, y, theta]. Source: paper 2, section 2.6."""

    x: float  # Metres.
    y: float  # Metres.
    theta: float  # Radians, [-pi, pi), from world x to body x, counterclockwise.

    def apply(self, points: np.ndarray) -> np.ndarray:
        """Return world coordinates `(..., 2)` of points `(..., 2)` in the body frame: R(theta) p + [x, y]."""
        return np.asarray(points, dtype=np.float64) @ rotation_2d(self.theta).T + np.array([self.x, self.y])


class RigidFitError(ValueError):
    """Points that no rigid transform fits; `reason` says why."""

    def __init__(self, message: str, reason: Reason = Reason.NO_POINTS):
        super().__init__(message)
        self.reason = reason


class Residuals(NamedTuple):
    """How large the residuals of a fit are, and how large they may be under the points' covariances."""

    expected_rms: float  # Metres: the root mean square that the covariances let expect.
    chi_square: float  # Least sum of r^T C^-1 r over all poses.
    degrees_of_freedom: int  # 2 n - 3.

    @property
    def contradict_the_pose(self) -> bool:
        """Return True if no pose near this one explains the pairs: chi^2 > `NOISE_FACTOR`^2 its quantile at `DOUBT`."""
        return self.chi_square > NOISE_FACTOR**2 * chi2.isf(DOUBT, self.degrees_of_freedom)

    @property
    def normalized(self) -> float:
        """Return sqrt(chi^2 / degrees of freedom): about 1 if pairs and covariances are right."""
        return (self.chi_square / self.degrees_of_freedom) ** 0.5


def rotation_2d(theta: np.ndarray | float) -> np.ndarray:
    """Return R(theta) = [[cos, -sin], [sin, cos]], `(..., 2, 2)`, of angles theta `(...)` in radians."""
    cosine, sine = np.cos(theta), np.sin(theta)
    return np.stack([np.stack([cosine, -sine], axis=-1), np.stack([sine, cosine], axis=-1)], axis=-2)


def fit_rigid_2d(
    source: np.ndarray, target: np.ndarray, weights: np.ndarray | None = None, covariances: np.ndarray | None = None
) -> Pose2D:
    """Return the pose that takes the source points nearest to the target points, in the least-squares sense.

    min over R, t of sum_i w_i |R s_i + t - m_i|^2:
    U D V^T = svd(sum_i w_i (m_i - m_G)(s_i - s_G)^T),  R = U diag(1, det U det V) V^T,  t = m_G - R s_G

    source: `(n, 2)` body frame, target: `(n, 2)` world, metres. weights: `(n,)`, 0 leaves a pair out. covariances: `(n,
    2, 2)` of the source points, body frame; then Gauss-Newton steps make sum_i r_i^T (R C_i R^T)^-1 r_i small. The
    paper uses neither. Raises `RigidFitError`, whose reason says why there is no fit. Source: paper 2, section 2.6.
    """
    source, target, w, covariances = _checked_pairs(source, target, weights, covariances)
    start_weights = w if covariances is None else w / np.trace(covariances, axis1=1, axis2=2)
    pose = _closed_form(source, target, start_weights)
    return pose if covariances is None else _gauss_newton(pose, source, target, w, covariances)


def _closed_form(source: np.ndarray, target: np.ndarray, w: np.ndarray) -> Pose2D:
    w = w / w.sum()
    source_mean, target_mean = w @ source, w @ target
    a, b = source - source_mean, target - target_mean
    spread_a, spread_b = w @ (a**2).sum(axis=1), w @ (b**2).sum(axis=1)
    if np.sqrt(min(spread_a, spread_b)) < MIN_SPREAD:
        name = "source" if spread_a < spread_b else "target"
        raise RigidFitError(f"the {len(w)} {name} points lie at one place and give no heading", Reason.COINCIDENT)
    u, d, vt = np.linalg.svd((w[:, None] * b).T @ a)
    sign = np.linalg.det(u) * np.linalg.det(vt)
    # What the singular values leave over: the mean squared residual with a rotation, and with a reflection.
    squared = np.maximum(0.0, spread_a + spread_b - 2 * np.array([d[0] + sign * d[1], d[0] - sign * d[1]]))
    rotated, reflected = np.sqrt(squared)
    if len(w) > 2 and rotated >= MIN_SPREAD and rotated > MIRROR_ADVANTAGE * reflected:
        sizes = [np.linalg.svd(np.sqrt(w)[:, None] * points, compute_uv=False) for points in (a, b)]
        if all(width >= MIN_WIDTH * length for length, width in sizes):
            raise RigidFitError(
                f"the target points are a mirror image of the source points: with a reflection the residual is "
                f"{reflected:.3f} m, with a rotation {rotated:.3f} m; the pairs, or an axis, must be wrong",
                Reason.MIRRORED,
            )
    if d[0] + sign * d[1] < 1e-9 * np.sqrt(spread_a * spread_b):
        message = f"every heading fits these {len(w)} pairs equally badly: are they wrong?"
        raise RigidFitError(message, Reason.UNDETERMINED)
    rotation = u @ np.diag([1.0, sign]) @ vt
    x, y = target_mean - rotation @ source_mean
    return Pose2D(float(x), float(y), wrap_angle(np.arctan2(rotation[1, 0], rotation[0, 0])))


def _gauss_newton(pose: Pose2D, source, target, w, covariances) -> Pose2D:
    for _ in range(GAUSS_NEWTON_STEPS):
        residuals, jacobians, information = _linearized(pose, source, target, w, covariances)
        normal = np.einsum("nki,nkl,nlj->ij", jacobians, information, jacobians)
        gradient = np.einsum("nki,nkl,nl->i", jacobians, information, residuals)
        step = -np.linalg.solve(normal, gradient)
        pose = Pose2D(float(pose.x + step[0]), float(pose.y + step[1]), wrap_angle(pose.theta + step[2]))
        if np.abs(step).max() < 1e-12:
            break
    return pose


def _linearized(pose: Pose2D, source, target, w, covariances) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return residuals `(n, 2)`, their derivatives by [x, y, theta] `(n, 2, 3)`, and weight matrices `(n, 2, 2)`."""
    rotation = rotation_2d(pose.theta)
    residuals = pose.apply(source) - target
    jacobians = np.zeros((len(source), 2, 3))
    jacobians[:, :, :2] = np.eye(2)
    jacobians[:, :, 2] = source @ (rotation @ np.array([[0.0, -1.0], [1.0, 0.0]])).T
    information = np.tile(np.eye(2), (len(source), 1, 1))
    if covariances is not None:
        information = rotation @ np.linalg.inv(covariances) @ rotation.T
    return residuals, jacobians, w[:, None, None] * information


def fit_covariance(
    pose: Pose2D,
    source: np.ndarray,
    target: np.ndarray,
    weights: np.ndarray | None = None,
    covariances: np.ndarray | None = None,
    noise: np.ndarray | None = None,
) -> np.ndarray:
    """Return the covariance `(3, 3)` of the fitted [x, y, theta]: metres and radians, squared.

    C = A^-1 (sum J^T W N W J) A^-1,  A = sum J^T W J:  J the residuals' derivative, W what the fit weighed with

    noise: `(n, 2, 2)` covariances N of the source points, body frame. Without it they are the covariances that the fit
    used. Without both it is one variance for all, from the residuals: sum w |r|^2 / (2 n - 3). Beyond the paper.
    """
    if noise is None:
        noise = covariances
    source, target, w, covariances = _checked_pairs(source, target, weights, covariances)
    residuals, jacobians, information = _linearized(pose, source, target, w, covariances)
    inverse = np.linalg.inv(np.einsum("nki,nkl,nlj->ij", jacobians, information, jacobians))
    if noise is None:
        return inverse * (w @ (residuals**2).sum(axis=1)) / (2 * len(source) - 3)
    rotation = rotation_2d(pose.theta)
    kept = np.ones(len(noise), bool) if weights is None else np.asarray(weights) > 0
    in_world = rotation @ _checked_covariances(noise, kept) @ rotation.T
    middle = np.einsum("nki,nkl,nlm,nmo,noj->ij", jacobians, information, in_world, information, jacobians)
    return inverse @ middle @ inverse


def residual_statistics(
    pose: Pose2D, source: np.ndarray, target: np.ndarray, noise: np.ndarray, covariances: np.ndarray | None = None
) -> Residuals:
    """Return how large the residuals r_i = R s_i + t - m_i of a fit may be, and how large they are.

    r = (I - J A^-1 J^T W) e, e ~ N:  expected_rms^2 = trace cov(r) / n,  chi_square = min_x (r - J x)^T N^-1 (r - J x)

    with J, W, A and the arguments as in `fit_covariance`, the map taken as exact. Beyond the paper.
    """
    source, target, w, covariances = _checked_pairs(source, target, None, covariances)
    n = len(source)
    residuals, jacobians, information = _linearized(pose, source, target, w, covariances)
    rotation = rotation_2d(pose.theta)
    in_world = rotation @ _checked_covariances(noise, np.ones(n, bool)) @ rotation.T
    j, r = jacobians.reshape(2 * n, 3), residuals.reshape(2 * n)
    weighted = np.einsum("nki,nkl->nli", jacobians, information).reshape(2 * n, 3)
    left_over = np.eye(2 * n) - j @ np.linalg.solve(weighted.T @ j, weighted.T)
    spread = block_diag(*in_world)
    root = np.linalg.cholesky(spread)
    whitened_j, whitened_r = np.linalg.solve(root, j), np.linalg.solve(root, r)
    unexplained = whitened_r - whitened_j @ np.linalg.lstsq(whitened_j, whitened_r, rcond=None)[0]
    expected = np.sqrt(np.trace(left_over @ spread @ left_over.T) / n)
    return Residuals(float(expected), float(unexplained @ unexplained), 2 * n - 3)


def _checked_pairs(source, target, weights, covariances) -> tuple[np.ndarray, ...]:
    """Return the arguments of `fit_rigid_2d` as arrays, without pairs of weight 0."""
    source, target = (np.asarray(points, dtype=np.float64) for points in (source, target))
    n = len(source) if source.ndim else 0
    w = np.ones(n) if weights is None else np.asarray(weights, dtype=np.float64)
    for name, array, shape in (("source", source, (n, 2)), ("target", target, (n, 2)), ("weights", w, (n,))):
        if (array.shape != shape and n > 0) or not np.isfinite(array).all():
            raise RigidFitError(f"{name} must have finite values and shape {shape}; got {array.tolist()}")
    if (w < 0).any():
        raise RigidFitError(f"weights must not be negative; got {w.min():g}")
    kept = w > 0
    if kept.sum() < 2:
        raise RigidFitError(f"a pose needs at least two pairs of points; got {kept.sum()}", Reason.TOO_FEW_PAIRS)
    if covariances is not None:
        covariances = _checked_covariances(covariances, kept)
    return source[kept], target[kept], w[kept], covariances


def _checked_covariances(covariances: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """Return the `(n, 2, 2)` covariances of the kept pairs."""
    array = np.asarray(covariances, dtype=np.float64)
    if array.shape != (len(kept), 2, 2) or not np.isfinite(array).all():
        raise RigidFitError(f"covariances must be one finite (2, 2) matrix a pair; got shape {array.shape}")
    array = array[kept]
    if not np.allclose(array, np.swapaxes(array, 1, 2)) or (np.linalg.eigvalsh(array) <= 0).any():
        raise RigidFitError("every covariance must be symmetric with positive eigenvalues (square metres)")
    return array
