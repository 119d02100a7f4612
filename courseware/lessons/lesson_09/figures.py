"""Figures of lesson 09."""

import numpy as np
from matplotlib.figure import Figure

from courseware.lessons.kit.display import described
from courseware.lessons.lesson_09.trials import Track
from courseware.plots.figures import BLACK, BLUE, SKY_BLUE, VERMILION, depth_images, line_style, new_figure

SCENE_ALT = """A corridor cut open; along it small blue ellipsoids on a dashed line, first upright, then wide, then
    small; an orange line that wanders to and fro at the start and stays behind."""
DASHED = {"color": BLACK, "linewidth": 0.9, "linestyle": (0, (6, 3))}
SMALL = {"markersize": 4}
COMPONENTS = ("place: x", "place: y", "place: z", "turn about forward", "turn about left", "turn about up")


def clouds(densities: list[tuple], n: int) -> Figure:
    """A cloud in two dimensions with its middle, how many particles are near it, and how far the nearest is."""
    alt = """A cloud of points with a small circle at its middle; the number of particles inside falls from 77 with one
        unknown to 0.06 with six, while the nearest particle is ever farther away."""
    figure, (cloud, near, nearest) = new_figure(1, 3, size=(9.6, 2.9))
    turn = np.linspace(0, 2 * np.pi, 100)
    cloud.plot(*np.random.default_rng(9).standard_normal((n, 2)).T, ".", color=BLUE, markersize=4)
    cloud.plot(0.5 * np.cos(turn), 0.5 * np.sin(turn), color=VERMILION, linewidth=1.8)
    cloud.plot(0, 0, "+", color=BLACK, markersize=11, markeredgewidth=2)
    cloud.set(title=f"{n} particles, two unknowns", xlabel="first [sigma]", ylabel="second [sigma]")
    cloud.set(xlim=(-3.2, 3.2), ylim=(-3.2, 3.2), aspect="equal")
    d, inside, distances = zip(*densities, strict=True)
    near.semilogy(d, inside, **line_style(0))
    near.axhline(1, **DASHED)
    near.set(title="Particles within half a sigma", xlabel="unknowns d [-]", ylabel="particles [-]", xticks=d)
    nearest.plot(d, distances, **line_style(3))
    nearest.set(title="Distance of the nearest one", xlabel="unknowns d [-]", ylabel="distance [sigma]", xticks=d)
    nearest.set_ylim(0, 1.1)
    return described(figure, alt)


def tracks(named: dict[str, Track]) -> Figure:
    """Errors of position and rotation over the images, on logarithmic axes."""
    alt = """Errors over 15 images on logarithmic axes: both runs of the annealed filter stay near one centimetre and
        a tenth of a degree, both runs of the paper's filter lie ten to several hundred times higher."""
    figure, (position, rotation) = new_figure(1, 2, size=(9.0, 3.2))
    for index, (name, track) in enumerate(named.items()):
        position.semilogy(track.position, **(line_style(index) | SMALL), label=name)
        rotation.semilogy(np.maximum(track.rotation, 0.01), **(line_style(index) | SMALL))
    position.set(title="Position: every fourth image", xlabel="image [-]", ylabel="error [m]", ylim=(2e-3, 20))
    rotation.set(title="Rotation: every fourth image", xlabel="image [-]", ylabel="error [degrees]", ylim=(1e-2, 300))
    position.legend(fontsize=8, framealpha=0.95)
    return described(figure, alt)


def basin(found: dict[float, tuple[np.ndarray, np.ndarray]]) -> Figure:
    """Left, where each start ended; right, the share that came back, and the views in which at least one did."""
    alt = """Left, ends of Gauss-Newton over the start's error: one group below 2 centimetres, one above the start's own
        error, little between. Right, the share that comes back falls from one to nearly none at 0.4 m."""
    figure, (ends, share) = new_figure(1, 2, size=(9.0, 3.0))
    rng, offsets, back = np.random.default_rng(9), list(found), [back for _, back in found.values()]
    for offset, (end, _) in found.items():
        ends.plot(offset * rng.uniform(0.95, 1.05, end.size), end.ravel(), ".", color=BLUE, markersize=4)
    ends.plot(offsets, offsets, **DASHED, label="no better")
    ends.set(title="Gauss-Newton from one start", xlabel="error at the start [m]", ylabel="error at the end [m]")
    ends.set(xscale="log", yscale="log")
    ends.set_xticks(offsets, [f"{o:g}" for o in offsets], minor=False)
    ends.minorticks_off()
    share.plot(offsets, [one.mean() for one in back], **line_style(0), label="of single starts")
    views = f"of views: any of {back[0].shape[1]} starts"
    share.plot(offsets, [one.any(axis=1).mean() for one in back], **line_style(1), label=views)
    share.set(title="Back within 0.05 m, 2 degrees", xlabel="error at the start [m]", ylabel="share [-]")
    share.set_ylim(0, 1.05)
    for axes in (ends, share):
        axes.legend(fontsize=8)
    return described(figure, alt)


def deviations(track: Track) -> Figure:
    """Every component's error over the images, with three sigma of what the filter expects."""
    alt = """Errors of x, y, z and of the turns about three axes over 15 images, all inside the blue bands of three
        sigma."""
    figure, grid = new_figure(2, 3, size=(9.4, 4.2))
    for k, axes in enumerate(grid.flat):
        scale, unit = (1000, "mm") if k < 3 else (np.rad2deg(1), "degrees")
        band = 3 * scale * track.error_sigmas[:, k]
        axes.fill_between(np.arange(len(band)), -band, band, color=SKY_BLUE, alpha=0.4, label="three sigma")
        axes.plot(scale * track.deviations[:, k], **(line_style(3) | SMALL), label="error")
        axes.set(title=COMPONENTS[k], xlabel="image [-]", ylabel=f"error [{unit}]")
    grid[0, 0].legend(fontsize=8)
    return described(figure, alt)


def look_alike(*images: np.ndarray) -> Figure:
    """A measured image, the map from the true pose, and the map from the pose that was found."""
    alt = """Three depth images: measured, the map from the true pose, and the map from the estimate: all show a
        corridor that runs away between two walls."""
    titles = ["measured", "the map from the true pose", "the map from the estimate"]
    return described(depth_images(images, titles, (0, 8), size=(9.6, 2.7)), alt)


def slides(named: dict[str, tuple]) -> Figure:
    """Error along a corridor's axis over the images, with three sigma, for each way of walking through it."""
    alt = """Error along the corridor's axis over eight images with three-sigma bands: bare, it falls behind by 0.7 m in
        a band that widens faster; with a pillar both vanish; with an odometer the error stays small in a widening band.
        """
    figure, grid = new_figure(1, len(named), size=(9.6, 2.8))
    for axes, (name, (errors, sigmas, _)) in zip(grid, named.items(), strict=True):
        band = 3 * sigmas[:, 0]
        axes.fill_between(np.arange(len(band)), -band, band, color=SKY_BLUE, alpha=0.4, label="three sigma")
        axes.plot(errors[:, 0], **line_style(3), label="error")
        axes.set(title=name, xlabel="image [-]", ylabel="error along the axis [m]", ylim=(-6.0, 6.0))
    grid[0].legend(fontsize=8, loc="lower left")
    return described(figure, alt)
