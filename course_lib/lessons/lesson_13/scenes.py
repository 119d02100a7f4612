"""The scene of lesson 13: what the plane of both cameras and a point cuts out of a sphere."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pyvista

SPHERES = (
    "Two grey spheres, one above the other, and a black point beside them. A yellow upright plane through all three "
    "cuts each sphere in a circle: bold on the point's side, dashed behind; a ray leads to the point."
)


def half_circle(towards: np.ndarray, n: int = 61) -> np.ndarray:
    """Return points `(n, 3)` of the unit sphere's epipolar half-circle of direction `towards` `(3,)`, upright rig."""
    flat = np.append(towards[:2] / np.linalg.norm(towards[:2]), 0.0)
    elevation = np.linspace(np.pi / 2, -np.pi / 2, n)[:, None]
    return np.cos(elevation) * flat + np.sin(elevation) * [0.0, 0.0, 1.0]


def upright_plane(towards: np.ndarray, low: float, high: float, behind: float = 1.4) -> pyvista.PolyData:
    """Return the vertical plane through the z axis and a little past `towards` [m], from low to high."""
    import pyvista  # takes a second

    ray = towards[:2] / np.linalg.norm(towards[:2])
    ends = -behind * ray, towards[:2] + 0.25 * ray
    corners = np.array([[*ends[k], z] for k, z in ((0, low), (1, low), (1, high), (0, high))], np.float32)
    return pyvista.PolyData.from_regular_faces(corners, np.array([[0, 1, 2], [0, 2, 3]]))
