"""Figures of lesson 14 that measure: objects from above, and errors over the range."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import described
from course_lib.plots.figures import line_style, new_figure
from course_lib.plots.panorama_drawing import class_style
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap


def places_figure(
    semantic_map: SemanticMap, pose: Sequence[float], labels: Sequence[str], places: np.ndarray
) -> Figure:
    """Return the map of the room with the rig at `pose` and the places `(n, 2)` [m] of objects with these labels."""
    figure, axes = new_figure(size=(6.4, 4.8))
    axes.plot(*np.vstack([semantic_map.walls, semantic_map.walls[:1]]).T, color="black", linewidth=2)
    for label, (x, y) in zip(semantic_map.labels, semantic_map.positions, strict=True):
        colour, marker = class_style(label)
        axes.plot(x, y, marker, color=colour, markersize=10, alpha=0.45)
    for label, (x, y) in zip(labels, places, strict=True):
        axes.plot([pose[0], x], [pose[1], y], color="0.8", linewidth=0.8, zorder=1)
        axes.plot(x, y, "x", color=class_style(label)[0], markersize=8, markeredgewidth=2)
    for label in dict.fromkeys(semantic_map.labels):
        colour, marker = class_style(label)
        axes.plot([], [], marker, linestyle="none", color=colour, alpha=0.45, label=f"{label}, map")
    axes.plot([], [], "x", linestyle="none", color="0.3", label="from two boxes")
    axes.plot(*pose[:2], "o", color="black", label="rig")
    axes.set(title="Objects from above", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return described(
        figure,
        "The room from above: the rig, pale markers where the map has the objects, and crosses where two boxes put "
        "them, most of them close to their markers.",
    )


def growth_figure(ranges: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Return the standard deviation of the range over the range, on logarithmic axes: squares are straight lines."""
    figure, axes = new_figure(size=(6.4, 3.4))
    for index, (name, values) in enumerate(curves.items()):
        axes.plot(ranges, values, **(line_style(index) | {"markevery": 6}), label=name)
    axes.set(title="One pixel of error", xlabel="horizontal range [m]", ylabel="sigma of the range [m]")
    axes.set(xscale="log", yscale="log")
    axes.set_xticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
    axes.set_yticks([0.001, 0.01, 0.1, 1], ["0.001", "0.01", "0.1", "1"])
    axes.minorticks_off()
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return described(
        figure,
        "Sigma of the range over the range on logarithmic axes: three parallel straight lines, lower for longer "
        "baselines.",
    )


def errors_figure(true: np.ndarray, errors: dict[str, np.ndarray]) -> Figure:
    """Return measured minus true range over the true range, one small plot for each way to measure."""
    figure, plots = new_figure(1, len(errors), size=(9.4, 3.2))
    for index, (axes, (name, error)) in enumerate(zip(plots, errors.items(), strict=True)):
        style = line_style(index)
        axes.axhline(0, color="0.5", linewidth=0.9)
        axes.plot(true, np.clip(error, -2, 2), style["marker"], color=style["color"], markersize=3.5, alpha=0.7)
        axes.set(title=name, xlabel="true range [m]", ylabel="measured - true [m]", ylim=(-2.05, 2.05))
    return described(
        figure,
        "Errors over the true range with boxes off by three pixels: box centres scatter by up to two metres beyond "
        "4 m, features stay within about half a metre everywhere.",
    )
