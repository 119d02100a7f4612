"""Figures of lesson 06: terms of eq. (8), the cost of a pixel, profiles along six axes, weights."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.lesson_06.profiles import AXES
from course_lib.plots import figures


def terms_figure(measured: np.ndarray, terms: dict[str, np.ndarray]) -> Figure:
    """The measured image, and for each particle the term of eq. (8) of every pixel (NaN where nothing was measured)."""
    figure, axes = figures.new_figure(1, 1 + len(terms), size=(10.2, 2.9))
    depth = figures.depth_image(axes[0], measured, "Measured", (0, 10))
    figures.colour_bar(figure, depth, axes[0])
    for a, (title, values) in zip(axes[1:], terms.items(), strict=True):
        image = figures.depth_image(a, values, title, (0, 1))
    figures.colour_bar(figure, image, axes[1:], "term of eq. (8) [-]")
    return figure


def cost_figure(difference: np.ndarray, costs: dict[str, np.ndarray]) -> Figure:
    """What one pixel costs in each form, over its difference."""
    figure, axes = figures.new_figure(size=(6.6, 3.0))
    for index, (name, cost) in enumerate(costs.items()):
        axes.plot(difference, cost, **(figures.line_style(index) | {"markevery": 0.08}), label=name)
    axes.set(title="What one wrong pixel costs", xlabel="difference |dz| [m]", ylabel="cost, 1 at 1 m [-]")
    axes.set(ylim=(0, 4))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def profiles_figure(profiles: dict[str, dict[str, np.ndarray]]) -> Figure:
    """Axis name -> form name -> profile `(N_PLACES,)`: one small plot for each of the six axes."""
    figure, plots = figures.new_figure(2, 3, size=(9.6, 5.2))
    for axes, (name, forms) in zip(plots.flat, profiles.items(), strict=True):
        axis = AXES[name]
        axes.axvline(0, color="0.5", linewidth=0.9, linestyle=(0, (6, 3)))
        for index, (form, values) in enumerate(forms.items()):
            style = figures.line_style(index) | {"markevery": 5, "markersize": 4}
            axes.plot(axis.offsets(), values, **style, label=form)
        axes.set(title=f"Along {name}", xlabel=f"{name} - truth [{axis.unit}]", ylabel="normalized [-]")
    handles, labels = plots.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    return figure


def weights_figure(normalized: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Weight before normalization over the normalized likelihood, for several beta."""
    figure, axes = figures.new_figure(size=(6.0, 2.8))
    for index, (name, w) in enumerate(curves.items()):
        axes.plot(normalized, w, **(figures.line_style(index) | {"markevery": 0.1}), label=name)
    axes.set(title="Equation (10)", xlabel="normalized likelihood [-]", ylabel="weight w [-]", ylim=(-0.03, 1.08))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure
