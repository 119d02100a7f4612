"""Figures of lesson 05: clouds from above, their spread, the choice of sigma, a corner."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.lessons.kit.corridor_views import draw_walls
from course_lib.lessons.lesson_05.clouds import Walk
from course_lib.plots import figures


def draw_plan(axes: Axes, x_limits: tuple[float, float], y_limits: tuple[float, float], title: str) -> None:
    draw_walls(axes, 2, 1.0)
    axes.set(
        xlim=x_limits, ylim=y_limits, aspect="equal", title=title, xlabel="x along the corridor [m]", ylabel="y [m]"
    )


def clouds_figure(clouds: np.ndarray, frames: list[int]) -> Figure:
    """One cloud at several frames, from above, one picture below the other."""
    figure, axes = figures.new_figure(len(frames), 1, size=(8.6, 1.5 * len(frames) + 0.3))
    start = clouds[0, 0, 0]
    for a, frame in zip(axes, frames, strict=True):
        draw_plan(
            a,
            (start - 5, start + 5),
            (-1.45, 1.3),
            f"{frame} {'frame' if frame == 1 else 'frames'} after the start (+)",
        )
        a.plot(*clouds[frame, :, :2].T, ".", color=figures.BLUE, markersize=3)
        a.plot(*clouds[0, 0, :2], "+", color=figures.VERMILION, markersize=13, markeredgewidth=2)
        if frame != frames[-1]:
            a.set(xlabel="")
            a.tick_params(labelbottom=False)
    figure.supxlabel("x along the corridor [m]", fontsize=9)
    axes[-1].set(xlabel="")
    return figure


def beliefs_figure(beliefs: dict[str, np.ndarray], doors: list[int], shares: dict[str, np.ndarray]) -> Figure:
    """Beliefs over the cells of a corridor as bars, doors marked below; dots: the shares of a particle set."""
    figure, axes = figures.new_figure(2, 2, size=(9.4, 4.4))
    for a, (title, belief) in zip(axes.flat, beliefs.items(), strict=True):
        a.bar(np.arange(len(belief)), belief, color=figures.SKY_BLUE, label="belief, exact")
        a.plot(doors, np.full(len(doors), -0.025), "s", color=figures.VERMILION, markersize=7, label="door")
        if title in shares:
            a.plot(shares[title], "o", color=figures.BLACK, markersize=4, label="200 particles")
            a.legend(loc="upper right", fontsize=8)
        a.set(title=title, xlabel="cell of the corridor [-]", ylabel="probability [-]")
        a.set(ylim=(-0.05, 0.4), xticks=np.arange(0, len(belief), 5))
    return figure


def spread_figure(frames: np.ndarray, spreads: dict[str, np.ndarray], sigma: float) -> Figure:
    """Measured spread over the frames, and sqrt(t) sigma."""
    figure, axes = figures.new_figure(size=(6.4, 3.0))
    for index, (name, spread) in enumerate(spreads.items()):
        axes.plot(frames, spread, **(figures.line_style(index) | {"markevery": 10}), label=name)
    axes.plot(frames, sigma * np.sqrt(frames), color="black", linewidth=1.0, label="closed form, sqrt(t) sigma")
    axes.plot(frames, sigma * frames, color="0.5", linestyle=":", linewidth=1.4, label="if steps added up, t sigma")
    axes.set(title="Spread of a cloud that only moves", xlabel="frame t [-]", ylabel="spread in x [m]")
    axes.set(ylim=(0, 2.2 * sigma * np.sqrt(frames[-1])))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure


def trade_figure(sigma_x: np.ndarray, errors: np.ndarray, threshold: float, expected: np.ndarray) -> Figure:
    """Distance to the nearest particle over sigma, `errors` (sigmas, runs): too small loses, too large thins."""
    figure, axes = figures.new_figure(size=(6.8, 3.2))
    axes.loglog(sigma_x, np.median(errors, axis=1), **figures.line_style(0), label="mean over the frames, median run")
    axes.loglog(sigma_x, errors, ".", color=figures.BLUE, markersize=3)
    axes.loglog(sigma_x, expected, color="black", linewidth=1.0, label="too large: from the cloud's density")
    axes.axvline(threshold, color=figures.VERMILION, linestyle="--", label="too small: step / farthest of N")
    axes.set(title="How near the best particle is to the wagon", xlabel="sigma along the corridor [m]")
    axes.set(ylabel="distance [m]", ylim=(1e-3, 30))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure


def corner_figure(true: np.ndarray, walks: dict[str, Walk], frames: list[int]) -> Figure:
    """A wagon that turns into the side corridor, with the clouds at a few frames, one picture a walk."""
    figure, axes = figures.new_figure(1, len(walks), size=(4.0 * len(walks), 4.2))
    for a, (name, own) in zip(axes, walks.items(), strict=True):
        draw_plan(a, (13.3, 19.4), (-1.6, 6.4), name)
        a.plot(*true[:, :2].T, color="black", linewidth=1.2, label="path of the wagon")
        for k, frame in enumerate(frames):
            a.plot(
                *own.clouds[frame, :, :2].T,
                ".",
                color=figures.SKY_BLUE,
                markersize=2.5,
                label="cloud" if not k else None,
            )
            a.plot(*true[frame, :2], "D", color=figures.VERMILION, markersize=6, label="wagon" if not k else None)
    axes[0].legend(loc="upper left", fontsize=8, framealpha=0.95)
    return figure
