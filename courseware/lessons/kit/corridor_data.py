"""Load the corridor's map and the wagon's run, and draw walls in plans and side views."""

import functools

from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.rendering.scene_map import SceneMap
from courseware.paths import data_path
from courseware.plots.corridor_figures import plane_cut


@functools.cache
def corridor_map() -> SceneMap:
    """Return the corridor's map. It is loaded once."""
    return SceneMap.load(data_path("corridor/map.ply"))


@functools.cache
def wagon_run() -> DepthSequence:
    """Return the recording of the camera on the wagon. It is loaded once."""
    return read_sequence(data_path("corridor/wagon"))


def draw_walls(axes: Axes, axis: int, position: float, label: str | None = None) -> None:
    """Draw the cut through the map at `position` [m] along `axis` in grey. The limits of the axes do not change."""
    cut = plane_cut(corridor_map().vertices, corridor_map().faces, axis, position)
    axes.add_collection(LineCollection(cut, colors="0.45", linewidths=1.0, label=label), autolim=False)
