"""Figures of lesson 08: the experiment, two errors, runs along the corridor, a lost filter, weights."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.localizer import Estimate
from course_lib.depth_mcl.sequence import DepthSequence
from course_lib.rendering.scene_map import SceneMap
from courseware.lessons.kit.display import described
from courseware.lessons.lesson_08.panel import STRETCH
from courseware.lessons.lesson_08.stored import StoredRun
from courseware.plots.corridor_figures import figure_5, floor_plan
from courseware.plots.figures import BLACK, BLUE, GREEN, ORANGE, line_style, new_figure

SCENE_ALT = "A black path along the corridor, blue arrows on it, and flat ellipsoids, longer along the corridor."


def experiment(scene_map: SceneMap, sequence: DepthSequence) -> Figure:
    """The experiment from above: the map's walls, the wagon's path, its start, the live stretch."""
    figure, axes = new_figure(size=(9.0, 2.6))
    true = sequence.camera_to_world[:, :3, 3]
    walls = floor_plan(scene_map.vertices, true[0, 2])
    wide = line_style(3) | {"marker": "", "linestyle": "-", "linewidth": 5}
    axes.plot(*walls.T, ".", color="0.6", markersize=0.7, label="map at camera height")
    axes.plot(*true[:, :2].T, **(line_style(0) | {"marker": ""}), label="path of the wagon")
    axes.plot(*true[list(STRETCH), :2].T, **wide, label="live stretch")
    axes.plot(*true[0, :2], "o", color=BLACK, markersize=7, label="start, given to the filter")
    axes.set(title="The experiment from above", xlabel="x along the corridor [m]", ylabel="y [m]", ylim=(-2.4, 3.4))
    axes.set(xlim=(true[:, 0].min() - 3, true[:, 0].max() + 5))
    axes.legend(loc="upper center", ncols=4, fontsize=8, framealpha=0.95, columnspacing=1.2)
    alt = """The corridor from above: walls with niches, the wagon's winding path between them, and its start on the
        left."""
    return described(figure, alt)


def two_errors() -> tuple[Figure, dict[str, float]]:
    """One estimate that lies on the path but far behind: its two errors, drawn and in metres."""
    x = np.linspace(0, 4, 200)
    path = np.column_stack([x, 0.25 * np.sin(1.4 * x)])
    true, estimate = path[165], path[75] + [0.0, 0.12]
    distances = np.linalg.norm(path - estimate, axis=1)
    figure, axes = new_figure(size=(8.2, 2.5))
    axes.plot(*path.T, color="black", linewidth=1.4, label="path on the floor")
    for index, place, name in ((0, true, "camera, now"), (3, estimate, "estimate, now")):
        axes.plot(*place, **(line_style(index) | {"linestyle": "none", "markersize": 9}), label=name)
    axes.plot(*zip(estimate, true, strict=True), color=ORANGE, linestyle="--", linewidth=2, label="timed error")
    nearest = list(zip(estimate, path[distances.argmin()], strict=True))
    axes.plot(*nearest, color=GREEN, linewidth=3.5, label="nearest-path error")
    axes.set(title="Two errors of one estimate", xlabel="x [m]", ylabel="y [m]", ylim=(-0.55, 0.65))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = "A winding path; the camera is far along it; the estimate lies beside its beginning, close to the path."
    errors = {"timed error": np.linalg.norm(estimate - true), "nearest-path error": distances.min()}
    return described(figure, alt), errors


def as_in_the_paper(run: StoredRun, path: np.ndarray) -> Figure:
    """Figures 5 and 6 of the paper: its own method alone, on plain axes. path: the line on the floor `(P, 3)` [m]."""
    figure, (place, error) = new_figure(2, 1, size=(8.0, 4.6))
    place.get_gridspec().set_height_ratios([1.0, 1.5])
    place.plot(path[:, 0], path[:, 1], color="black", linewidth=1.1, zorder=4, label="ground truth")
    dots = line_style(0) | {"linestyle": "none", "markersize": 2.5}
    place.plot(*run.positions("proposed").T, **dots, label="estimated position")
    place.set(title="As figure 5: ground truth and estimates", xlabel="x [m]", ylabel="y [m]", ylim=(-0.6, 0.9))
    place.legend(loc="upper center", ncols=2, fontsize=8, framealpha=0.95)
    error.plot(run.columns["frame"], run.columns["proposed_nearest_m"], color=BLUE, linewidth=1.0)
    error.set(title="As figure 6: distance to the nearest point of the path", xlabel="frame [-]", ylabel="error [m]")
    error.set_ylim(0, None)
    alt = "Above, the winding true path with our estimates on it; below, our error of every frame, mostly below 0.05 m."
    return described(figure, alt)


def figure_5_beside(run: StoredRun, sequence: DepthSequence, scene_map: SceneMap) -> Figure:
    """Figure 5 of the paper with the Fallon-style filter beside ours, and the map's walls."""
    shown = {"ours": run.positions("proposed"), "Fallon-style, 20 x 15": run.positions("fallon")}
    walls = floor_plan(scene_map.vertices, sequence.camera_to_world[0, 2, 3])
    alt = "The true path from above with our estimates along all of it, and the Fallon-style estimates near it."
    return described(figure_5(sequence.path_on_floor, shown, walls), alt)


def along(run: StoredRun, true_x: np.ndarray) -> Figure:
    """Estimated and true position along the corridor over the frames."""
    figure, axes = new_figure(size=(8.0, 3.0))
    axes.plot(true_x, color="black", linewidth=3, alpha=0.35, label="truth")
    for index, method in enumerate(("proposed", "fallon")):
        style = line_style(index) | {"marker": "", "linewidth": 1.4}
        axes.plot(run.positions(method)[:, 0], **style, label=run.summary["methods"][method]["name"])
    axes.set(title="Where along the corridor, and when", xlabel="frame [-]", ylabel="x [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    alt = "Position along the corridor over the frames: ours on the true line, the Fallon-style one far from it."
    return described(figure, alt)


def lost(frames: range, runs: dict[str, list[Estimate]]) -> Figure:
    """Two signals over the frames, for every run: the best particle's raw score, and its normalized weight."""
    figure, (score, weight) = new_figure(1, 2, size=(8.8, 2.8))
    for index, (name, estimates) in enumerate(runs.items()):
        style = line_style(index) | {"markersize": 4}
        score.plot(frames, [e.score for e in estimates], **style, label=name)
        weight.plot(frames, [e.weights.max() for e in estimates], **style, label=name)
    score.set(title="Raw score of the best particle", xlabel="frame [-]", ylabel="l / m [-]", ylim=(0, 0.9))
    weight.set(title="Its normalized weight, eq. (11)", xlabel="frame [-]", ylabel="weight w~ [-]", ylim=(0, 1.1))
    score.legend(loc="lower left", framealpha=0.95)
    alt = """Left, the raw score stays level for the good run and falls for the lost one; right, the normalized
        weights of both runs do not tell which one is lost."""
    return described(figure, alt)


def relative_weights(pixels: list[int], ratios: np.ndarray, gap: float) -> Figure:
    """Weight of a slightly worse particle relative to the best one, over the number of pixels that are summed."""
    figure, axes = new_figure(size=(5.6, 2.8))
    axes.loglog(pixels, np.maximum(ratios, 1e-12), **line_style(0))
    axes.set(title=f"A particle that is worse by {gap} a pixel", xlabel="pixels in the sum [-]")
    axes.set(ylabel="weight relative to the best [-]", ylim=(1e-12, 3))
    alt = "The weight of a slightly worse particle falls from near 1 to almost nothing as more pixels are summed."
    return described(figure, alt)
