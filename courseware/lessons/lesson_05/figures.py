"""Figures of lesson 05, and its panel: a cloud that moves by system noise, with or without the oracle."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from courseware.lessons.kit.corridor_data import draw_walls
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider
from courseware.lessons.lesson_05.simulations import Walk, distances, wagon_states, walk
from courseware.plots import figures

SCENE_ALT = """Two clouds of arrowheads in a corridor: a small black one, all nearly alike, and a blue one that is
    metres long, not quite one wide, flat as a sheet of paper, with headings that fan out."""


def draw_plan(axes: Axes, xlim: tuple, ylim: tuple, title: str) -> None:
    draw_walls(axes, 2, 1.0)
    axes.set(xlim=xlim, ylim=ylim, aspect="equal", title=title, xlabel="x along the corridor [m]", ylabel="y [m]")


def clouds_figure(clouds: np.ndarray, frames: list[int]) -> Figure:
    """Draw one cloud at several frames, from above, one picture below the other."""
    figure, axes = figures.new_figure(len(frames), 1, size=(8.6, 1.5 * len(frames) + 0.3))
    x, y = clouds[0, 0, :2]
    for a, frame in zip(axes, frames, strict=True):
        draw_plan(a, (x - 5, x + 5), (-1.45, 1.3), f"{frame} frame{'s' * (frame > 1)} after the start (+)")
        a.plot(*clouds[frame, :, :2].T, ".", color=figures.BLUE, markersize=3)
        a.plot(x, y, "+", color=figures.VERMILION, markersize=13, markeredgewidth=2)
        a.set(xlabel="")
        a.tick_params(labelbottom=frame == frames[-1])
    figure.supxlabel("x along the corridor [m]", fontsize=9)
    alt = "The corridor from above, three times: a cloud of 200 particles after 1, 5 and 20 frames, wider every time."
    return described(figure, alt)


def beliefs_figure(beliefs: dict[str, np.ndarray], doors: list[int]) -> Figure:
    """Draw beliefs over the cells of a corridor as bars, and the doors below them."""
    figure, axes = figures.new_figure(2, 2, size=(9.4, 4.4))
    for a, (title, belief) in zip(axes.flat, beliefs.items(), strict=True):
        a.bar(np.arange(len(belief)), belief, color=figures.SKY_BLUE, label="belief, exact")
        a.plot(doors, np.full(len(doors), -0.025), "s", color=figures.VERMILION, markersize=7, label="door")
        a.set(title=title, xlabel="cell of the corridor", ylabel="probability [-]", ylim=(-0.05, 0.4))
        a.set_xticks(range(0, len(belief), 5), [str(cell) for cell in range(0, len(belief), 5)])
    axes[0, 1].legend(loc="upper right", fontsize=8)
    alt = """Probabilities of 20 cells. There are five equal peaks at the doors. A move shifts them by one cell and
        blurs them. After the fourth look cell 5 alone stands out with 0.35."""
    return described(figure, alt)


def spread_figure(frames: np.ndarray, spreads: dict[str, np.ndarray], sigma: float) -> Figure:
    """Draw the measured spread over the frames, and sqrt(t) sigma."""
    labels = {"xlabel": "frame t [-]", "ylabel": "spread in x [m]", "ylim": (0, 2.2 * sigma * np.sqrt(frames[-1]))}
    labels["title"] = "Spread of a cloud that only moves"
    figure, axes = figures.curves_figure(frames, spreads, (6.4, 3.0), 10, **labels)
    axes.plot(frames, sigma * np.sqrt(frames), color="black", linewidth=1.0, label="closed form, sqrt(t) sigma")
    axes.plot(frames, sigma * frames, color="0.5", linestyle=":", linewidth=1.4, label="if steps added up, t sigma")
    axes.legend(**figures.BESIDE, fontsize=8)
    alt = "Spread over 100 frames: 2000 particles follow the root of t, ten particles stray from it."
    return described(figure, alt)


def trade_figure(sigma_x: np.ndarray, errors: np.ndarray, threshold: float, expected: np.ndarray) -> Figure:
    """Draw the distance to the nearest particle over sigma, for `errors` (sigmas, runs)."""
    figure, axes = figures.new_figure(size=(6.8, 3.2))
    axes.loglog(sigma_x, np.median(errors, axis=1), **figures.line_style(0), label="mean over the frames, median run")
    axes.loglog(sigma_x, errors, ".", color=figures.BLUE, markersize=3)
    axes.loglog(sigma_x, expected, color="black", linewidth=1.0, label="too large: from the cloud's density")
    axes.axvline(threshold, color=figures.VERMILION, linestyle="--", label="too small: step / farthest of N")
    axes.set(title="How near the best particle is to the wagon", xlabel="sigma along the corridor [m]")
    axes.set(ylabel="distance [m]", ylim=(1e-3, 30))
    axes.legend(**figures.BESIDE, fontsize=8)
    alt = (
        "Distance to the nearest particle over sigma: metres below 0.035 m, a minimum near 0.07 m, then a steady rise."
    )
    return described(figure, alt)


def corner_figure(true: np.ndarray, walks: dict[str, Walk], frames: list[int]) -> Figure:
    """Draw a wagon that turns into the side corridor, with the clouds at a few frames, one picture a walk."""
    figure, axes = figures.new_figure(1, len(walks), size=(4.0 * len(walks), 4.2))
    for a, (name, own) in zip(axes, walks.items(), strict=True):
        draw_plan(a, (13.3, 19.4), (-1.6, 6.4), name)
        a.plot(*true[:, :2].T, color="black", linewidth=1.2, label="path of the wagon")
        for frame in frames:
            cloud, wagon = ("cloud", "wagon") if frame == frames[0] else (None, None)
            a.plot(*own.clouds[frame, :, :2].T, ".", color=figures.SKY_BLUE, markersize=2.5, label=cloud)
            a.plot(*true[frame, :2], "D", color=figures.VERMILION, markersize=6, label=wagon)
    axes[0].legend(loc="upper left", fontsize=8, framealpha=0.95)
    alt = "A wagon turns left into a side corridor; noise along world axes falls behind, along its own axes it follows."
    return described(figure, alt)


MAX_FRAMES = 60  # of the panel: the wagon rolls almost six metres (chosen)
KEEP_NEAREST = "move, then keep the nearest"
CONTROLS = [
    Slider("sigma_x", "sigma in x [m]", 0.0, 0.4, 0.15, 0.005),
    Slider("sigma_y", "sigma in y [m]", 0.0, 0.4, 0.04, 0.01),
    Slider("sigma_yaw", "sigma in yaw [degrees]", 0.0, 20.0, 1.5, 0.5),
    Slider("n", "number of particles N", 5, 1000, 200, 5),
    Slider("frame", "frame t", 1, MAX_FRAMES, 30, 1),
    Choice("between", "each frame", ("only move", KEEP_NEAREST), "only move"),
    Slider("seed", "seed", 0, 9, 1, 1),
]


def cloud_panel() -> Panel:
    """Move a cloud by system noise, with or without an oracle that keeps the nearest particle."""
    path, frames = wagon_states()[: MAX_FRAMES + 1], np.arange(MAX_FRAMES + 1)
    figure, (above, (spread_axes, distance_axes)) = figures.new_figure(2, 2, size=(9.8, 4.9))
    grid = above[0].get_gridspec()
    grid.set_height_ratios([1.25, 1])
    for unused in above:
        unused.remove()
    plan = figure.add_subplot(grid[0, :])
    draw_plan(plan, (-0.5, 11.5), (-1.75, 1.75), "From above; paler clouds are earlier ones")
    plan.plot(*path[:, :2].T, color="black", linewidth=1.0, zorder=3, label="its path")
    shades = {"#C9DEEE": 2.5, "#9CC3E0": 2.5, "#6BA3CF": 2.5, figures.BLUE: 3.0}
    clouds = [plan.plot([], [], ".", color=shade, markersize=size)[0] for shade, size in shades.items()]
    clouds[3].set_label("particles, now (dash: heading)")
    dashes = plan.add_collection(LineCollection([], colors=figures.BLUE, linewidths=0.7, alpha=0.7), autolim=False)
    (wagon,) = plan.plot([], [], "D", color=figures.VERMILION, markersize=8, label="wagon, now")
    plan.legend(loc="lower right", fontsize=8, framealpha=0.95, ncols=3)
    styles = [figures.line_style(index) | {"markevery": 5} for index in (0, 3, 2)]
    curves = [
        *spread_axes.plot([], [], **styles[0], label="measured"),
        *spread_axes.plot([], [], color="black", linewidth=1.0, label="sqrt(t) sigma"),
        *distance_axes.semilogy([], [], **styles[1], label="cloud's middle"),
        *distance_axes.semilogy([], [], **styles[2], label="nearest particle"),
    ]
    spread_axes.set(title="Spread of the cloud in x", ylabel="spread [m]", ylim=(0, 3.3))
    title = "Distance from the wagon (below 1 mm drawn as 1 mm)"
    distance_axes.set(title=title, ylabel="distance [m]", ylim=(0.0008, 30))
    for a in (spread_axes, distance_axes):
        a.set(xlim=(0, MAX_FRAMES), xlabel="frame t [-]")
        a.legend(loc="upper left", fontsize=8, framealpha=0.95, ncols=2)
    live = LiveFigure(figure, [*clouds, dashes, wagon, *curves])

    def draw(sigma_x: float, sigma_y: float, sigma_yaw: float, n: float, frame: float, between: str, seed: float):
        t, sigma = int(frame), np.array([sigma_x, sigma_y, 0, 0, 0, np.deg2rad(sigma_yaw)])
        true = path[: t + 1]
        own = walk(true, sigma, int(n), int(seed), between == KEEP_NEAREST)
        for cloud, when in zip(clouds, (t // 4, t // 2, 3 * t // 4, t), strict=True):
            cloud.set_data(*own.clouds[when, :, :2].T)
        here, yaw = own.clouds[t, :, :2], own.clouds[t, :, 5]
        dashes.set_segments(np.stack([here, here + 0.12 * np.column_stack([np.cos(yaw), np.sin(yaw)])], axis=1))
        wagon.set_data(true[-1:, 0], true[-1:, 1])
        spread = own.clouds[:, :, 0].std(axis=1)
        middle = distances(own.clouds.mean(axis=1, keepdims=True), true)[:, 0]
        shown = (spread, sigma_x * np.sqrt(frames[: t + 1]), np.maximum(middle, 1e-3), np.maximum(own.nearest, 1e-3))
        for curve, values in zip(curves, shown, strict=True):
            curve.set_data(frames[: t + 1], values)
        near_share = (distances(own.clouds[t:], true[t:]) <= 0.10).mean()
        summary = (
            f"spread in x after {t} frames: {spread[-1]:.2f} m (sqrt(t) sigma: {sigma_x * np.sqrt(t):.2f} m)\n"
            f"nearest particle {own.nearest[-1]:.3f} m from the wagon; within 0.10 m of it: {near_share:.0%}"
        )
        alt = f"""Clouds of {int(n)} particles from above over {t} frames ({between}), sigma {sigma_x:.3f} m in x,
            {sigma_y:.2f} m in y, {sigma_yaw:.1f} degrees in yaw; their spread and their distance from the wagon."""
        return Drawing(live.png(), alt, summary)

    return Panel("05 the cloud", CONTROLS, draw)


PANELS = {"05 the cloud": cloud_panel}
