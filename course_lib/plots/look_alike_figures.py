"""From where which objects of a room are confused, drawn on its map."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure

from course_lib.experiments.ambiguity import AmbiguityMap
from course_lib.plots.figures import VERMILION, new_figure
from course_lib.plots.room_figures import map_axes
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

CONFUSIONS_DRAWN = 6
LABEL_AT = 0.38  # of the line's length: at the middle two labels would cover each other where lines cross
MIN_SHARE = 0.01  # of the belief, below which a confusion is not drawn


def ambiguity_figure(semantic_map: SemanticMap, found: AmbiguityMap, title: str = "Ambiguity") -> Figure:
    """The room from above: dark squares where the right pose is not sure, dashed lines between objects confused."""
    figure, axes = new_figure(size=(6.4, 5.2))
    squares = draw_ambiguity(axes, semantic_map, found, title)
    figure.colorbar(squares, ax=axes, label="doubt about the right pose (0: sure)", shrink=0.85)
    axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.12), ncols=4, fontsize=8)
    return figure


def draw_ambiguity(axes: Axes, semantic_map: SemanticMap, found: AmbiguityMap, title: str) -> PathCollection:
    """`ambiguity_figure` on axes that are there; returns the squares, for a colour bar."""
    map_axes(axes, semantic_map, title)
    squares = {"marker": "s", "s": (found.step * 46) ** 2, "zorder": 0}
    squares = axes.scatter(*found.places.T, c=1.0 - found.confidence, cmap="cividis_r", vmin=0.0, vmax=1.0, **squares)
    for i, j, share in found.most_confused(CONFUSIONS_DRAWN):
        if share >= MIN_SHARE:
            (x1, y1), (x2, y2) = semantic_map.positions[[i, j]]
            axes.plot([x1, x2], [y1, y2], "--", color=VERMILION, linewidth=0.8 + 5.0 * min(share, 0.6))
            at = x1 + LABEL_AT * (x2 - x1), y1 + LABEL_AT * (y2 - y1)
            ground = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 1.5}  # readable on dark squares
            axes.text(*at, f"{100 * share:.0f} %", color=VERMILION, fontsize=9, ha="center", va="center", bbox=ground)
    return squares
