"""What only lessons' scenes show: particles, and depth images as surfaces (`plots.scenes` has the other objects)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from course_lib.geometry import as_states, optical_pose, pose_matrix
from courseware.plots.scenes import SceneError, finite, polydata, to_world

if TYPE_CHECKING:
    import pyvista

    from course_lib.rendering.camera import DepthCamera


def arrows(states: np.ndarray, length: float = 0.3, weights: np.ndarray | None = None) -> pyvista.PolyData:
    """Return particles as flat arrowheads that point along x, each with a fin on top, so that roll and pitch show too.

    states: `(N, 6)` [m, rad], the position at the arrow's middle. length: [m]. weights: `(N,)`, they become the point
    data "weight" (with `add_mesh(..., cmap="plasma")` the colour).
    """
    states = np.atleast_2d(as_states(states))
    # Tip, the two ends of the tail, the notch between them, the top of the fin.
    dart = np.array([[0.6, 0, 0], [-0.4, 0.3, 0], [-0.4, -0.3, 0], [-0.2, 0, 0], [-0.4, 0, 0.2]])
    triangles = np.array([[0, 1, 3], [0, 3, 2], [0, 3, 4]])
    matrices = pose_matrix(states)
    placed = np.einsum("nij,kj->nki", matrices[:, :3, :3], length * dart) + matrices[:, None, :3, 3]
    faces = triangles + len(dart) * np.arange(len(states))[:, None, None]
    mesh = polydata(placed.reshape(-1, 3), faces.reshape(-1, 3))
    if weights is not None:
        mesh.point_data["weight"] = np.repeat(finite(weights, "weights", (len(states),)), len(dart))
    return mesh


def depth_surface(
    depth: np.ndarray, camera: DepthCamera, state: np.ndarray, every: int = 1, jump: float = 0.1
) -> pyvista.PolyData:
    """Return a depth image as a surface in the world: neighbouring pixels joined, with the point data "depth" [m].

    depth: `(H, W)` [m], NaN or infinite where nothing was hit. state: `(6,)` of the camera. every: takes each
    so-many-th row and column. jump: pixels whose depths differ by more than this share are not joined.
    """
    depth = np.asarray(depth, dtype=np.float64)
    if depth.shape != camera.shape:
        raise SceneError(f"the depth image must have the camera's shape {camera.shape}; got {depth.shape}")
    points = camera.points(np.where(np.isfinite(depth), depth, 0.0))[::every, ::every]
    z = np.where(np.isfinite(depth) & (depth > 0), depth, np.inf)[::every, ::every]
    index = np.arange(z.size).reshape(z.shape)
    square = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    triangles = np.concatenate([square[:, [0, 1, 2]], square[:, [0, 2, 3]]])
    least, greatest = z.ravel()[triangles].min(axis=1), z.ravel()[triangles].max(axis=1)
    triangles = triangles[np.isfinite(greatest) & (greatest <= (1 + jump) * np.minimum(least, 1e9))]
    used, triangles = np.unique(triangles, return_inverse=True)
    mesh = polydata(to_world(points.reshape(-1, 3)[used], optical_pose(state)), triangles.reshape(-1, 3))
    mesh.point_data["depth"] = z.ravel()[used].astype(np.float32)
    return mesh
