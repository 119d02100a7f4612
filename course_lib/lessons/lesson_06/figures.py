"""Figures of lesson 06: terms of eq. (8), the cost of a pixel, profiles along six axes, weights."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import described
from course_lib.lessons.lesson_06.places import UNIT, offsets
from course_lib.plots import figures

SCENE_ALT = """A flat cloud of 200 arrowheads about the axes of the true pose: most are dark; the bright ones look the
    way the truth looks, and stand within a decimetre or two of it along the corridor."""


def terms_figure(measured: np.ndarray, terms: dict[str, np.ndarray]) -> Figure:
    """The measured image, and for each particle the term of eq. (8) of every pixel (NaN where nothing was measured)."""
    figure, axes = figures.new_figure(1, 1 + len(terms), size=(10.2, 2.9))
    figures.colour_bar(figure, figures.depth_image(axes[0], measured, "Measured", (0, 10)), axes[0])
    for a, (title, values) in zip(axes[1:], terms.items(), strict=True):
        image = figures.depth_image(a, values, title, (0, 1))
    figures.colour_bar(figure, image, axes[1:], "term of eq. (8) [-]")
    alt = """The measured image of a corridor with two people; the terms of particle A are bright except on the people
        and far away; those of particle B are dark nearly everywhere."""
    return described(figure, alt)


def draw_lines(axes: Axes, x: np.ndarray, lines: dict[str, np.ndarray], **style) -> list:
    """Draw named lines `(n,)` over x and return them."""
    styles = [figures.line_style(index) | style for index in range(len(lines))]
    return [axes.plot(x, lines[name], **style, label=name)[0] for name, style in zip(lines, styles, strict=True)]


def one_plot(size: tuple, x: np.ndarray, lines: dict[str, np.ndarray], markevery: float, **labels) -> Figure:
    figure, axes = figures.new_figure(size=size)
    draw_lines(axes, x, lines, markevery=markevery)
    axes.set(**labels)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def cost_figure(difference: np.ndarray, costs: dict[str, np.ndarray]) -> Figure:
    """What one pixel costs in each form, over its difference."""
    labels = {"title": "What one wrong pixel costs", "xlabel": "difference |dz| [m]", "ylabel": "cost, 1 at 1 m [-]"}
    alt = "Cost over difference: the Gaussian's parabola leaves the picture; the other two level off near 1."
    return described(one_plot((6.6, 3.0), difference, costs, 0.08, **labels, ylim=(0, 4)), alt)


def weights_figure(normalized: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Weight before normalization over the normalized likelihood, for several beta."""
    labels = {"title": "Equation (10)", "xlabel": "normalized likelihood [-]", "ylabel": "weight w [-]"}
    alt = "Weight over normalized likelihood for four beta: the smaller beta, the later and steeper the rise to 1."
    return described(one_plot((6.0, 2.8), normalized, curves, 0.1, **labels, ylim=(-0.03, 1.08)), alt)


def profiles_figure(profiles: dict[str, dict[str, np.ndarray]]) -> Figure:
    """Axis name -> form name -> profile `(N_PLACES,)`: one small plot for each of the six axes."""
    figure, plots = figures.new_figure(2, 3, size=(9.6, 5.2))
    for axes, (name, forms) in zip(plots.flat, profiles.items(), strict=True):
        axes.axvline(0, color="0.5", linewidth=0.9, linestyle=(0, (6, 3)))
        draw_lines(axes, offsets(name), forms, markevery=5, markersize=4)
        axes.set(title=f"Along {name}", xlabel=f"{name} - truth [{UNIT[name]}]", ylabel="normalized [-]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    alt = """Six plots, one for each axis: the paper's form has the narrowest peak at the truth, half-normal and
        disparity wider ones, and the Gaussian is ragged, with its highest place elsewhere on all axes but roll."""
    return described(figure, alt)
