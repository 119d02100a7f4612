"""Figures of lesson 16: centred points, the residual over the heading, the spread over the number of points."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import described
from course_lib.lessons.lesson_16.fits import Matched, residual_over_heading
from course_lib.plots import figures


def centred_figure(points: Matched) -> Figure:
    """The measured points, the landmarks, and both about their centroids: only a turn is left."""
    figure, (body, world, both) = figures.new_figure(1, 3, size=(10.4, 3.7))
    a, b = points.source - points.source.mean(axis=0), points.target - points.target.mean(axis=0)
    _numbered(body, points.source, 0, "measured")
    body.plot(0, 0, marker=(3, 0, -90), color=figures.BLACK, markersize=10)
    body.set(title="Measured, body frame", xlabel="forward x [m]", ylabel="left y [m]")
    _numbered(world, points.target, 1, "landmark")
    world.set(title="Landmarks, world frame", xlabel="x [m]", ylabel="y [m]")
    _numbered(both, a, 0, "measured")
    _numbered(both, b, 1, "landmark")
    both.set(title="Both about their centroids", xlabel="x - centroid [m]", ylabel="y - centroid [m]")
    for axes in (body, world, both):
        axes.set(aspect="equal")
    handles, labels = both.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    return described(
        figure,
        "Thirteen measured points in the body frame; their landmarks on the map; and both about their centroids, "
        "where one pattern is the other turned by a quarter of a circle.",
    )


def _numbered(axes: Axes, points: np.ndarray, index: int, name: str) -> None:
    style = figures.line_style(index) | {"linestyle": "none", "markersize": 5}
    axes.plot(*points.T, **style, label=name)
    axes.plot(*points.mean(axis=0), "+", color=style["color"], markersize=14, markeredgewidth=2)
    for k, (x, y) in enumerate(points, start=1):
        axes.annotate(str(k), (x, y), (4, 3), textcoords="offset points", fontsize=7, color=style["color"])


def heading_figure(curves: dict[str, tuple[np.ndarray, np.ndarray]]) -> Figure:
    """Residual over heading for several sets of points (source, target)."""
    figure, axes = figures.new_figure(size=(7.4, 3.0))
    headings = np.deg2rad(np.linspace(-180, 180, 361))
    for index, (name, (source, target)) in enumerate(curves.items()):
        style = figures.line_style(index) | {"markevery": 30}
        axes.plot(np.rad2deg(headings), residual_over_heading(source, target, headings), **style, label=name)
    axes.set(title="What is left over, for every heading", xlabel="heading [degrees]", ylabel="RMS residual [m]")
    axes.set(ylim=(0, None), xticks=np.arange(-180, 181, 60))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return described(
        figure,
        "Residual over heading: two smooth valleys, the deeper one for two pairs, both lowest near minus 90 degrees.",
    )


def noise_figure(n_points: list[int], found: np.ndarray, expected: np.ndarray) -> Figure:
    """Spread of the heading (degrees) over the number of points: tried, and by the closed form."""
    figure, axes = figures.new_figure(size=(6.4, 2.8))
    axes.loglog(n_points, expected, **(figures.line_style(1) | {"marker": ""}), label="closed form")
    axes.loglog(n_points, found, **(figures.line_style(0) | {"linestyle": "none"}), label="tried")
    axes.set(title="Spread of the heading", xlabel="number of points n [-]", ylabel="spread [degrees]")
    axes.set_xticks(n_points, [str(n) for n in n_points])
    axes.set_yticks([0.4, 0.8, 1.6], ["0.4", "0.8", "1.6"])
    axes.minorticks_off()
    axes.legend(frameon=False)
    return described(
        figure,
        "Spread of the heading over the number of points, both logarithmic: tried values on the closed form's line.",
    )
