"""Lesson 08's panel: the filter along the corridor alone, on a table of agreement that is rendered once."""

import functools
from collections import namedtuple

import numpy as np

from course_lib.depth_mcl.evaluation import PAPER_SIGMA, nearest_path_error, summarize
from course_lib.depth_mcl.likelihood import likelihood, normalize_likelihood, valid_pixels, weights
from course_lib.depth_mcl.motion import propagate
from course_lib.depth_mcl.particle_filter import initial_particles, resample, weighted_mean_state
from course_lib.geometry import state_from_optical_pose
from course_lib.rendering.renderer import DepthRenderer
from course_lib.rendering.sensor import subsample_depth
from courseware.lessons.kit.corridor_data import corridor_map, wagon_run
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.kit.progress_bar import progress
from courseware.plots import figures

STRETCH = range(60, 84)  # frames that are localized live: a good two metres of the run (chosen)
# The table's places, metres from the true x: close together near it, where the hill is steep, and far back, where a
# filter that is lost falls behind.
OFFSETS = np.unique(np.round(np.r_[-5.4:-2.5:0.4, -2.6:2.7:0.3, -0.4:0.41:0.05], 2))
TABLE_SIZE = (44, 36)  # pixels of the panel's images: a sixteenth, so that its table is made in seconds
CONTROLS = [
    Slider("sigma_x", "sigma along the path [m]", 0.01, 0.6, 0.03, 0.01),
    Slider("n_particles", "number of particles N", 5, 400, 200, 5),
    Choice("beta", "beta", ("0.0001", "0.001", "0.01", "0.1", "1"), "0.01"),
    Slider("start_error", "start wrong by [m]", -2.0, 2.0, 0.0, 0.1),
    Slider("seed", "seed", 0, 9, 1, 1),
]

# True states `(T, 6)`, the path `(P, 3)` on the floor, and l / m `(T, K)` of cameras at true x plus `OFFSETS`.
AgreementTable = namedtuple("AgreementTable", "true path agreement")
# Estimates `(T,)` [m], both errors, l / m `(T,)` of the best particle and its normalized weight `(T,)`.
AlongRun = namedtuple("AlongRun", "x nearest timed scores best_weights")


@functools.cache
def agreement_table() -> AgreementTable:
    """Render the table for the frames of `STRETCH`."""
    sequence, rows = wagon_run(), []
    camera = sequence.camera()
    small = camera.resized(*TABLE_SIZE)
    true = state_from_optical_pose(sequence.camera_to_world[list(STRETCH)])
    with DepthRenderer(corridor_map(), small) as renderer:
        for frame, state in progress(list(zip(STRETCH, true, strict=True)), "making the panel's table"):
            measured = subsample_depth(sequence.depth(frame), camera, small)
            states = state + np.outer(OFFSETS, [1, 0, 0, 0, 0, 0])
            rows.append(likelihood(measured, renderer.render(states)) / valid_pixels(measured).sum())
    return AgreementTable(true, sequence.path_on_floor, np.array(rows))


def localize_along(
    table: AgreementTable, n_particles: int, sigma_x: float, beta: float, start_error: float, seed: int
) -> AlongRun:
    """Run the filter of figure 1 with x alone unknown. y and yaw are true, and l / m is read from the table."""
    rng, rows = np.random.default_rng(seed), []
    particles = initial_particles(table.true[0] + [start_error, 0, 0, 0, 0, 0], n_particles)
    for true, hill in zip(table.true, table.agreement, strict=True):
        particles = propagate(particles, np.array([sigma_x, 0, 0, 0, 0, 0]), rng)
        agreement = np.interp(particles[:, 0] - true[0], OFFSETS, hill)
        w = weights(normalize_likelihood(agreement), beta)
        rows.append([weighted_mean_state(particles, w)[0], agreement.max(), w.max()])
        particles = particles[resample(w, rng)]
    x, scores, best = np.transpose(rows)
    nearest = nearest_path_error(np.column_stack([x, table.true[:, 1]]), table.path)
    return AlongRun(x, nearest, summarize(np.abs(x - table.true[:, 0])), scores, best)


def along_panel() -> Panel:
    """Change one parameter of the filter and predict its row of the table."""
    table, frames = agreement_table(), np.array(STRETCH)
    figure, (place, error, signal) = figures.new_figure(1, 3, size=(9.8, 3.3))
    place.plot(frames, table.true[:, 0], color="black", linewidth=4, alpha=0.35, label="truth")
    # The nearest path's line lies on the timed one wherever both are small: a thin line on a broad, pale one.
    thin, broad = {"markersize": 3}, {"linewidth": 5, "alpha": 0.4, "marker": ""}
    lines = [
        axes.plot(frames, np.ones(len(frames)), **(figures.line_style(index) | style), label=name)[0]
        for axes, index, style, name in (
            (place, 0, thin, "estimate"),
            (error, 0, broad, "timed"),
            (error, 1, thin, "nearest path"),
            (signal, 2, thin, "raw score l / m"),
            (signal, 3, thin, "normalized weight w~"),
        )
    ]
    error.axhline(3 * PAPER_SIGMA, color="black", linewidth=0.9, linestyle=(0, (6, 3)), label="0.30 m")
    error.set_yscale("log")
    low, high = table.true[[0, -1], 0]
    place.set(title="Where along the corridor", xlabel="frame [-]", ylabel="x [m]", ylim=(low - 3, high + 3.5))
    error.set(title="Error (below 1 cm drawn as 1 cm)", xlabel="frame [-]", ylabel="error [m]", ylim=(0.005, 100))
    signal.set(title="The best particle", xlabel="frame [-]", ylabel="score, weight [-]", ylim=(0, 1.6))
    for axes in (place, error, signal):
        axes.set_xlim(frames[0] - 1, frames[-1] + 1)
        axes.legend(loc="upper left", fontsize=8, framealpha=0.95)
    live = LiveFigure(figure, lines)

    def draw(sigma_x: float, n_particles: float, beta: str, start_error: float, seed: float) -> Drawing:
        run = localize_along(table, int(n_particles), sigma_x, float(beta), start_error, int(seed))
        errors = [np.maximum(found.errors, 0.01) for found in (run.timed, run.nearest)]
        for line, values in zip(lines, [run.x, *errors, run.scores, run.best_weights], strict=True):
            line.set_ydata(values)
        alt = (
            f"Position along the corridor, errors, and the best particle's score and weight over {len(frames)} frames, "
            f"for {int(n_particles)} particles, sigma {sigma_x:.2f} m, beta {beta}, start off by {start_error:.1f} m."
        )
        # The table of agreement has steps of 0.05 m, so we tell nothing finer.
        told = (run.nearest.median, run.nearest.sigma, run.timed.median, run.timed.errors.max())
        median, sigma, timed, largest = ("< 0.05 m" if value < 0.05 else f"{value:.2f} m" for value in told)
        nearest = f"median {median}, rms (sigma) {sigma}, <= 0.30 m: {run.nearest.within_3sigma:.0%}"
        return Drawing(live.png(), alt, f"nearest path: {nearest};  timed: median {timed}, largest {largest}")

    return Panel("08 predict the table", CONTROLS, draw)


PANELS = {"08 predict the table": along_panel}
