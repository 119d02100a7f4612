"""The Kalman filter in matrices, three ways to join two estimates that share a start, and a test of a covariance."""

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.stats import chi2

# A wagon on a line, one frame a second: state [place (m), speed (m/s)], of which only the place is measured.
F, H = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 0.0]])
Q, R = np.diag([0.02, 0.05]) ** 2, np.array([[0.3**2]])
START, START_COVARIANCE, FRAMES = np.array([0.0, 0.5]), np.diag([1.0, 0.5]) ** 2, 40
JOINS = ("as if independent", "covariance intersection", "the start counted once")


def kalman_predict(x: np.ndarray, P: np.ndarray, F: np.ndarray, Q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the predicted mean F x and covariance F P F^T + Q."""
    return F @ x, F @ P @ F.T + Q


def kalman_update(
    x: np.ndarray, P: np.ndarray, z: np.ndarray, H: np.ndarray, R: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return mean and covariance after a measurement z = H x + noise of covariance R.

    K = P H^T (H P H^T + R)^-1        x + K (z - H x)        (I - K H) P
    """
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + R)
    return x + K @ (z - H @ x), (np.eye(len(x)) - K @ H) @ P


def covariance_intersection(
    x0: np.ndarray, P0: np.ndarray, x1: np.ndarray, P1: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return mean and covariance joined with weights omega and 1 - omega, and the omega of the least trace.

    P^-1 = omega P0^-1 + (1 - omega) P1^-1        x = P (omega P0^-1 x0 + (1 - omega) P1^-1 x1)
    Source: S. Julier, J. Uhlmann, "A non-divergent estimation algorithm ..." (ACC 1997).
    """
    known = np.linalg.inv(P0), np.linalg.inv(P1)

    def joined(omega: float) -> np.ndarray:
        return np.linalg.inv(omega * known[0] + (1 - omega) * known[1])

    inside = minimize_scalar(lambda omega: np.trace(joined(omega)), bounds=(0, 1), method="bounded").x
    omega = min((0.0, float(inside), 1.0), key=lambda one: np.trace(joined(one)))  # the best may be at an end
    P = joined(omega)
    return P @ (omega * known[0] @ x0 + (1 - omega) * known[1] @ x1), P, omega


def normalized_errors(errors: np.ndarray, P: np.ndarray) -> np.ndarray:
    """Return e^T P^-1 e / d for errors (..., d) of covariance P (..., d, d): 1 in the mean if P is honest."""
    return np.einsum("...i,...ij,...j->...", errors, np.linalg.inv(P), errors) / errors.shape[-1]


def band(n: int, d: int) -> tuple[float, float]:
    """Return where the mean of n independent normalized errors of dimension d lies in 95 % of all cases."""
    return tuple(chi2.ppf([0.025, 0.975], n * d) / (n * d))


def wagon(n: int, told: float, seed: int) -> np.ndarray:
    """Return the normalized errors (T, n) of n runs whose Kalman filter is told `told` times the true sigmas in Q."""
    rng, found = np.random.default_rng(seed), np.empty((FRAMES, n))
    x, P = np.tile(START[:, None], n), START_COVARIANCE  # a column for each run
    true = x + np.sqrt(P) @ rng.standard_normal((2, n))
    for errors in found:
        true = F @ true + np.sqrt(Q) @ rng.standard_normal((2, n))
        z = H @ true + np.sqrt(R) @ rng.standard_normal((1, n))
        x, P = kalman_update(*kalman_predict(x, P, F, told**2 * Q), z, H, R)
        errors[:] = normalized_errors((x - true).T, P)
    return found


def sees(degrees: float, good: float = 2.0, poor: float = 8.0) -> np.ndarray:
    """Return the covariance (2, 2) [cm^2] of a sensor that is good in one direction and poor across it."""
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    turn = np.array([[c, -s], [s, c]])
    return turn @ np.diag([good**2, poor**2]) @ turn.T


class Joined(NamedTuple):
    """Two estimates and their join: covariances (2, 2) of a, of b, as claimed, and as they really are."""

    a: np.ndarray
    b: np.ndarray
    claimed: np.ndarray
    actual: np.ndarray

    @property
    def ratio(self) -> float:
        """Return the mean normalized error per dimension, 1 where the claim is honest."""
        return float(np.trace(np.linalg.inv(self.claimed) @ self.actual) / 2)


def join(start: np.ndarray, R_a: np.ndarray, R_b: np.ndarray, how: str) -> Joined:
    """Join two estimates that began at one start of covariance `start`; each then saw its own measurement.

    claimed^-1 = alpha a^-1 + beta b^-1 - gamma start^-1. The start enters alpha + beta - gamma times, so it is
    actual = claimed [(alpha + beta - gamma)^2 start^-1 + alpha^2 R_a^-1 + beta^2 R_b^-1] claimed.
    """
    known, seen_a, seen_b = map(np.linalg.inv, (start, R_a, R_b))
    a, b = np.linalg.inv(known + seen_a), np.linalg.inv(known + seen_b)
    alpha, beta, gamma = 1.0, 1.0, float(how == JOINS[2])
    if how == JOINS[1]:
        alpha = covariance_intersection(np.zeros(2), a, np.zeros(2), b)[2]
        beta = 1 - alpha
    times = alpha + beta - gamma
    claimed = np.linalg.inv(times * known + alpha * seen_a + beta * seen_b)
    return Joined(a, b, claimed, claimed @ (times**2 * known + alpha**2 * seen_a + beta**2 * seen_b) @ claimed)
