"""Lesson 08's panel: change a parameter of the filter and predict its row of the table."""

import numpy as np

from course_lib.depth_mcl.evaluation import PAPER_SIGMA
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_08.along import STRETCH, agreement_table, localize_along, row
from course_lib.plots import figures

CONTROLS = [
    Slider("sigma_x", "sigma along the path [m]", 0.01, 0.6, 0.15, 0.01),
    Slider("n_particles", "number of particles N", 5, 400, 200, 5),
    Choice("beta", "beta", ("0.0001", "0.001", "0.01", "0.1", "1"), "0.01"),
    Slider("start_error", "start wrong by [m]", -2.0, 2.0, 0.0, 0.1),
    Slider("seed", "seed", 0, 9, 1, 1),
]


def along_panel() -> Panel:
    """Change one parameter of the filter and predict its row of the table."""
    table, frames = agreement_table(), np.array(STRETCH)
    figure, (place, error, signal) = figures.new_figure(1, 3, size=(9.8, 3.3))
    place.plot(frames, table.true[:, 0], color="black", linewidth=4, alpha=0.35, label="truth")
    # The nearest path's line lies on the timed one wherever both are small: a thin line on a broad, pale one.
    broad = {"linewidth": 5, "alpha": 0.4, "marker": ""}
    lines = [
        axes.plot(frames, np.ones(len(frames)), **(figures.line_style(index) | style), label=name)[0]
        for axes, index, style, name in (
            (place, 0, {"markersize": 3}, "estimate"),
            (error, 0, broad, "timed"),
            (error, 1, {"markersize": 3}, "nearest path"),
            (signal, 2, {"markersize": 3}, "raw score l / m"),
            (signal, 3, {"markersize": 3}, "normalized weight w~"),
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
        return Drawing(live.png(), alt, row(run))

    return Panel("08 predict the table", CONTROLS, draw)


PANELS = {"08 predict the table": along_panel}
