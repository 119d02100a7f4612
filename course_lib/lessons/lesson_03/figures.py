"""Figures of lesson 03: the idea, depth images, one window of many tiles, the buffer, times."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.lesson_03.scenes import SLOPES, SURFACES
from course_lib.plots import figures


def idea_figure(hits: dict[str, list[tuple[float, float]]]) -> Figure:
    """Side view of eq. (6): rays through pixel centres, the nearest hit of each kept, the others hidden."""
    figure, axes = figures.new_figure(size=(8.2, 3.1))
    near, far = 0.6, 6.5
    for index, (start, end) in enumerate(SURFACES):
        style = figures.line_style(index) | {"marker": "", "linewidth": 3}
        axes.plot(*zip(start, end, strict=True), **style, label=f"surface {index + 1}")
    for slope in SLOPES:
        axes.plot([0, far], [0, far * slope], color="0.7", linewidth=0.8, zorder=1)
    axes.plot([1, 1], [-0.28, 0.28], color=figures.BLACK, linewidth=1.5)
    axes.annotate("screen: one ray\nper pixel centre", (1, 0.28), (0.75, 0.95), arrowprops={"arrowstyle": "-"})
    kept, hidden = (list(zip(*hits[name], strict=True)) for name in ("kept", "hidden"))
    axes.plot(*kept, "o", color=figures.VERMILION, markersize=8, label="kept: the least Z of its ray")
    axes.plot(*hidden, "o", mfc="white", color=figures.VERMILION, label="hidden: a larger Z")
    for position, name in ((near, "near"), (far, "far")):
        axes.axvline(position, color=figures.PURPLE, linestyle=":", linewidth=1.6)
        axes.text(position + 0.05, -1.62, name, color=figures.PURPLE)
    axes.plot(0, 0, "s", color=figures.BLACK, markersize=9)
    axes.text(-0.1, -0.35, "virtual\ncamera", va="top")
    axes.set(xlim=(-0.2, 7), ylim=(-1.75, 1.75), title="What a z-buffer keeps, seen from the side")
    axes.set(xlabel="depth Z along the optical axis [m]", ylabel="height [m]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8, frameon=False)
    return figure


def window_figure(images: np.ndarray, columns: int, limits: tuple[float, float]) -> Figure:
    """Depth images `(N, H, W)` as the tiles of one window, N a multiple of `columns`."""
    n, height, width = images.shape
    window = images.reshape(n // columns, columns, height, width).swapaxes(1, 2).reshape(-1, columns * width)
    figure, axes = figures.new_figure(size=(7.4, 4.3))
    drawn = figures.depth_image(axes, window, f"One window, {n} tiles: one view per particle", limits)
    axes.set(xticks=np.arange(columns + 1) * width - 0.5, yticks=np.arange(n // columns + 1) * height - 0.5)
    axes.set(xticklabels=np.arange(columns + 1) * width, yticklabels=np.arange(n // columns + 1) * height)
    axes.grid(color="white", linewidth=1.2, alpha=1)
    axes.set(xlabel="window column [pixels]", ylabel="window row [pixels]")
    figures.colour_bar(figure, drawn, axes)
    return figure


def buffer_figure(far: float = 30.0) -> Figure:
    """The depth buffer's value over depth for three near planes."""
    figure, axes = figures.new_figure(size=(6.4, 3.0))
    for index, near in enumerate((1.0, 0.1, 0.01)):
        z = np.geomspace(near, far, 200)
        style = figures.line_style(index) | {"markevery": 12}
        axes.plot(z, far * (z - near) / (z * (far - near)), **style, label=f"near = {near:g} m")
    axes.set(title="The depth buffer's value is not linear in Z", xlabel="depth Z [m]", ylabel="buffer value b [-]")
    axes.set(xlim=(-0.2, 10), ylim=(-0.02, 1.03))
    axes.legend(loc="lower right")
    return figure


def time_figure(counts: list[int], tiled: np.ndarray, single: np.ndarray) -> Figure:
    """Milliseconds a view over the number of views, as tiles of one window and one after the other."""
    figure, axes = figures.new_figure(size=(5.4, 2.8))
    axes.plot(counts, tiled * 1000, **figures.line_style(0), label="tiles of one window")
    axes.plot(counts, single * 1000, **figures.line_style(1), label="one after the other")
    axes.set(title="Time for one view, on this computer", xlabel="views [-]", ylabel="time per view [ms]")
    axes.set(xscale="log", xticks=counts, xticklabels=counts, ylim=(0, None))
    axes.minorticks_off()
    axes.legend()
    return figure
