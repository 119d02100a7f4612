"""Lines and surfaces of the scene of lesson 13: what the plane of both cameras and a point cuts out of a sphere."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pyvista


def half_circle(towards: np.ndarray, n: int = 61) -> np.ndarray:
    """Points `(n, 3)` of the unit sphere's half-circle from straight up to straight down, on the side of `towards`.

    towards: `(3,)`, not straight up or down. It is the epipolar half-circle of that direction for an upright rig.
    """
    flat = np.array([towards[0], towards[1], 0.0])
    flat /= np.linalg.norm(flat)
    elevation = np.linspace(np.pi / 2, -np.pi / 2, n)[:, None]
    return np.cos(elevation) * flat + np.sin(elevation) * np.array([0.0, 0.0, 1.0])


def upright_plane(towards: np.ndarray, low: float, high: float, behind: float = 1.4) -> pyvista.PolyData:
    """The vertical half-planes through the z axis on the side of `towards` and behind it, as one `pyvista.PolyData`.

    low, high: metres, where it ends below and above; it reaches a little past `towards`, and `behind` metres backward.
    """
    import pyvista  # takes a second

    flat = np.array([towards[0], towards[1], 0.0])
    ahead = flat * (1 + 0.25 / np.linalg.norm(flat))
    back = -behind * flat / np.linalg.norm(flat)
    corners = [[*end[:2], z] for end, z in ((back, low), (ahead, low), (ahead, high), (back, high))]
    return pyvista.PolyData.from_regular_faces(np.array(corners, np.float32), np.array([[0, 1, 2], [0, 2, 3]]))
