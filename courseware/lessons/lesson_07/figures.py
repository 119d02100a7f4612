"""Figures of lesson 07: means on the circle, the comb, particles over rounds, two beliefs at doors."""

import itertools

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from courseware.lessons.kit.display import described
from courseware.lessons.lesson_07.simulations import DOORS, LENGTH
from courseware.plots import figures

SCENE_ALT = "Fifty arrows close together at the corridor's wall; above five of them stand stacks of copies."


def circle_figure(degrees: list[float], w: list[float], means: dict[str, float]) -> Figure:
    """Draw headings as points on a circle, sized by weight, and one line for each kind of mean (degrees)."""
    figure, axes = figures.new_figure(size=(5.6, 3.5))
    around, angles = np.linspace(0, 2 * np.pi, 200), np.deg2rad(degrees)
    axes.plot(np.cos(around), np.sin(around), color="0.75", linewidth=1)
    axes.scatter(np.cos(angles), np.sin(angles), s=300 * np.array(w), color=figures.BLUE, label="particles", zorder=3)
    for index, (name, mean) in enumerate(means.items(), start=1):
        style, x, y = figures.line_style(index), *(0.75 * f(np.deg2rad(mean)) for f in (np.cos, np.sin))
        axes.plot([0, x], [0, y], color=style["color"], linestyle=style["linestyle"], linewidth=2.5)
        axes.plot(x, y, style["marker"], color=style["color"], markersize=9, label=name)
    axes.set(title="Headings on the circle", xlabel="cos(yaw) [-]", ylabel="sin(yaw) [-]", aspect="equal")
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.2, 1.2))
    axes.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), frameon=False)
    alt = "A circle with four headings on its left; the mean of the numbers points right, that on the circle left."
    return described(figure, alt)


def comb_figure(w: np.ndarray, points: dict[str, np.ndarray]) -> Figure:
    """Draw the cumulative weights as a strip of fields, one a particle, and the points of each scheme that pick."""
    figure, axes = figures.new_figure(size=(8.6, 2.9))
    for i, (left, right) in enumerate(itertools.pairwise([0, *np.cumsum(w)])):
        colour = (figures.SKY_BLUE, "#F4D9A8")[i % 2]
        axes.add_patch(Rectangle((left, 0), right - left, len(points) + 0.6, facecolor=colour, edgecolor="0.4"))
        axes.text((left + right) / 2, len(points) + 0.3, str(i), ha="center", va="center", fontsize=8)
    for row, values in enumerate(points.values()):
        axes.plot(values, np.full(len(values), len(points) - row - 0.5), "v", color=figures.BLACK, markersize=6)
    axes.set_yticks(len(points) - 0.5 - np.arange(len(points)), list(points))
    axes.set(xlim=(0, 1), ylim=(0, len(points) + 0.6), xlabel="sum of the weights so far [-]")
    axes.set_title("Each point picks the particle whose field it falls into")
    axes.grid(False)
    alt = "A strip of six fields; points: systematic evenly spaced, stratified one in each sixth, multinomial anywhere."
    return described(figure, alt)


def rounds_figure(counts: dict[str, np.ndarray]) -> Figure:
    """Draw how many different particles are left over the rounds of resampling."""
    labels = {"title": "Resampling equal weights again and again", "xlabel": "rounds [-]"}
    rounds = np.arange(len(next(iter(counts.values()))))
    figure, axes = figures.curves_figure(rounds, counts, (6.8, 3.0), 20, **labels, ylabel="different particles [-]")
    for index, line in enumerate(axes.lines):
        line.set_markevery((5 * index, 20))  # so that the markers of equal curves do not hide each other
    axes.set_ylim(0, None)
    alt = "Different particles over 100 rounds: three schemes stay at 64, multinomial falls below 10 quickly."
    return described(figure, alt)


def copies_figure(expected: np.ndarray, found: dict[str, np.ndarray]) -> Figure:
    """Draw the mean number of copies of every particle: what it should be, and what resamplers give."""
    figure, axes = figures.new_figure(size=(7.4, 3.0))
    places = np.arange(len(expected))
    axes.bar(places, expected, width=0.75, color="0.85", edgecolor="0.5", label="N w: as it should be")
    for index, (name, values) in enumerate(found.items()):
        style = figures.line_style(index + 2) | {"linestyle": "none", "markersize": 8}
        axes.plot(places + 0.16 * (2 * index - 1), values, **style, label=name)
    axes.set(title="Copies of each particle, in the mean", xlabel="particle", ylabel="copies [-]")
    axes.set_xticks(places, [str(place) for place in places])
    axes.legend(**figures.BESIDE)
    alt = """Mean copies of ten particles: course_lib meets N w everywhere; filterpy gives the two heavy ones 4 to 6
        copies and the eight light ones none."""
    return described(figure, alt)


def doors_figure(clouds: list[np.ndarray], bells: list, true: list[float]) -> Figure:
    """Draw the particles as a histogram and the one bell, after the first door and after the second."""
    figure, axes = figures.new_figure(1, 2, size=(9.0, 2.9))
    x, bins = np.linspace(0, LENGTH, 500), np.arange(0, LENGTH + 0.1, 0.2)
    for a, cloud, bell, place, name in zip(axes, clouds, bells, true, ("first", "second"), strict=True):
        a.hist(cloud, bins=bins, density=True, color=figures.SKY_BLUE, label="particles")
        a.plot(x, bell.pdf(x), color=figures.VERMILION, linewidth=2, linestyle="--", label="one bell (Kalman)")
        a.plot(DOORS, np.full(len(DOORS), 0.07), "^", color=figures.BLACK, markersize=8, label="door")
        a.axvline(place, color="0.3", linewidth=1, label="the robot")
        a.set(title=f"After the {name} door", xlabel="x along the corridor [m]", ylabel="bel(x) [1/m]")
        a.set_xlim(0, LENGTH)
    axes[1].legend(loc="upper right", fontsize=8, framealpha=0.95)
    alt = "Two beliefs: the particles are in three heaps at the doors, then in one at 4 m; the bell stays wide."
    return described(figure, alt)
