"""Lesson 05's panel: move a cloud by system noise, with or without the oracle."""

import numpy as np
from matplotlib.collections import LineCollection

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.lesson_05.clouds import wagon_states, walk
from course_lib.lessons.lesson_05.figures import draw_plan
from course_lib.plots import figures

ONLY_MOVE, KEEP_NEAREST = "only move", "move, then keep the nearest"
_MAX_FRAMES = 60  # of the panel: the wagon rolls almost six metres (chosen)
_TICK = 0.12  # m, how long a particle's heading is drawn (chosen)


def cloud_panel() -> Panel:
    """Move a cloud by system noise, with or without an oracle that keeps the nearest particle."""
    true = wagon_states()[: _MAX_FRAMES + 1]
    figure, axes = figures.new_figure(2, 2, size=(9.8, 4.9))
    grid = axes[0, 0].get_gridspec()
    grid.set_height_ratios([1.25, 1])
    for unused in axes[0]:
        figure.delaxes(unused)
    plan, (spread_axes, distance_axes) = figure.add_subplot(grid[0, :]), axes[1]
    draw_plan(plan, (-0.5, 11.5), (-1.75, 1.75), "From above; paler clouds are earlier ones")
    plan.plot(*true[:, :2].T, color="black", linewidth=1.0, zorder=3, label="its path")
    moving = []
    for shade, size in (("#C9DEEE", 2.5), ("#9CC3E0", 2.5), ("#6BA3CF", 2.5), (figures.BLUE, 3.0)):
        moving += plan.plot([], [], ".", color=shade, markersize=size)
    ticks = plan.add_collection(LineCollection([], colors=figures.BLUE, linewidths=0.7, alpha=0.7), autolim=False)
    moving += plan.plot([], [], "D", color=figures.VERMILION, markersize=8, label="wagon, now")
    moving[3].set_label("particles, now (dash: heading)")
    plan.legend(loc="lower right", fontsize=8, framealpha=0.95, ncols=3)
    frames = np.arange(len(true))
    curves = spread_axes.plot([], [], **(figures.line_style(0) | {"markevery": 5}), label="measured")
    curves += spread_axes.plot([], [], color="black", linewidth=1.0, label="sqrt(t) sigma")
    spread_axes.set(title="Spread of the cloud in x", xlabel="frame t [-]", ylabel="spread [m]", ylim=(0, 3.3))
    for index, name in ((3, "cloud's middle"), (2, "nearest particle")):
        curves += distance_axes.semilogy([], [], **(figures.line_style(index) | {"markevery": 5}), label=name)
    distance_axes.set(
        title="Distance from the wagon (below 1 mm drawn as 1 mm)", xlabel="frame t [-]", ylabel="distance [m]"
    )
    distance_axes.set(ylim=(0.0008, 30))
    for a in (spread_axes, distance_axes):
        a.set(xlim=(0, _MAX_FRAMES))
        a.legend(loc="upper left", fontsize=8, framealpha=0.95, ncols=2)
    live = LiveFigure(figure, [*moving[:4], ticks, moving[4], *curves])

    def draw(
        sigma_x: float, sigma_y: float, sigma_yaw: float, n: float, frame: float, between: str, seed: float
    ) -> Drawing:
        t = int(frame)
        sigma = np.array([sigma_x, sigma_y, 0, 0, 0, np.deg2rad(sigma_yaw)])
        own = walk(true[: t + 1], sigma, int(n), int(seed), between == KEEP_NEAREST)
        for cloud, when in zip(moving[:4], (t // 4, t // 2, 3 * t // 4, t), strict=True):
            cloud.set_data(*own.clouds[when, :, :2].T)
        here, yaw = own.clouds[t, :, :2], own.clouds[t, :, 5]
        ticks.set_segments(np.stack([here, here + _TICK * np.column_stack([np.cos(yaw), np.sin(yaw)])], axis=1))
        moving[4].set_data([true[t, 0]], [true[t, 1]])
        spread = own.clouds[:, :, 0].std(axis=1)
        middle = np.hypot(*(own.clouds[:, :, :2].mean(axis=1) - true[: t + 1, :2]).T)
        shown = (spread, sigma_x * np.sqrt(frames[: t + 1]), np.maximum(middle, 1e-3), np.maximum(own.nearest, 1e-3))
        for curve, values in zip(curves, shown, strict=True):
            curve.set_data(frames[: t + 1], values)
        lines = [
            f"spread in x after {t} frames: {spread[-1]:.2f} m (sqrt(t) sigma: {sigma_x * np.sqrt(t):.2f} m)",
            f"nearest particle {own.nearest[-1]:.3f} m from the wagon; within 0.10 m of it: {own.near_share[-1]:.0%}",
        ]
        alt = (
            f"Clouds of {int(n)} particles from above over {t} frames ({between}), sigma {sigma_x:.3f} m in x, "
            f"{sigma_y:.2f} m in y, {sigma_yaw:.1f} degrees in yaw; their spread and their distance from the wagon."
        )
        return Drawing(live.png(), alt, "\n".join(lines))

    controls = [
        Slider("sigma_x", "sigma in x [m]", 0.0, 0.4, 0.15, 0.005),
        Slider("sigma_y", "sigma in y [m]", 0.0, 0.4, 0.04, 0.01),
        Slider("sigma_yaw", "sigma in yaw [degrees]", 0.0, 20.0, 1.5, 0.5),
        Slider("n", "number of particles N", 5, 1000, 200, 5),
        Slider("frame", "frame t", 1, _MAX_FRAMES, 30, 1),
        Choice("between", "each frame", (ONLY_MOVE, KEEP_NEAREST), ONLY_MOVE),
        Slider("seed", "seed", 0, 9, 1, 1),
    ]
    return Panel("05 the cloud", controls, draw)


PANELS = {"05 the cloud": cloud_panel}
