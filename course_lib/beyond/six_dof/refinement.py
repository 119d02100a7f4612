"""From a pose near the right one to the right one: Gauss-Newton on the rendered depth.

A particle filter finds the valley, and needs ever more particles to find its lowest point. A valley's lowest point has
a formula. The map as seen from a pose is a depth image, so every pixel holds a point q of the map and, from its
neighbours, the surface's normal n there; the same pixel of the camera holds a measured point p. If the pose were right,
p would lie on that surface:

    r_j = n_j . (p_j - q_j)

A small motion (v, w) of the camera moves p to p + v + w x p, and to first order r_j by n . v + (p x n) . w. The motion
that makes sum_j rho(r_j) least, rho robust because doors stand open and people walk by, solves

    (sum_j w_j J_j J_j') (v, w) = - sum_j w_j J_j r_j,    J_j = (n_j, p_j x n_j)

Then it is rendered again from there. It is ICP with the z-buffer in place of a search for nearest points; every step of
every pose costs one render.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.twists import lengths, moved
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.renderer import DepthRenderer

# Neighbours on one surface: their depths differ by at most this much of the depth for every thousandth of a radian
# between their rays (chosen: a surface seen at less than about 7 degrees of grazing gives no normal).
EDGE_PER_RADIAN = 8.0
DAMPING = 1e-4  # added to the mean of J J': along what the image does not show, the pose stays where it is (chosen)
LONGEST_STEP = (0.2, 0.3)  # metres, radians: beyond them the first order says nothing (chosen)


class NormalEquations(NamedTuple):
    """The system of one Gauss-Newton step for `N` poses; sums over pixels."""

    matrices: np.ndarray
    """`(N, 6, 6)` sum w J J'."""
    vectors: np.ndarray
    """`(N, 6)` sum w J r."""
    squares: np.ndarray
    """`(N,)` sum w r^2, square metres."""
    weights: np.ndarray
    """`(N,)` sum w: how many pixels took part."""


def surface_normals(images: np.ndarray, camera: DepthCamera) -> tuple[np.ndarray, np.ndarray]:
    """Points `(N, H, W, 3)` of depth images `(N, H, W)` in the optical frame and the surface's unit normals there.

    n ~ (q_right - q_left) x (q_below - q_above); NaN on the image's border, at a miss, and beside an edge, where the
    neighbours belong to another surface.
    """
    points = camera.rays() * np.where(np.isfinite(images), images, np.nan)[..., None]
    normals = np.full(points.shape, np.nan)
    right, left = points[:, 1:-1, 2:], points[:, 1:-1, :-2]
    below, above = points[:, 2:, 1:-1], points[:, :-2, 1:-1]
    cross = np.cross(right - left, below - above)
    middle = points[:, 1:-1, 1:-1, 2]
    limit = edge_share(camera) * middle
    same = np.ones(middle.shape, dtype=bool)
    with np.errstate(invalid="ignore", divide="ignore"):
        for neighbour in (right, left, below, above):
            same &= np.abs(neighbour[..., 2] - middle) <= limit
        cross /= np.linalg.norm(cross, axis=-1, keepdims=True)
    normals[:, 1:-1, 1:-1] = np.where(same[..., None], cross, np.nan)
    return points, normals


def edge_share(camera: DepthCamera) -> float:
    """The greatest difference in depth of neighbours on one surface, as a share of the depth."""
    return EDGE_PER_RADIAN / max(camera.fx, camera.fy)


def normal_equations(measured: np.ndarray, images: np.ndarray, camera: DepthCamera, scale: float) -> NormalEquations:
    """One Gauss-Newton step for the poses that `images` were rendered from.

    measured: `(H, W)` depth, NaN = no measurement. images: `(N, H, W)` depth of the map, `inf` = nothing hit.
    scale: metres; a residual as large counts a quarter, w = 1 / (1 + (r / scale)^2)^2 (Geman and McClure).
    The equation as one reads it; `compiled_refinement.normal_equations` gives the same numbers faster.
    """
    p = camera.points(measured)
    q, n = surface_normals(np.asarray(images, dtype=np.float64), camera)
    r = np.sum(n * (p - q), axis=-1)
    jacobian = np.concatenate([n, np.cross(np.broadcast_to(p, n.shape), n)], axis=-1)
    used = np.isfinite(r)
    w = np.where(used, 1.0 / (1.0 + (np.where(used, r, 0.0) / scale) ** 2) ** 2, 0.0)
    r, jacobian = np.where(used, r, 0.0), np.where(used[..., None], jacobian, 0.0)
    return NormalEquations(
        np.einsum("nhw,nhwi,nhwj->nij", w, jacobian, jacobian),
        np.einsum("nhw,nhwi,nhw->ni", w, jacobian, r),
        np.einsum("nhw,nhw,nhw->n", w, r, r),
        w.sum(axis=(1, 2)),
    )


def solve(system: NormalEquations, damping: float = DAMPING) -> np.ndarray:
    """The motions `(N, 6)` that the normal equations ask for, none longer than `LONGEST_STEP`.

    Damped in the manner of Levenberg: a direction in which no pixel changes stays as it is.
    """
    pixels = np.maximum(system.weights, 1.0)
    mean = system.matrices / pixels[:, None, None] + damping * np.eye(6)
    motions = -np.linalg.solve(mean, (system.vectors / pixels[:, None])[..., None])[..., 0]
    too_long = (lengths(motions) / LONGEST_STEP).max(axis=-1)
    return motions / np.maximum(too_long, 1.0)[:, None]


def gauss_newton_step(
    measured: np.ndarray, images: np.ndarray, camera: DepthCamera, poses: np.ndarray, scale: float
) -> np.ndarray:
    """Camera-to-world poses `(N, 4, 4)` moved to where the images `(N, H, W)` rendered from them ask for.

    Arguments as in `normal_equations`, whose compiled form this uses.
    """
    from course_lib.beyond.six_dof.compiled_refinement import normal_equations as compiled_equations

    return moved(poses, solve(compiled_equations(measured, images, camera, scale)))


def refine(renderer: DepthRenderer, measured: np.ndarray, poses: np.ndarray, scales: Sequence[float]) -> np.ndarray:
    """Poses `(N, 4, 4)` (camera to world, optical) after one Gauss-Newton step for each of `scales`, in metres.

    measured: `(H, W)` depth of the renderer's camera. N renders a step.
    """
    for scale in scales:
        poses = gauss_newton_step(measured, renderer.render_poses(poses), renderer.camera, poses, scale)
    return poses
