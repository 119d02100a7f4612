"""The corridor as the lessons see it: its map, the wagon's run, and the lines of plans and side views.

Lines are where a plane cuts a mesh's triangles.
"""

from __future__ import annotations

import functools

import numpy as np
import trimesh
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.paths import data_path


@functools.cache
def corridor_map() -> SceneMap:
    """The corridor's map, loaded once."""
    return SceneMap.load(data_path("corridor/map.ply"))


@functools.cache
def wagon_run() -> DepthSequence:
    """The recording of the camera on the wagon."""
    return read_sequence(data_path("corridor/wagon"))


def plane_cut(vertices: np.ndarray, faces: np.ndarray, axis: int, position: float) -> np.ndarray:
    """Segments `(M, 2, 2)` [m] where the plane "coordinate `axis` = position" cuts the triangles of a mesh.

    axis: 0, 1 or 2 for x, y or z. The other two coordinates are kept, in their order.
    """
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    origin, normal = np.zeros(3), np.zeros(3)
    origin[axis], normal[axis] = position, 1.0
    return np.delete(trimesh.intersections.mesh_plane(mesh, normal, origin), axis, axis=2)


@functools.cache
def corridor_cut(axis: int, position: float) -> np.ndarray:
    """The `plane_cut` of the corridor's map."""
    return plane_cut(corridor_map().vertices, corridor_map().faces, axis, position)


def draw_walls(axes: Axes, axis: int, position: float, label: str | None = None) -> None:
    """Draw a `corridor_cut` as thin grey lines, in the limits that the axes have."""
    lines = LineCollection(corridor_cut(axis, position), colors="0.45", linewidths=1.0, label=label)
    axes.add_collection(lines, autolim=False)
