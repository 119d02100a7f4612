"""Figures of lesson 17: the places, which poses fail, rates over the share of objects seen."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from course_lib.experiments.room_evaluation import CORRECT, INCORRECT, PAPER_TABLE_5, UNABLE
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_17.experiments import EXPERIMENTS, KINDS
from course_lib.lessons.lesson_17.room_runs import StoredRoom
from course_lib.plots import figures
from course_lib.plots.room_figures import draw_pose, map_axes
from course_lib.simulation.room.measurement_places import MEASUREMENT_PLACES

_LOOKS = {CORRECT: (figures.BLUE, "."), INCORRECT: (figures.VERMILION, "X"), UNABLE: (figures.BLACK, "_")}


def places_figure() -> Figure:
    """The room from above: the map's objects, and table 1's places with their headings."""
    figure, axes = figures.new_figure(size=(7.2, 5.2))
    map_axes(axes, room_map(), "The room of the experiment: the map, and table 1's ten places")
    for p in MEASUREMENT_PLACES:
        for heading in np.radians(p.headings_deg):
            draw_pose(axes, p.x, p.y, float(heading), figures.BLACK)
        axes.annotate(str(p.place), (p.x, p.y), xytext=(7, 6), textcoords="offset points", fontsize=8)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return figure


def outcomes_figure(runs: Sequence[StoredRoom], source: str) -> Figure:
    """Every stored seed and experiment (rows) against the 20 poses (columns): correct, incorrect or unable."""
    rows = [(experiment, run) for experiment in EXPERIMENTS for run in runs]
    names = [pair.name for pair in room_recording(1).pairs]
    figure, axes = figures.new_figure(size=(8.6, 1.5 + 0.22 * len(rows)))
    for kind, (colour, marker) in _LOOKS.items():
        spots = [
            (names.index(place), row)
            for row, (experiment, run) in enumerate(rows)
            for place, found in run.outcomes(experiment, source).items()
            if found == kind
        ]
        style = {"linestyle": "none", "marker": marker, "color": colour, "markersize": 9}
        axes.plot(*(np.array(spots).reshape(-1, 2).T), **style, label=kind)
    axes.set_xticks(range(len(names)), names, rotation=90, fontsize=8)
    axes.set_yticks(range(len(rows)), [f"experiment {e}, seed {run.seed}" for e, run in rows], fontsize=8)
    axes.set(title="Which poses fail", xlabel="pose: place of table 1 and heading a or b [-]", ylabel="run [-]")
    axes.set(ylim=(len(rows) - 0.5, -0.5))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def rates_figure(shares: Sequence[float], percent: dict[str, list[float]], error_m: Sequence[float]) -> Figure:
    """Rates of correct, incorrect and unable over the share of objects seen, and the incorrect poses' errors."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.4, 3.2))
    for index, kind in enumerate(KINDS):
        style = figures.line_style(index)
        left.plot(shares, percent[kind], **style, label=kind)
        left.axhline(PAPER_TABLE_5[1][f"{kind}_percent"], color=style["color"], linestyle=":", linewidth=1.0)
    left.set(
        title="Rates (dotted: the paper's)", xlabel="share of the objects that are seen, q [-]", ylabel="poses [%]"
    )
    left.legend(loc="upper center", bbox_to_anchor=(0.45, 1.0), fontsize=8)
    left.set(ylim=(0, 102))
    right.plot(shares, error_m, **figures.line_style(3))
    right.set(title="Position error of the incorrect poses", xlabel="share of the objects that are seen, q [-]")
    right.set(ylabel="mean error [m]", ylim=(0, None))
    return figure
