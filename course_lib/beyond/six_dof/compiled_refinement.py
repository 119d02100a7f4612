"""`refinement.normal_equations` once more, in a compiled loop; a test holds the two together."""

from __future__ import annotations

import numpy as np

from course_lib.beyond.six_dof.refinement import NormalEquations, edge_share
from course_lib.rendering.camera import DepthCamera
from course_lib.rendering.compiled import compiled


def normal_equations(measured: np.ndarray, images: np.ndarray, camera: DepthCamera, scale: float) -> NormalEquations:
    """One Gauss-Newton step: the same numbers and arguments as `refinement.normal_equations`."""
    images = np.ascontiguousarray(images, dtype=np.float32)
    points = camera.points(np.asarray(measured, dtype=np.float64))
    return NormalEquations(*_sums(points, images, camera.rays(), float(scale), edge_share(camera)))


@compiled(fastmath=False)  # NaN and infinity keep their meaning
def _sums(points, images, rays, scale, edge):
    count, height, width = images.shape
    matrices, vectors = np.zeros((count, 6, 6)), np.zeros((count, 6))
    squares, weights = np.zeros(count), np.zeros(count)
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
                # Comparisons with NaN and with inf - inf are false: what is no number takes no part.
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
                squares[i] += w * r * r
                weights[i] += w
        for k in range(6):
            for m in range(k):
                matrices[i, k, m] = matrices[i, m, k]
    return matrices, vectors, squares, weights
