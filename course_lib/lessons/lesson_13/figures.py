"""Figures of lesson 13: the epipolar plane through two spheres, strips of both panoramas, the table of counts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.plots.figures import BLUE, ORANGE, VERMILION, YELLOW, new_figure
from course_lib.plots.panorama_drawing import draw_box, draw_numbers

ROWS = (300, 600)  # pixels: where the furniture is on a panorama 640 high


def strip(axes: Axes, image_bgr: np.ndarray, title: str) -> None:
    """The middle rows of a panorama, over its whole width, in edge coordinates."""
    width = image_bgr.shape[1]
    axes.imshow(image_bgr[ROWS[0] : ROWS[1], :, ::-1], extent=(0, width, ROWS[1], ROWS[0]))
    axes.grid(False)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]", xlim=(0, width), ylim=(ROWS[1], ROWS[0]))


def pair_figure(
    images: Sequence[np.ndarray], detections: Sequence[Sequence], columns: Sequence[float] = (), numbers: bool = True
) -> Figure:
    """Strips of both panoramas, upper first, with their boxes; columns: vertical lines through both, pixels."""
    figure, rows = new_figure(2, 1, size=(7.0, 4.1))
    for axes, image, found, side in zip(rows, images, detections, ("Upper", "Lower"), strict=True):
        strip(axes, image, f"{side} camera")
        for one in found:
            draw_box(axes, one.box, image.shape[1], one.label)
        for column in columns:
            axes.axvline(column, color="white", linewidth=2.6)
            axes.axvline(column, color=BLUE, linewidth=1.4)
    if numbers:
        for axes, image, found in zip(rows, images, detections, strict=True):
            draw_numbers(axes, [one.box for one in found], [one.label for one in found], image.shape[1])
    return figure


def spheres_figure(point: np.ndarray, baseline: float) -> Figure:
    """Two unit spheres, one above the other (the baseline drawn long), a point, and the plane through all three.

    point: `(3,)` metres, from the upper camera. baseline: metres.
    """
    figure, flat = new_figure(size=(6.0, 5.2))
    flat.remove()
    axes = figure.add_subplot(projection="3d")
    azimuth = np.arctan2(point[1], point[0])
    half = np.linspace(-np.pi / 2, np.pi / 2, 60)
    meridian = np.stack([np.cos(half) * np.cos(azimuth), np.cos(half) * np.sin(azimuth), np.sin(half)], axis=-1)
    turn, height = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(-np.pi / 2, np.pi / 2, 13))
    ball = np.stack([np.cos(height) * np.cos(turn), np.cos(height) * np.sin(turn), np.sin(height)])
    for name, z, colour, line in (("upper", 0.0, BLUE, "-"), ("lower", -baseline, ORANGE, "--")):
        axes.plot_wireframe(ball[0], ball[1], ball[2] + z, color="0.8", linewidth=0.4)
        centre = np.array([0.0, 0.0, z])
        axes.plot(*(meridian + centre).T, color=colour, linewidth=2.6, linestyle=line, label=f"half-circle, {name}")
        axes.plot(*np.stack([centre, point]).T, color=colour, linewidth=1.2, linestyle=line)
        seen = centre + (point - centre) / np.linalg.norm(point - centre)
        axes.plot(*seen[:, None], "o", color=colour, markersize=7)
        axes.text(*(centre + np.array([0, 0, 0.15])), name, fontsize=8, ha="right")
    axes.plot([0, 0], [0, 0], [-baseline, 0], color="black", linewidth=2.4, label="baseline")
    axes.plot(*point[:, None], "*", color=VERMILION, markersize=13, label="point")
    axes.set(title="One vertical plane cuts both spheres", xlabel="x [m]", ylabel="y [m]")
    axes.set_zlabel("z [m]", labelpad=8)
    low, high = np.minimum(point, [-1, -1, -baseline - 1]) - 0.1, np.maximum(point, 1) + 0.1
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=0.9)
    axes.view_init(elev=18, azim=np.degrees(azimuth) - 55)
    axes.legend(loc="center left", bbox_to_anchor=(1.05, 0.5), fontsize=8, frameon=False)
    return figure


def counts_figure(counts: np.ndarray, upper_names: Sequence[str], lower_names: Sequence[str]) -> Figure:
    """The table of matches `(n, m)` as a heat map with its numbers; names: of the rows and the columns.

    Objects of different classes, which are never compared, are left white. Names begin with the class.
    """
    figure, axes = new_figure(size=(7.6, 4.8))
    classes = [[name.partition(" at ")[0] for name in names] for names in (upper_names, lower_names)]
    compared = np.equal.outer(*map(np.array, classes))
    axes.imshow(np.ma.masked_array(np.sqrt(counts), ~compared), cmap="cividis", aspect="auto")
    axes.grid(False)
    for i, j in np.argwhere(compared):
        dark = np.sqrt(counts[i, j]) < 0.6 * np.sqrt(counts.max())
        axes.text(j, i, str(counts[i, j]), ha="center", va="center", fontsize=8, color="white" if dark else "black")
    axes.set_xticks(range(len(lower_names)), lower_names, rotation=40, ha="right", fontsize=8)
    axes.set_yticks(range(len(upper_names)), upper_names, fontsize=8)
    axes.set(
        title="Matched features of every two objects of one class (white: not compared)",
        xlabel="object of the lower image [class, azimuth in degrees]",
        ylabel="object of the upper image [class, azimuth in degrees]",
    )
    return figure


def matched_figure(images: Sequence[np.ndarray], detections: Sequence[Sequence], matches: Sequence) -> Figure:
    """Strips of both panoramas with the matched objects, one number a pair, and their matched features."""
    chosen = [[found[getattr(m, side)] for m in matches] for found, side in zip(detections, _SIDES, strict=True)]
    figure = pair_figure(images, chosen)
    for axes, side, image in zip(figure.axes[:2], _SIDES, images, strict=True):
        for match in matches:
            points = getattr(match, f"keypoints_{side}")
            axes.plot(points[:, 0] % image.shape[1], points[:, 1], ".", color=YELLOW, markersize=2.5)
    return figure


_SIDES = ("upper", "lower")
