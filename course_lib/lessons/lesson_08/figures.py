"""Figures of lesson 08: the experiment, two errors, runs along the corridor, a lost filter, weights."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.localizer import Estimate
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.lessons.lesson_08.along import STRETCH
from course_lib.lessons.lesson_08.stored_runs import StoredRun
from course_lib.plots import figures
from course_lib.plots.corridor_figures import floor_plan
from course_lib.rendering.scene_map import SceneMap


def experiment_figure(scene_map: SceneMap, sequence: DepthSequence) -> Figure:
    """The experiment from above: the map's walls, the wagon's path, its start, the live stretch."""
    figure, axes = figures.new_figure(size=(9.0, 2.6))
    true = sequence.camera_to_world[:, :3, 3]
    walls = floor_plan(scene_map.vertices, true[0, 2])
    axes.plot(walls[:, 0], walls[:, 1], ".", color="0.6", markersize=0.7, label="map at camera height")
    axes.plot(true[:, 0], true[:, 1], **(figures.line_style(0) | {"marker": ""}), label="path of the wagon")
    live = true[list(STRETCH)]
    axes.plot(
        live[:, 0],
        live[:, 1],
        **(figures.line_style(3) | {"marker": "", "linestyle": "-", "linewidth": 5}),
        label="live stretch",
    )
    axes.plot(true[0, 0], true[0, 1], "o", color=figures.BLACK, markersize=7, label="start, given to the filter")
    axes.set(title="The experiment from above", xlabel="x along the corridor [m]", ylabel="y [m]", ylim=(-2.4, 3.4))
    axes.set(xlim=(true[:, 0].min() - 3, true[:, 0].max() + 5))
    axes.legend(loc="upper center", ncols=4, fontsize=8, framealpha=0.95, columnspacing=1.2)
    return figure


def two_errors_figure() -> tuple[Figure, dict[str, float]]:
    """One estimate that lies on the path but far behind: its two errors, drawn and in metres."""
    x = np.linspace(0, 4, 200)
    path = np.column_stack([x, 0.25 * np.sin(1.4 * x)])
    true, estimate = path[165], path[75] + [0.0, 0.12]
    nearest = path[np.linalg.norm(path - estimate, axis=1).argmin()]
    figure, axes = figures.new_figure(size=(8.2, 2.5))
    axes.plot(*path.T, color="black", linewidth=1.4, label="path on the floor")
    axes.plot(*true, **(figures.line_style(0) | {"linestyle": "none", "markersize": 9}), label="camera, now")
    axes.plot(*estimate, **(figures.line_style(3) | {"linestyle": "none", "markersize": 9}), label="estimate, now")
    axes.plot(*zip(estimate, true, strict=True), color=figures.ORANGE, linestyle="--", linewidth=2, label="timed error")
    axes.plot(*zip(estimate, nearest, strict=True), color=figures.GREEN, linewidth=3.5, label="nearest-path error")
    axes.set(title="Two errors of one estimate", xlabel="x [m]", ylabel="y [m]", ylim=(-0.55, 0.65))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure, {
        "timed error": float(np.linalg.norm(estimate - true)),
        "nearest-path error": float(np.linalg.norm(estimate - nearest)),
    }


def as_in_the_paper_figure(run: StoredRun, path: np.ndarray) -> Figure:
    """Figures 5 and 6 of the paper: its own method alone, on plain axes, with our numbers.

    path: `(P, 2 or 3)` the line on the floor, metres.
    """
    figure, (place, error) = figures.new_figure(2, 1, size=(8.0, 4.6))
    place.get_gridspec().set_height_ratios([1.0, 1.5])
    place.plot(path[:, 0], path[:, 1], color="black", linewidth=1.1, zorder=4, label="ground truth")
    dots = figures.line_style(0) | {"linestyle": "none", "markersize": 2.5}
    place.plot(*run.positions("proposed").T, **dots, label="estimated position")
    place.set(title="As figure 5: ground truth and estimates", xlabel="x [m]", ylabel="y [m]", ylim=(-0.6, 0.9))
    place.legend(loc="upper center", ncols=2, fontsize=8, framealpha=0.95)
    error.plot(run.columns["frame"], run.columns["proposed_nearest_m"], color=figures.BLUE, linewidth=1.0)
    error.set(title="As figure 6: distance to the nearest point of the path", xlabel="frame [-]", ylabel="error [m]")
    error.set_ylim(0, None)
    return figure


def along_figure(run: StoredRun, true_x: np.ndarray, methods: tuple[str, ...]) -> Figure:
    """Estimated and true position along the corridor over the frames."""
    figure, axes = figures.new_figure(size=(8.0, 3.0))
    frames = run.columns["frame"]
    axes.plot(frames, true_x[: len(frames)], color="black", linewidth=3, alpha=0.35, label="truth")
    for index, method in enumerate(methods):
        style = figures.line_style(index) | {"marker": "", "linewidth": 1.4}
        axes.plot(frames, run.positions(method)[:, 0], **style, label=run.summary["methods"][method]["name"])
    axes.set(title="Where along the corridor, and when", xlabel="frame [-]", ylabel="x [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure


def lost_figure(frames: range, runs: dict[str, list[Estimate]]) -> Figure:
    """Two signals over the frames, for every run: the best particle's raw score, and its normalized weight."""
    figure, axes = figures.new_figure(1, 2, size=(8.8, 2.8))
    for index, (name, estimates) in enumerate(runs.items()):
        style = figures.line_style(index) | {"markersize": 4}
        axes[0].plot(frames, [e.score for e in estimates], **style, label=name)
        axes[1].plot(frames, [e.weights.max() for e in estimates], **style, label=name)
    axes[0].set(title="Raw score of the best particle", xlabel="frame [-]", ylabel="l / m [-]", ylim=(0, 0.9))
    axes[1].set(title="Its normalized weight, eq. (11)", xlabel="frame [-]", ylabel="weight w~ [-]", ylim=(0, 1.1))
    axes[0].legend(loc="lower left", framealpha=0.95)
    return figure


def relative_weights_figure(pixels: list[int], ratios: np.ndarray, gap: float) -> Figure:
    """Weight of a slightly worse particle relative to the best one, over the number of pixels that are summed."""
    figure, axes = figures.new_figure(size=(5.6, 2.8))
    axes.loglog(pixels, np.maximum(ratios, 1e-12), **figures.line_style(0))
    axes.set(title=f"A particle that is worse by {gap} a pixel", xlabel="pixels in the sum [-]")
    axes.set(ylabel="weight relative to the best [-]", ylim=(1e-12, 3))
    return figure
