"""Lesson 05, particles and motion: clouds that walk, an oracle that keeps the nearest, their figures and panel."""

from __future__ import annotations

import functools
import itertools
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from course_lib.depth_mcl.motion import propagate
from course_lib.depth_mcl.particle_filter import initial_particles
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.geometry import pose_matrix, state_from_optical_pose
from course_lib.lessons.kit.corridor_views import draw_walls
from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider
from course_lib.lessons.kit.paths import data_path
from course_lib.plots import figures

ONLY_MOVE, KEEP_NEAREST = "only move", "move, then keep the nearest"
_MOST_FRAMES = 60  # of the panel: the wagon rolls almost six metres (chosen)
_TICK = 0.12  # m, how long a particle's heading is drawn (chosen)
_NEAR = 0.10  # m from the wagon within which a particle is called near: the wagon's step (chosen)


@functools.cache
def wagon_states() -> np.ndarray:
    """True states `(T, 6)` of the wagon's camera."""
    states = state_from_optical_pose(read_sequence(data_path("corridor/wagon")).camera_to_world)
    states.setflags(write=False)
    return states


def corner_states(step: float = 0.1) -> np.ndarray:
    """True states `(T, 6)` of a wagon that rolls along x, turns left on an arc of 0.6 m, and goes on along y."""
    radius, before, after = 0.6, 3.1, 4.2
    quarter = radius * np.pi / 2
    way = np.arange(0, before + quarter + after, step)
    turn = np.clip((way - before) / radius, 0, np.pi / 2)
    states = np.zeros((len(way), 6))
    states[:, 0] = 14.0 + np.minimum(way, before) + radius * np.sin(turn)
    states[:, 1] = radius - radius * np.cos(turn) + np.maximum(way - before - quarter, 0)
    states[:, 2], states[:, 5] = 1.0, turn
    return states


class Walk(NamedTuple):
    """A particle set over the frames."""

    clouds: np.ndarray
    """`(T, N, 6)`, the first being the start."""
    nearest: np.ndarray
    """`(T,)` distance [m] on the floor from the wagon to its nearest particle."""
    near_share: np.ndarray
    """`(T,)` share of the particles within 0.10 m of the wagon."""


def walk(true: np.ndarray, sigma: np.ndarray, n: int, seed: int, keep_nearest: bool, own_axes: bool = False) -> Walk:
    """A cloud that starts at the first true state `(T, 6)` and moves once a frame by eq. (5).

    keep_nearest: after each move an oracle names the particle that is nearest to the wagon on the floor, and all start
    from there: the best that any weighting could do for x and y. own_axes: sigma's first two are along the wagon's
    forward and left axes, its heading given by a compass, instead of along the world's x and y.
    """
    rng = np.random.default_rng(seed)
    particles = initial_particles(true[0], n)
    clouds = [particles]
    for before, state in itertools.pairwise(true):
        moved = propagate(particles, sigma, rng)
        if own_axes:
            moved[:, :2] = particles[:, :2] + (moved - particles)[:, :2] @ pose_matrix(before)[:2, :2].T
        clouds.append(moved)
        particles = moved
        if keep_nearest:
            best = np.hypot(*(moved[:, :2] - state[:2]).T).argmin()
            particles = np.repeat(moved[best : best + 1], n, axis=0)
    clouds = np.array(clouds)
    distances = np.hypot(*np.moveaxis(clouds[:, :, :2] - true[:, None, :2], -1, 0))
    return Walk(clouds, distances.min(axis=1), (distances <= _NEAR).mean(axis=1))


def nearest_expected(sigma_x: float, sigma_y: float, n: int) -> float:
    """Mean distance [m] from the middle of a normal cloud of n particles in the plane to the nearest of them.

    Near its middle the cloud has n / (2 pi sigma_x sigma_y) particles a square metre, and the nearest of points
    scattered with density rho is 1 / (2 sqrt(rho)) away in the mean.
    """
    return 0.5 / np.sqrt(n / (2 * np.pi * sigma_x * sigma_y))


def _plan(axes: Axes, x_limits: tuple[float, float], y_limits: tuple[float, float], title: str) -> None:
    draw_walls(axes, 2, 1.0)
    axes.set(
        xlim=x_limits, ylim=y_limits, aspect="equal", title=title, xlabel="x along the corridor [m]", ylabel="y [m]"
    )


def clouds_figure(clouds: np.ndarray, frames: list[int]) -> Figure:
    """One cloud at several frames, from above, one picture below the other."""
    figure, axes = figures.new_figure(len(frames), 1, size=(8.6, 1.5 * len(frames) + 0.3))
    start = clouds[0, 0, 0]
    for a, frame in zip(axes, frames, strict=True):
        _plan(
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
    """Distance to the nearest particle over sigma: too small loses the wagon, too large thins the cloud."""
    figure, axes = figures.new_figure(size=(6.8, 3.2))
    axes.loglog(sigma_x, errors, **figures.line_style(0), label="measured, median over the frames")
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
        _plan(a, (13.3, 19.4), (-1.6, 6.4), name)
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


def cloud_panel() -> Panel:
    """Move a cloud by system noise, with or without an oracle that keeps the nearest particle."""
    true = wagon_states()[: _MOST_FRAMES + 1]
    figure, axes = figures.new_figure(2, 2, size=(9.8, 4.9))
    grid = axes[0, 0].get_gridspec()
    grid.set_height_ratios([1.25, 1])
    for unused in axes[0]:
        figure.delaxes(unused)
    plan, (spread_axes, distance_axes) = figure.add_subplot(grid[0, :]), axes[1]
    _plan(plan, (-0.5, 11.5), (-1.75, 1.75), "From above; paler clouds are earlier ones")
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
        a.set(xlim=(0, _MOST_FRAMES))
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
        Slider("frame", "frame t", 1, _MOST_FRAMES, 30, 1),
        Choice("between", "each frame", (ONLY_MOVE, KEEP_NEAREST), ONLY_MOVE),
        Slider("seed", "seed", 0, 9, 1, 1),
    ]
    return Panel("05 the cloud", controls, draw)


PANELS = {"05 the cloud": cloud_panel}
