"""Move a pose near the right one to the right one, by Gauss-Newton on the rendered depth.

The map rendered from a pose is a depth image. So every pixel has a point q of the map and, from its neighbours, the
surface's normal n. The same pixel of the camera has a measured point p. If the pose is right, p lies on that surface:

    r_j = n_j . (p_j - q_j) = 0

A small motion (v, w) of the camera moves p to p + v + w x p, and it changes r_j to first order by n . v + (p x n) . w.
Doors stand open and people walk by, so we need a robust rho. The motion of the smallest sum_j rho(r_j) solves

    (sum_j w_j J_j J_j') (v, w) = - sum_j w_j J_j r_j,    J_j = (n_j, p_j x n_j)

Then the map is rendered again from the new pose. This is ICP with the z-buffer in place of a search for nearest points.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.beyond.six_dof.poses import lengths, retract
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.compiled import compiled
from course_lib.rendering.renderer import DepthRenderer

# Neighbours on one surface differ in depth by at most this share for every radian between their rays. Chosen: a surface
# seen under less than about 7 degrees of grazing has no normal then.
EDGE_PER_RADIAN = 8.0
DAMPING = 1e-4  # added to the mean of J J', so that the pose stays along what the image does not show (chosen)
LONGEST_STEP = (0.2, 0.3)  # metres, radians: the first order is not valid beyond them (chosen)


class NormalEquations(NamedTuple):
    """The system of one Gauss-Newton step for `N` poses; sums over pixels."""

    matrices: np.ndarray  # `(N, 6, 6)` sum w J J'.
    vectors: np.ndarray  # `(N, 6)` sum w J r.
    weights: np.ndarray  # `(N,)` sum w: how many pixels took part.


def surface_normals(images: np.ndarray, camera: DepthCamera) -> tuple[np.ndarray, np.ndarray]:
    """Return points `(N, H, W, 3)` of depth images `(N, H, W)` in the optical frame, and the unit normals there.

    n ~ (q_right - q_left) x (q_below - q_above); NaN on the image's border, at a miss, and next to an edge.
    """
    points = camera.rays() * np.where(np.isfinite(images), images, np.nan)[..., None]
    normals = np.full(points.shape, np.nan)
    right, left = points[:, 1:-1, 2:], points[:, 1:-1, :-2]
    below, above = points[:, 2:, 1:-1], points[:, :-2, 1:-1]
    cross = np.cross(right - left, below - above)
    middle = points[:, 1:-1, 1:-1, 2]
    limit = _edge_share(camera) * middle
    same = np.ones(middle.shape, dtype=bool)
    with np.errstate(invalid="ignore", divide="ignore"):
        for neighbour in (right, left, below, above):
            same &= np.abs(neighbour[..., 2] - middle) <= limit
        cross /= np.linalg.norm(cross, axis=-1, keepdims=True)
    normals[:, 1:-1, 1:-1] = np.where(same[..., None], cross, np.nan)
    return points, normals


def _edge_share(camera: DepthCamera) -> float:
    """Return the largest difference in depth of neighbours on one surface, as a share of the depth."""
    return EDGE_PER_RADIAN / max(camera.fx, camera.fy)


def normal_equations(measured: np.ndarray, images: np.ndarray, camera: DepthCamera, scale: float) -> NormalEquations:
    """Return the system of one Gauss-Newton step for the poses that `images` were rendered from.

    measured: `(H, W)` depth, NaN = no measurement. images: `(N, H, W)` depth of the map, `inf` = nothing hit.
    scale: metres; a residual of this size counts a quarter, w = 1 / (1 + (r / scale)^2)^2 (Geman and McClure).
    This is the readable form; `compiled_normal_equations` gives the same numbers faster.
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
        w.sum(axis=(1, 2)),
    )


def compiled_normal_equations(
    measured: np.ndarray, images: np.ndarray, camera: DepthCamera, scale: float
) -> NormalEquations:
    """Return the numbers of `normal_equations` from a compiled loop; a test holds the two together."""
    images = np.ascontiguousarray(images, dtype=np.float32)
    points = camera.points(np.asarray(measured, dtype=np.float64))
    return NormalEquations(*_sums(points, images, camera.rays(), float(scale), _edge_share(camera)))


