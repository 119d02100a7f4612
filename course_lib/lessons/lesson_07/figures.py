"""Figures of lesson 07: means on the circle, the comb, particles over rounds, copies."""

import itertools

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from course_lib.plots import figures


def circle_figure(degrees: list[float], w: list[float], means: dict[str, float]) -> Figure:
    """Headings as points on a circle, sized by weight, and one arrow for each kind of mean (degrees)."""
    figure, axes = figures.new_figure(size=(5.6, 3.5))
    around = np.linspace(0, 2 * np.pi, 200)
    axes.plot(np.cos(around), np.sin(around), color="0.75", linewidth=1)
    angles = np.deg2rad(degrees)
    axes.scatter(np.cos(angles), np.sin(angles), s=300 * np.array(w), color=figures.BLUE, label="particles", zorder=3)
    for index, (name, mean) in enumerate(means.items(), start=1):
        style = figures.line_style(index)
        tip = 0.75 * np.array([np.cos(np.deg2rad(mean)), np.sin(np.deg2rad(mean))])
        axes.plot([0, tip[0]], [0, tip[1]], color=style["color"], linestyle=style["linestyle"], linewidth=2.5)
        axes.plot(*tip, style["marker"], color=style["color"], markersize=9, label=name)
    axes.set(title="Headings on the circle", xlabel="cos(yaw) [-]", ylabel="sin(yaw) [-]", aspect="equal")
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.2, 1.2))
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    return figure


def comb_figure(w: np.ndarray, points: dict[str, np.ndarray]) -> Figure:
    """The cumulative weights as a strip of fields, one for each particle, and the points of each scheme that pick."""
    figure, axes = figures.new_figure(size=(8.6, 2.9))
    edges = np.concatenate([[0], np.cumsum(w)])
    for i, (left, right) in enumerate(itertools.pairwise(edges)):
        colour = (figures.SKY_BLUE, "#F4D9A8")[i % 2]
        axes.add_patch(Rectangle((left, 0), right - left, len(points) + 0.6, facecolor=colour, edgecolor="0.4"))
        axes.text((left + right) / 2, len(points) + 0.3, str(i), ha="center", va="center", fontsize=8)
    for row, (name, values) in enumerate(points.items()):
        axes.plot(values, np.full(len(values), len(points) - row - 0.5), "v", color=figures.BLACK, markersize=6)
        axes.text(-0.01, len(points) - row - 0.5, name, ha="right", va="center")
    axes.set(xlim=(0, 1), ylim=(0, len(points) + 0.6), yticks=[])
    axes.set(title="Each point picks the particle whose field it falls into", xlabel="sum of the weights so far [-]")
    axes.set_ylabel("scheme [-]", labelpad=72)
    axes.grid(False)
    return figure


def rounds_figure(counts: dict[str, np.ndarray]) -> Figure:
    """Different particles that are left over the rounds of resampling."""
    figure, axes = figures.new_figure(size=(6.8, 3.0))
    for index, (name, values) in enumerate(counts.items()):
        style = figures.line_style(index) | {"markevery": (5 * index, 20)}
        axes.plot(np.arange(len(values)), values, **style, label=name)
    axes.set(title="Resampling equal weights again and again", xlabel="rounds [-]", ylabel="different particles [-]")
    axes.set_ylim(0, None)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def copies_figure(expected: np.ndarray, found: dict[str, np.ndarray]) -> Figure:
    """Mean number of copies of every particle: what it should be, and what resamplers give."""
    figure, axes = figures.new_figure(size=(7.4, 3.0))
    places = np.arange(len(expected))
    axes.bar(places, expected, width=0.75, color="0.85", edgecolor="0.5", label="N w: as it should be")
    for index, (name, values) in enumerate(found.items()):
        style = figures.line_style(index + 2) | {"linestyle": "none", "markersize": 8}
        axes.plot(places + 0.16 * (2 * index - 1), values, **style, label=name)
    axes.set(title="Copies of each particle, in the mean", xlabel="particle [-]", ylabel="copies [-]", xticks=places)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure
