"""Measure how far off a run was: the errors of paper 1's section 4, table 1, figures 5 and 6, and what these miss."""

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from course_lib.geometry import rotation_angle

PAPER_SIGMA = 0.10  # metres, paper 1, table 1; three of it, 0.30 m, bound the share that the table reports

# Table 1 of the paper: median (m), sigma (m), share within three sigma (percent); None where it prints n/a.
PAPER_TABLE_1 = {"proposed method": (0.07, 0.10, 99.0), "Fallon et al. [2]": (0.30, None, 90.0)}


class PositionError(NamedTuple):
    """Errors of one run and the three numbers of table 1."""

    errors: np.ndarray  # `(T,)` metres, one a frame
    median: float  # metres
    sigma: float  # root mean square about zero, metres
    within_3sigma: float  # share of errors of at most three of the paper's sigma (0.30 m), 0 to 1


def nearest_path_error(estimated_xyz: np.ndarray, true_path_xyz: np.ndarray) -> PositionError:
    """Return the paper's error: from each estimated position to the nearest point of the true path, horizontally.

    e_t = min_k | (x_t, y_t) - (x_k, y_k) |

    estimated_xyz: `(T, 2 or 3)`, true_path_xyz: `(P, 2 or 3)` metres; z is ignored: the truth is a line on the floor
    below the camera. It does not ask *when* the camera was at that point, so it hides every error along the path:
    `timed_error` beside it does not. Raises `ValueError` for shapes that do not fit or values that are not finite.
    Source: paper 1, section 4, table 1, figures 5, 6.
    """
    estimated, path = _horizontal(estimated_xyz, "estimated_xyz"), _horizontal(true_path_xyz, "true_path_xyz")
    return summarize(cKDTree(path).query(estimated)[0])


def timed_error(estimated_xyz: np.ndarray, true_xyz: np.ndarray) -> PositionError:
    """Return the horizontal distance between estimate and truth of the same frame: `(T, 2 or 3)` metres both."""
    estimated, true = _horizontal(estimated_xyz, "estimated_xyz"), _horizontal(true_xyz, "true_xyz")
    if estimated.shape != true.shape:
        raise ValueError(f"estimate and truth must hold one position a frame; got {estimated.shape} and {true.shape}")
    return summarize(np.linalg.norm(estimated - true, axis=1))


def summarize(errors: np.ndarray) -> PositionError:
    """Return median, sigma about zero, and share within three of the paper's sigma, of errors `(T,)` in metres."""
    errors = np.asarray(errors, dtype=np.float64)
    within = np.mean(errors <= 3 * PAPER_SIGMA)
    return PositionError(errors, float(np.median(errors)), float(np.sqrt(np.mean(errors**2))), float(within))


def pose_errors(estimated: np.ndarray, true: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return metres and radians between poses `(..., 4, 4)`: |t_a - t_b| and the angle of R_a^T R_b."""
    position = np.linalg.norm(estimated[..., :3, 3] - true[..., :3, 3], axis=-1)
    relative = np.swapaxes(estimated[..., :3, :3], -1, -2) @ true[..., :3, :3]
    return position, rotation_angle(relative)


def _horizontal(positions: np.ndarray, name: str) -> np.ndarray:
    positions = np.asarray(positions, dtype=np.float64)
    if positions.ndim != 2 or positions.shape[1] not in (2, 3) or len(positions) == 0:
        raise ValueError(f"{name} must have shape (T, 2) or (T, 3), T at least 1; got {positions.shape}")
    if not np.isfinite(positions).all():
        raise ValueError(f"{name} must be finite; got NaN or infinity")
    return positions[:, :2]