@compiled(fastmath=False)  # NaN and infinity keep their meaning
def _sums(points, images, rays, scale, edge):
    count, height, width = images.shape
    matrices, vectors = np.zeros((count, 6, 6)), np.zeros((count, 6))
    weights = np.zeros(count)
    jacobian = np.empty(6)
    for i in range(count):
        image = images[i]
        for y in range(1, height - 1):
            for x in range(1, width - 1):
                px, py, pz = points[y, x]
                depth = np.float64(image[y, x])
                left, right = np.float64(image[y, x - 1]), np.float64(image[y, x + 1])
                above, below = np.float64(image[y - 1, x]), np.float64(image[y + 1, x])
                limit = edge * depth
                # Comparisons with NaN and with inf - inf are false, so such pixels take no part.
                if not (pz > 0 and depth < np.inf):
                    continue
                if not (abs(left - depth) <= limit and abs(right - depth) <= limit):
                    continue
                if not (abs(above - depth) <= limit and abs(below - depth) <= limit):
                    continue
                ax = rays[y, x + 1, 0] * right - rays[y, x - 1, 0] * left
                ay = rays[y, x + 1, 1] * right - rays[y, x - 1, 1] * left
                az = right - left
                bx = rays[y + 1, x, 0] * below - rays[y - 1, x, 0] * above
                by = rays[y + 1, x, 1] * below - rays[y - 1, x, 1] * above
                bz = below - above
                nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
                length = np.sqrt(nx * nx + ny * ny + nz * nz)
                if not length > 0:
                    continue
                nx, ny, nz = nx / length, ny / length, nz / length
                r = nx * (px - rays[y, x, 0] * depth) + ny * (py - rays[y, x, 1] * depth) + nz * (pz - depth)
                w = 1.0 / (1.0 + (r / scale) ** 2) ** 2
                jacobian[0], jacobian[1], jacobian[2] = nx, ny, nz
                jacobian[3], jacobian[4], jacobian[5] = py * nz - pz * ny, pz * nx - px * nz, px * ny - py * nx
                for k in range(6):
                    vectors[i, k] += w * jacobian[k] * r
                    for m in range(k, 6):
                        matrices[i, k, m] += w * jacobian[k] * jacobian[m]
                weights[i] += w
        for k in range(6):
            for m in range(k):
                matrices[i, k, m] = matrices[i, m, k]
    return matrices, vectors, weights


def solve(system: NormalEquations, damping: float = DAMPING) -> np.ndarray:
    """Return the motions `(N, 6)` that solve the damped normal equations, none longer than `LONGEST_STEP`."""
    pixels = np.maximum(system.weights, 1.0)
    mean = system.matrices / pixels[:, None, None] + damping * np.eye(6)
    motions = -np.linalg.solve(mean, (system.vectors / pixels[:, None])[..., None])[..., 0]
    too_long = (lengths(motions) / LONGEST_STEP).max(axis=-1)
    return motions / np.maximum(too_long, 1.0)[:, None]


def gauss_newton_step(
    measured: np.ndarray, images: np.ndarray, camera: DepthCamera, poses: np.ndarray, scale: float
) -> np.ndarray:
    """Return camera-to-world poses `(N, 4, 4)` after one step; `images` `(N, H, W)` were rendered from `poses`."""
    return retract(poses, solve(compiled_normal_equations(measured, images, camera, scale)))


def refine(renderer: DepthRenderer, measured: np.ndarray, poses: np.ndarray, scales: Sequence[float]) -> np.ndarray:
    """Return camera-to-world poses `(N, 4, 4)` after one Gauss-Newton step for each of `scales`, in metres."""
    for scale in scales:
        poses = gauss_newton_step(measured, renderer.render_poses(poses), renderer.camera, poses, scale)
    return poses
