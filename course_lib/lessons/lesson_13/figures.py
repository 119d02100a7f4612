"""Figures of lesson 13: strips of both panoramas, and the table of counts."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course_lib.lessons.kit.display import described
from course_lib.plots.figures import BLUE, YELLOW, new_figure
from course_lib.plots.panorama_drawing import draw_box, draw_numbers

ROWS = (260, 600)  # pixels: where the furniture is on a panorama 640 high, with room for a number above it
SHOWN = 25  # matched features of an object in a figure, at most: more of them would hide it


def strip(axes: Axes, image_bgr: np.ndarray, title: str) -> None:
    """Draw the middle rows of a panorama, over its whole width, in edge coordinates."""
    width = image_bgr.shape[1]
    axes.imshow(image_bgr[ROWS[0] : ROWS[1], :, ::-1], extent=(0, width, ROWS[1], ROWS[0]))
    axes.grid(False)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]", xlim=(0, width), ylim=(ROWS[1], ROWS[0]))


def pair_figure(images: Sequence[np.ndarray], detections: Sequence[Sequence]) -> Figure:
    """Return strips of both panoramas, upper first, with their boxes."""
    figure, rows = new_figure(2, 1, size=(7.0, 4.1))
    for axes, image, found, side in zip(rows, images, detections, ("Upper", "Lower"), strict=True):
        strip(axes, image, f"{side} camera")
        for one in found:
            draw_box(axes, one.box, image.shape[1], one.label)
    return figure


def idea_figure(images: Sequence[np.ndarray], detections: Sequence[Sequence], columns: Sequence[float]) -> Figure:
    """Return strips of both panoramas with vertical lines through both at these columns [pixels]."""
    figure = pair_figure(images, detections)
    for axes in figure.axes:
        for column in columns:
            axes.axvline(column, color="white", linewidth=2.6)
            axes.axvline(column, color=BLUE, linewidth=1.4)
    return described(
        figure,
        "Strips of the upper and the lower panorama. A blue line at the left edge of each chair runs through both: "
        "it meets the same chair in both, which stands a little higher in the lower picture.",
    )


def matched_figure(images: Sequence[np.ndarray], detections: Sequence[Sequence], matches: Sequence) -> Figure:
    """Return strips of both panoramas with the matched objects, one number a pair, and some matched features."""
    sides = ("upper", "lower")
    chosen = [[found[getattr(m, side)] for m in matches] for found, side in zip(detections, sides, strict=True)]
    figure = pair_figure(images, chosen)
    for axes, image, found, side in zip(figure.axes, images, chosen, sides, strict=True):
        draw_numbers(axes, [one.box for one in found], [one.label for one in found], image.shape[1])
        for match in matches:
            points = getattr(match, f"keypoints_{side}")[:: -(-match.n_matches // SHOWN)]
            axes.plot(points[:, 0] % image.shape[1], points[:, 1], ".", color=YELLOW, markersize=2.5)
    return described(
        figure,
        "Both strips with the paired objects: the same number on the same object above and below, yellow dots where "
        "some of the features matched.",
    )


def counts_figure(counts: np.ndarray, upper_names: Sequence[str], lower_names: Sequence[str]) -> Figure:
    """Return the table of matches `(n, m)` as a heat map. Names begin with the class; only equal classes are shown."""
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
    return described(
        figure,
        "Table of matches of every two objects of one class: large numbers on the diagonal, where both boxes show "
        "one object, and nearly nothing elsewhere.",
    )
