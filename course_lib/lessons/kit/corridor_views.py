"""Lines of the corridor map for plans and side views: where a plane cuts its triangles."""

from __future__ import annotations

import functools

import numpy as np
import trimesh
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.paths import data_path


@functools.cache
def corridor_map() -> SceneMap:
    """The corridor's map, loaded once."""
    return SceneMap.load(data_path("corridor/map.ply"))


@functools.cache
def cut(axis: int, position: float) -> np.ndarray:
    """Segments `(M, 2, 2)` [m] where the plane "coordinate `axis` = position" cuts the corridor's map.

    axis: 0, 1 or 2 for x, y or z. The other two coordinates are kept, in their order.
    """
    scene_map = corridor_map()
    mesh = trimesh.Trimesh(scene_map.vertices, scene_map.faces, process=False)
    origin, normal = np.zeros(3), np.zeros(3)
    origin[axis], normal[axis] = position, 1.0
    segments = trimesh.intersections.mesh_plane(mesh, normal, origin)
    return np.delete(segments, axis, axis=2)


def draw_walls(axes: Axes, axis: int, position: float, label: str | None = None) -> None:
    """Draw the cut of `cut` as thin grey lines, in the limits that the axes have."""
    axes.add_collection(LineCollection(cut(axis, position), colors="0.45", linewidths=1.0, label=label), autolim=False)
