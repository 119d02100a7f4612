"""Lesson 08, the corridor experiment: its figures, and a panel that runs the filter along the corridor at once."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.evaluation import PAPER_SIGMA, PositionError, nearest_path_error, summarize
from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.localizer import Estimate
from course_lib.depth_mcl.particle_filter import initial_particles, propagate, resample, weighted_mean_state
from course_lib.depth_mcl.rendering.renderer import DepthRenderer
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sensor import subsample_depth
from course_lib.depth_mcl.sequence import DepthSequence, read_sequence
from course_lib.geometry import state_from_optical_pose
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.paths import data_path
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.lesson_08.stored_runs import StoredRun, over_seeds, stored_runs, table_1
from course_lib.plots import figures
from course_lib.plots.corridor_figures import floor_plan

__all__ = ["over_seeds", "stored_runs", "table_1"]  # for the notebook: read and print the stored seeds

STRETCH = range(60, 84)  # frames that are localized live: a good two metres of the run (chosen)
# Where the panel's table is read off, metres from the true x: finely near it, where the hill is steep, and far back,
# where a filter that is lost falls behind.
OFFSETS = np.unique(np.round(np.r_[-5.4:-2.5:0.4, -2.6:2.7:0.3, -0.4:0.41:0.05], 2))
_TABLE_SIZE = (44, 36)  # pixels of the panel's images: a sixteenth, so that its table is made in seconds


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
    axes[1].set(title="Weight of the best particle", xlabel="frame [-]", ylabel="weight [-]", ylim=(0, 1.1))
    axes[0].legend(loc="lower left", framealpha=0.95)
    return figure


def relative_weights_figure(pixels: list[int], ratios: np.ndarray, gap: float) -> Figure:
    """Weight of a slightly worse particle relative to the best one, over the number of pixels that are summed."""
    figure, axes = figures.new_figure(size=(5.6, 2.8))
    axes.loglog(pixels, np.maximum(ratios, 1e-12), **figures.line_style(0))
    axes.set(title=f"A particle that is worse by {gap} a pixel", xlabel="pixels in the sum [-]")
    axes.set(ylabel="weight relative to the best [-]", ylim=(1e-12, 3))
    return figure


class AgreementTable(NamedTuple):
    """l / m of a stretch of frames for cameras that stand at the true pose but for x."""

    true: np.ndarray
    """`(T, 6)` true states."""
    path: np.ndarray
    """`(P, 3)` the path on the floor."""
    agreement: np.ndarray
    """`(T, K)` l / m at true x plus each of `OFFSETS`."""

    def at(self, frame: int, x: np.ndarray) -> np.ndarray:
        """l / m `(N,)` of particles at `x` [m] in a frame of the stretch, read between the table's places."""
        return np.interp(x - self.true[frame, 0], OFFSETS, self.agreement[frame])


@functools.cache
def agreement_table() -> AgreementTable:
    """The panel's table, made once: every frame of the stretch against small images from places along the corridor."""
    sequence = read_sequence(data_path("corridor/wagon"))
    camera = sequence.camera()
    small = camera.resized(*_TABLE_SIZE)
    true = state_from_optical_pose(sequence.camera_to_world[list(STRETCH)])
    rows = []
    with DepthRenderer(SceneMap.load(data_path("corridor/map.ply")), small) as renderer:
        for frame, state in progress(list(zip(STRETCH, true, strict=True)), "making the panel's table"):
            measured = subsample_depth(sequence.depth(frame), camera, small)
            states = np.tile(state, (len(OFFSETS), 1))
            states[:, 0] += OFFSETS
            rows.append(likelihood(measured, renderer.render(states)) / valid_pixels(measured).sum())
    return AgreementTable(true, sequence.path_on_floor, np.array(rows))


class AlongRun(NamedTuple):
    """What the filter along the corridor made of the stretch."""

    x: np.ndarray
    """`(T,)` estimates [m]."""
    nearest: PositionError
    timed: PositionError
    scores: np.ndarray
    """`(T,)` l / m of the best particle."""
    best_weights: np.ndarray
    """`(T,)` its normalized weight."""


