"""Figures of lesson 16: centred points, the residual over the heading, the spread over the number of points."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from courseware.lessons.kit.display import described
from courseware.lessons.lesson_16.fits import Matched, residual_over_heading
from courseware.plots import figures


def centred_figure(points: Matched) -> Figure:
    """Draw the measured points, the landmarks, and both about their centroids, where only a turn is left."""
    figure, (body, world, both) = figures.new_figure(1, 3, size=(10.4, 3.7))
    draw_numbered(body, points.source[:, ::-1] * [-1, 1], 0, points.landmarks)
    draw_numbered(world, points.target, 1, points.landmarks)
    for index in (0, 1):
        draw_numbered(both, points[index] - points[index].mean(axis=0), index, points.landmarks)
    body.plot(0, 0, marker=(3, 0, 0), color=figures.BLACK, markersize=10)
    body.set(title="Measured, body frame", xlabel="to the right, -y [m]", ylabel="forward, x [m]", aspect="equal")
    world.set(title="Landmarks, world frame", xlabel="x [m]", ylabel="y [m]", aspect="equal")
    both.set(title="Both about their centroids", xlabel="x - centroid [m]", ylabel="y - centroid [m]", aspect="equal")
    figure.legend(*both.get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return described(
        figure,
        "Thirteen measured points in the body frame; their landmarks on the map; and both about their centroids, "
        "where one pattern is the other turned by a quarter of a circle.",
    )


def draw_numbered(axes: Axes, points: np.ndarray, index: int, numbers: Sequence[int]) -> None:
    style = figures.line_style(index) | {"linestyle": "none", "markersize": 5}
    axes.plot(*points.T, **style, label=("measured", "landmark")[index])
    axes.plot(*points.mean(axis=0), "+", color=style["color"], markersize=14, markeredgewidth=2)
    for number, place in zip(numbers, points, strict=True):
        axes.annotate(str(number), place, (4, 3), textcoords="offset points", fontsize=7, color=style["color"])


def heading_figure(curves: dict[str, tuple[np.ndarray, np.ndarray]]) -> Figure:
    """Draw the mean squared residual over the heading for several sets of points (source, target)."""
    figure, axes = figures.new_figure(size=(7.4, 3.0))
    degrees = np.linspace(-180, 180, 361)
    for index, (name, points) in enumerate(curves.items()):
        style = figures.line_style(index) | {"markevery": 30}
        axes.plot(degrees, residual_over_heading(*points, np.deg2rad(degrees)) ** 2, **style, label=name)
    axes.set(title="What is left over, for every heading", xlabel="heading [degrees]", ylabel="mean square [m$^2$]")
    axes.set(ylim=(0, None), xticks=np.arange(-180, 181, 60))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return described(
        figure,
        "Mean square over heading: two cosines, the flatter one for two pairs, both lowest near minus 90 degrees.",
    )


def noise_figure(n_points: list[int], found: np.ndarray, expected: np.ndarray) -> Figure:
    """Draw the spread of the heading (degrees) over the number of points: tried, and by the closed form."""
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
