"""The corridor as the lessons see it: its map, the wagon's run, and the lines of plans and side views."""

from __future__ import annotations

import functools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.paths import data_path
from course_lib.plots.corridor_figures import plane_cut
from course_lib.rendering.scene_map import SceneMap


@functools.cache
def corridor_map() -> SceneMap:
    """The corridor's map, loaded once."""
    return SceneMap.load(data_path("corridor/map.ply"))


@functools.cache
def wagon_run() -> DepthSequence:
    """The recording of the camera on the wagon."""
    return read_sequence(data_path("corridor/wagon"))


@functools.cache
def corridor_cut(axis: int, position: float) -> np.ndarray:
    """The `plane_cut` of the corridor's map."""
    return plane_cut(corridor_map().vertices, corridor_map().faces, axis, position)


def draw_walls(axes: Axes, axis: int, position: float, label: str | None = None) -> None:
    """Draw a `corridor_cut` as thin grey lines, in the limits that the axes have."""
    lines = LineCollection(corridor_cut(axis, position), colors="0.45", linewidths=1.0, label=label)
    axes.add_collection(lines, autolim=False)
