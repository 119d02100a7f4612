"""Figures of lesson 20: a frame beside its map, and a track."""

import numpy as np
from matplotlib.figure import Figure

from course_lib.lessons.lesson_20.readings import Compared, Recording
from course_lib.plots import figures

_DIFFERENCE_LIMIT = 0.3  # metres, end of the colour scale of differences


def compared_axes(compared: Compared, size: tuple[float, float]):
    figure, axes = figures.new_figure(1, 3, size=size)
    finite = compared.measured[np.isfinite(compared.measured)]
    limits = (0.0, float(np.ceil(np.percentile(finite, 98))) if len(finite) else 5.0)
    drawn = [
        figures.depth_image(axes[0], compared.measured, "Measured", limits),
        figures.depth_image(axes[1], compared.seen, "The map, from the given pose", limits),
        figures.depth_image(axes[2], compared.difference, "Difference", (0.0, _DIFFERENCE_LIMIT)),
    ]
    for a in axes[1:]:
        a.set_ylabel("v [pixels]")
    figures.colour_bar(figure, drawn[1], axes[:2])
    figures.colour_bar(figure, drawn[2], axes[2], "|z - z_map| [m]")
    return figure, drawn


def check_figure(compared: Compared) -> Figure:
    """A frame, the map seen from its pose, and the difference of the two."""
    return compared_axes(compared, (9.4, 2.7))[0]


def track_figure(given: Recording, estimated: np.ndarray) -> Figure:
    """True and estimated camera positions of the first frames, over the frames.

    estimated: `(T, 4, 4)` camera-to-world matrices.
    """
    true = given.sequence.camera_to_world[: len(estimated), :3, 3]
    moved, found = true - true[0], estimated[:, :3, 3] - true[0]
    reach = 1.1 * max(0.3, np.abs(moved).max(), np.abs(found).max())
    figure, axes = figures.new_figure(1, 3, size=(9.0, 2.5))
    for index, (a, name) in enumerate(zip(axes, "xyz", strict=True)):
        a.plot(moved[:, index], color="black", linewidth=3, alpha=0.35, label="given in poses.txt")
        a.plot(found[:, index], **(figures.line_style(0) | {"linestyle": "none"}), label="estimate")
        a.set(title=f"{name} since the first frame", xlabel="frame [-]", ylabel=f"{name} [m]", ylim=(-reach, reach))
    axes[0].legend(loc="lower left", fontsize=8, framealpha=0.9)
    return figure
