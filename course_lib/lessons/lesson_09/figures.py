"""Figures of lesson 09."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.depth_mcl.uncertainty import Tempered
from course_lib.lessons.lesson_09.basin import Basin
from course_lib.lessons.lesson_09.clouds import Density
from course_lib.lessons.lesson_09.hand import Track
from course_lib.plots import figures

COMPONENTS = ("place: x", "place: y", "place: z", "turn about forward", "turn about left", "turn about up")


def cloud_figure(densities: list[Density], n: int) -> Figure:
    """A cloud in two dimensions with its middle, how many particles are near it, and how far the nearest is."""
    figure, (cloud, near, nearest) = figures.new_figure(1, 3, size=(9.6, 2.9))
    points = np.random.default_rng(9).standard_normal((n, 2))
    cloud.plot(*points.T, ".", color=figures.BLUE, markersize=4)
    turn = np.linspace(0, 2 * np.pi, 100)
    cloud.plot(0.5 * np.cos(turn), 0.5 * np.sin(turn), color=figures.VERMILION, linewidth=1.8)
    cloud.plot(0, 0, "+", color=figures.BLACK, markersize=11, markeredgewidth=2)
    cloud.set(title=f"{n} particles, two unknowns", xlabel="first [sigma]", ylabel="second [sigma]")
    cloud.set(xlim=(-3.2, 3.2), ylim=(-3.2, 3.2), aspect="equal")
    d = [one.dimensions for one in densities]
    near.semilogy(d, [one.near for one in densities], **figures.line_style(0))
    near.axhline(1, color=figures.BLACK, linewidth=0.9, linestyle=(0, (6, 3)))
    near.set(title="Particles within half a sigma", xlabel="unknowns d [-]", ylabel="particles [-]", xticks=d)
    nearest.plot(d, [one.nearest for one in densities], **figures.line_style(3))
    nearest.set(title="Distance of the nearest one", xlabel="unknowns d [-]", ylabel="distance [sigma]", xticks=d)
    nearest.set_ylim(0, 1.1)
    return figure


def weights_figure(papers: np.ndarray, tempered: Tempered) -> Figure:
    """The greatest weights of a layer, the paper's and tempered ones, largest first."""
    figure, axes = figures.new_figure(size=(6.0, 2.9))
    for index, (name, w) in enumerate((("the paper's, beta 0.01", papers), ("tempered", tempered.weights))):
        style = figures.line_style(index) | {"markersize": 4}
        axes.semilogy(np.arange(1, 41), np.maximum(np.sort(w)[::-1][:40], 1e-6), **style, label=name)
    axes.set(title="The 40 greatest of 200 weights (below 1e-6 drawn there)", xlabel="rank [-]", ylabel="weight [-]")
    axes.legend()
    return figure


def levels_figure(measured: list[np.ndarray]) -> Figure:
    """One frame's measured image in the sizes of the pyramid."""
    titles = [f"{image.shape[1]} x {image.shape[0]}" for image in measured]
    return figures.depth_images(measured, titles, (0, 8), size=(9.2, 2.6))


def tracks_figure(tracks: dict[str, Track], title: str) -> Figure:
    """Errors of position and rotation over the images, on logarithmic axes."""
    figure, (position, rotation) = figures.new_figure(1, 2, size=(9.0, 3.0))
    for index, (name, track) in enumerate(tracks.items()):
        style = figures.line_style(index) | {"markersize": 4}
        position.semilogy(track.position, **style, label=name)
        rotation.semilogy(np.maximum(track.rotation, 0.01), **style)
    position.set(title=f"Position: {title}", xlabel="image [-]", ylabel="error [m]", ylim=(2e-3, 20))
    rotation.set(title=f"Rotation: {title}", xlabel="image [-]", ylabel="error [degrees]", ylim=(1e-2, 300))
    position.legend(fontsize=8, framealpha=0.95)
    return figure


def basin_figure(basins: list[Basin]) -> Figure:
    """Left, where each start ended; right, the share that came back, and the views in which at least one did."""
    figure, (ends, back) = figures.new_figure(1, 2, size=(9.0, 3.0))
    rng = np.random.default_rng(9)
    for one in basins:
        jitter = one.offset * rng.uniform(0.95, 1.05, one.end_position.shape)
        ends.plot(jitter.ravel(), one.end_position.ravel(), ".", color=figures.BLUE, markersize=4)
    offsets = np.array([one.offset for one in basins])
    ends.plot(offsets, offsets, color=figures.BLACK, linestyle=(0, (6, 3)), linewidth=0.9, label="no better")
    ends.set(title="Gauss-Newton from one start", xlabel="error at the start [m]", ylabel="error at the end [m]")
    ends.set(xscale="log", yscale="log")
    ends.set_xticks(offsets, [f"{o:g}" for o in offsets], minor=False)
    ends.minorticks_off()
    ends.legend(fontsize=8)
    back.plot(offsets, [one.back.mean() for one in basins], **figures.line_style(0), label="of single starts")
    any_back = [one.back.any(axis=1).mean() for one in basins]
    back.plot(offsets, any_back, **figures.line_style(1), label=f"of views: any of {basins[0].back.shape[1]} starts")
    back.set(title="Back within 0.05 m, 2 degrees", xlabel="error at the start [m]", ylabel="share [-]", ylim=(0, 1.05))
    back.legend(fontsize=8)
    return figure


