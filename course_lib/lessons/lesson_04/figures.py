"""Figures of lesson 04: points and depth image, phase, noise, a recorded frame, two surfaces in a pixel."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.lesson_04.time_of_flight import MODEL
from course_lib.plots import figures
from course_lib.simulation.sensors.time_of_flight import SPEED_OF_LIGHT

ERRORS = np.linspace(-0.4, 0.4, 42)  # edges of an odd number of bins: one is centred at zero


def idea_figure(points: np.ndarray, image: np.ndarray) -> Figure:
    """The camera's points from above, and the depth image that they make."""
    figure, (plan, right) = figures.new_figure(1, 2, size=(9.2, 3.3))
    cloud = points.reshape(-1, 3)
    cloud = cloud[np.isfinite(cloud).all(axis=1)]
    plan.scatter(cloud[:, 0], cloud[:, 2], c=cloud[:, 2], s=1.2, cmap="cividis", vmin=0, vmax=10)
    plan.plot(0, 0, "s", color=figures.BLACK, markersize=8)
    plan.text(0.25, -0.15, "camera")
    for slope in (-0.4, 0.4):
        plan.plot([0, 10 * slope], [0, 10], color="0.6", linewidth=0.8)
    plan.set(title="What the camera delivers: points, seen from above", xlabel="X, to the right [m]")
    plan.set(ylabel="Z, along the optical axis [m]", xlim=(-4.2, 4.2), ylim=(-0.5, 10.3))
    drawn = figures.depth_image(right, image, "The same points as a depth image, eq. (7)", (0, 10))
    figures.colour_bar(figure, drawn, right)
    return figure


def phase_figure(distances: tuple[float, ...] = (2.0, 6.0, 12.0), frequency: float = MODEL.frequency) -> Figure:
    """Light that goes out and comes back later: three delays on one clock face, and the range that is read off."""
    figure, (left, right) = figures.new_figure(1, 2, size=(9.2, 3.2))
    turn = np.linspace(0, 2 * np.pi, 200)
    left.plot(np.cos(turn), np.sin(turn), color="0.75", linewidth=1)
    repeats = SPEED_OF_LIGHT / (2 * frequency)
    true = np.linspace(0, 2.2 * repeats, 2000)
    read = true % repeats
    read[np.r_[False, np.diff(read) < 0]] = np.nan
    right.plot(true, read, color="0.4", linewidth=1.6)
    for index, distance in enumerate(distances):
        phase = 2 * np.pi * distance / repeats
        style = figures.line_style(index)
        hand = 1 - 0.15 * index  # shorter and shorter, or two in one direction would hide each other
        end = hand * np.cos(phase), hand * np.sin(phase)
        left.plot([0, end[0]], [0, end[1]], **(style | {"markersize": 8}), label=f"r = {distance:g} m")
        right.plot(distance, distance % repeats, **(style | {"linestyle": "none", "markersize": 8}))
    left.set(title="The phase of what comes back", xlabel="in step with the lamp [-]", aspect="equal")
    left.set(ylabel="a quarter turn late [-]", xlim=(-1.35, 1.35), ylim=(-1.2, 1.2))
    left.legend(title="(lengths only for sight)", loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    right.set(title="What the camera reads", xlabel="true range r [m]", ylabel="range that is read [m]")
    return figure


def noise_figure(distances: list[float], sigmas_mm: list[float]) -> Figure:
    """Scatter of a wall's depth from frame to frame over its distance."""
    figure, axes = figures.new_figure(size=(5.6, 2.8))
    axes.plot(distances, sigmas_mm, **figures.line_style(0), label="measured, 20 frames")
    line = sigmas_mm[0] / distances[0] * np.array([0, distances[-1]])
    axes.plot([0, distances[-1]], line, color="0.4", linestyle="--", label="in proportion to the distance")
    axes.set(title="Noise of a white wall", xlabel="distance [m]", ylabel="one sigma [mm]", ylim=(0, None))
    axes.legend(loc="upper left")
    return figure


def recorded_figure(measured: np.ndarray, true: np.ndarray) -> Figure:
    """One recorded frame, its truth, and the histogram of its errors."""
    figure, (left, middle, right) = figures.new_figure(1, 3, size=(10.0, 2.9))
    figures.depth_image(left, measured, "Measured", (0, 12))
    drawn = figures.depth_image(middle, true, "True", (0, 12))
    figures.colour_bar(figure, drawn, [left, middle])
    error = (measured - true)[np.isfinite(measured) & np.isfinite(true)]
    right.stairs(counts(error, ERRORS), ERRORS, fill=True, color=figures.BLUE)
    error_axis(right, "Histogram of the errors")
    return figure


def two_surfaces_figure(shares: np.ndarray, curves: dict[str, np.ndarray]) -> Figure:
    """Range that a pixel reads over the share of it that the nearer of two surfaces covers."""
    figure, axes = figures.new_figure(size=(6.6, 3.0))
    for index, (name, ranges) in enumerate(curves.items()):
        axes.plot(shares, ranges, **(figures.line_style(index) | {"markevery": 10}), label=name)
    axes.set(title="One pixel, two surfaces", xlabel="share of the pixel on the nearer surface [-]")
    axes.set(ylabel="range that is read [m]", ylim=(0, 10.2))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def counts(values: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Counts in bins, those beyond both ends in the outermost ones, at least 0.5 (for a logarithmic axis)."""
    counts = np.histogram(np.clip(values, edges[0], edges[-1]), edges)[0]
    return np.maximum(counts, 0.5)


def error_axis(axes, title: str) -> None:
    axes.set(yscale="log", title=title, ylabel="pixels [-]", ylim=(0.5, 3e4), xlim=(ERRORS[0], ERRORS[-1]))
    axes.set_xlabel("measured - true depth [m]\n(outermost bars: all beyond)")