def localize_along(
    table: AgreementTable, n_particles: int, sigma_x: float, beta: float, start_error: float, seed: int
) -> AlongRun:
    """The filter of figure 1 with x alone unknown: y and yaw are held at the truth, l / m is read from the table."""
    rng = np.random.default_rng(seed)
    sigma = np.array([sigma_x, 0, 0, 0, 0, 0])
    particles = initial_particles(table.true[0] + [start_error, 0, 0, 0, 0, 0], n_particles)
    x, scores, best = np.empty((3, len(table.true)))
    for frame in range(len(table.true)):
        particles = propagate(particles, sigma, rng)
        agreement = table.at(frame, particles[:, 0])
        w = weights(normalize_likelihood(agreement), beta)
        x[frame] = weighted_mean_state(particles, w)[0]
        scores[frame], best[frame] = agreement.max(), w.max()
        particles = particles[resample(w, rng)]
    positions = np.column_stack([x, table.true[:, 1]])
    return AlongRun(x, nearest_path_error(positions, table.path), summarize(np.abs(x - table.true[:, 0])), scores, best)


def row(run: AlongRun) -> str:
    """One row as in table 1; the table of agreement is spaced by 0.05 m, so nothing finer is told."""

    def metres(value: float) -> str:
        return "< 0.05 m" if value < 0.05 else f"{value:.2f} m"

    n, t = run.nearest, run.timed
    return (
        f"nearest path: median {metres(n.median)}, rms (sigma) {metres(n.sigma)}, <= 0.30 m: {n.within_3sigma:.0%};  "
        f"timed: median {metres(t.median)}, largest {metres(t.errors.max())}"
    )


def along_panel() -> Panel:
    """Change one parameter of the filter and predict its row of the table."""
    table = agreement_table()
    frames = np.array(STRETCH)
    figure, (place, error, signal) = figures.new_figure(1, 3, size=(9.8, 3.3))
    place.plot(frames, table.true[:, 0], color="black", linewidth=4, alpha=0.35, label="truth")
    (estimate,) = place.plot([], [], **(figures.line_style(0) | {"markersize": 3}), label="estimate")
    low, high = table.true[[0, -1], 0]
    place.set(title="Where along the corridor", xlabel="frame [-]", ylabel="x [m]", ylim=(low - 3, high + 3.5))
    lines = []
    for index, name in enumerate(("timed", "nearest path")):
        style = figures.line_style(index) | {"markersize": 3}
        lines += error.semilogy(frames, np.ones(len(frames)), **style, label=name)
    error.axhline(3 * PAPER_SIGMA, color="black", linewidth=0.9, linestyle=(0, (6, 3)), label="0.30 m")
    error.set(title="Error (below 1 cm drawn as 1 cm)", xlabel="frame [-]", ylabel="error [m]", ylim=(0.005, 100))
    for index, name in enumerate(("raw score l / m", "weight")):
        style = figures.line_style(index + 2) | {"markersize": 3}
        lines += signal.plot(frames, np.zeros(len(frames)), **style, label=name)
    signal.set(title="The best particle", xlabel="frame [-]", ylabel="score or weight [-]", ylim=(0, 1.6))
    for axes in (place, error, signal):
        axes.set_xlim(frames[0] - 1, frames[-1] + 1)
        axes.legend(loc="upper left", fontsize=8, framealpha=0.95)
    live = LiveFigure(figure, [estimate, *lines])

    def draw(sigma_x: float, n_particles: float, beta: str, start_error: float, seed: float) -> Drawing:
        run = localize_along(table, int(n_particles), sigma_x, float(beta), start_error, int(seed))
        estimate.set_data(frames, run.x)
        shown = (
            np.maximum(run.timed.errors, 0.01),
            np.maximum(run.nearest.errors, 0.01),
            run.scores,
            run.best_weights,
        )
        for line, values in zip(lines, shown, strict=True):
            line.set_data(frames, values)
        alt = (
            f"Position along the corridor, errors, and the best particle's score and weight over {len(frames)} frames, "
            f"for {int(n_particles)} particles, sigma {sigma_x:.2f} m, beta {beta}, start off by {start_error:.1f} m."
        )
        return Drawing(live.png(), alt, row(run))

    controls = [
        Slider("sigma_x", "sigma along the path [m]", 0.01, 0.6, 0.15, 0.01),
        Slider("n_particles", "number of particles N", 5, 400, 200, 5),
        Choice("beta", "beta", ("0.0001", "0.001", "0.01", "0.1", "1"), "0.01"),
        Slider("start_error", "start wrong by [m]", -2.0, 2.0, 0.0, 0.1),
        Slider("seed", "seed", 0, 9, 1, 1),
    ]
    return Panel("08 predict the table", controls, draw)


PANELS = {"08 predict the table": along_panel}