def ablation_figure(shares: dict[str, tuple[float, list[float]]]) -> Figure:
    """Share of good frames with one idea after the other switched off, and 95 % intervals."""
    figure, axes = figures.new_figure(size=(6.8, 2.7))
    names = list(shares)[::-1]
    for k, name in enumerate(names):
        share, (low, high) = shares[name]
        axes.plot([low, high], [k, k], color=figures.BLUE, linewidth=2.5)
        axes.plot(share, k, "o", color=figures.VERMILION, markersize=6)
    axes.set_yticks(range(len(names)), names)
    axes.set(title="A kitchen, every 8th image", xlabel="frames within 5 cm and 5 degrees [%]", xlim=(0, 102))
    axes.set_ylabel("switched off [-]")
    return figure


def deviations_figure(track: Track) -> Figure:
    """Every component's error over the images, with three sigma of what the filter expects."""
    figure, grid = figures.new_figure(2, 3, size=(9.4, 4.2))
    sigmas = track.error_sigmas
    for k, axes in enumerate(grid.flat):
        scale, unit = (1000, "mm") if k < 3 else (np.rad2deg(1), "degrees")
        images = np.arange(len(sigmas))
        band = 3 * scale * sigmas[:, k]
        axes.fill_between(images, -band, band, color=figures.SKY_BLUE, alpha=0.4)
        axes.plot(scale * track.deviations[:, k], **(figures.line_style(3) | {"markersize": 4}))
        axes.set(title=COMPONENTS[k], xlabel="image [-]", ylabel=f"error [{unit}]")
    return figure


def coverage_figure(recordings: dict[str, list[dict]]) -> Figure:
    """Normalized squared error and share within three sigma of every recording, for every filter."""
    figure, (normalized, within) = figures.new_figure(1, 2, size=(9.4, 3.1))
    for index, (name, rows) in enumerate(recordings.items()):
        style = figures.line_style(index) | {"linestyle": "none", "markersize": 6}
        seeds = np.arange(1, len(rows) + 1) + 0.08 * (index - 1.5)
        normalized.semilogy(seeds, [row["mean_normalized_error"] for row in rows], **style, label=name)
        within.plot(seeds, [row["within_3_sigma_percent"] for row in rows], **style)
    normalized.axhline(1, color=figures.BLACK, linewidth=0.9, linestyle=(0, (6, 3)))
    within.axhline(97, color=figures.BLACK, linewidth=0.9, linestyle=(0, (6, 3)))
    normalized.set(title="Normalized squared error (honest: 1)", xlabel="recording [-]", ylabel="mean [-]")
    within.set(title="Errors within three sigma (wanted: 97 %)", xlabel="recording [-]", ylabel="share [%]")
    normalized.set_ylim(0.2, 1e5)
    normalized.legend(fontsize=7.5, loc="upper center", ncols=2, framealpha=0.95)
    return figure


def look_alike_figure(measured: np.ndarray, true: np.ndarray, found: np.ndarray) -> Figure:
    """A measured image, the map from the true pose, and the map from the pose that was found."""
    titles = ["measured", "the map from the true pose", "the map from the estimate"]
    return figures.depth_images([measured, true, found], titles, (0, 8), size=(9.6, 2.7))


def slide_figure(slides: dict) -> Figure:
    """Error along a corridor's axis over the images, with three sigma, for each way of walking through it."""
    figure, grid = figures.new_figure(1, len(slides), size=(9.6, 2.8))
    for axes, (name, one) in zip(grid, slides.items(), strict=True):
        images = np.arange(len(one.along))
        axes.fill_between(images, -3 * one.sigma_along, 3 * one.sigma_along, color=figures.SKY_BLUE, alpha=0.4)
        axes.plot(images, one.along, **figures.line_style(3))
        axes.set(title=name, xlabel="image [-]", ylabel="error along the axis [m]", ylim=(-2.0, 2.0))
    return figure
