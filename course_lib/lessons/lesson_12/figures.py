"""Figures of lesson 12: boxes on an extended panorama, a picture of the training, thresholds, boxes close up."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from course_lib.experiments.intervals import wilson_percent
from course_lib.lessons.kit.display import described
from course_lib.lessons.lesson_12.measures import ThresholdScore, TrainingPicture, anchors
from course_lib.plots.figures import BLACK, VERMILION, YELLOW, line_style, new_figure
from course_lib.plots.panorama_drawing import CLASS_STYLES, class_style, draw_box, panorama
from course_lib.spherical_stereo.detection.seam import extend_seam, valid_range

CROP = 220  # pixels of the square in which a box is shown
INPUT_SCALE = 0.8  # pixels of the network's input per pixel of a panorama 1280 wide


def brighter(image_bgr: np.ndarray) -> np.ndarray:
    """Return the picture as we draw it, with its dark parts lifted. The network gets it as it is."""
    return cv2.LUT(image_bgr, np.round(255 * (np.arange(256) / 255) ** 0.65).astype(np.uint8))


def class_legend(figure: Figure, labels: Iterable[str] = CLASS_STYLES) -> None:
    """Say which colour a box of a class has, below everything else."""
    shown = [label for label in CLASS_STYLES if label in set(labels)]
    handles = [Line2D([], [], color=class_style(label)[0], linewidth=2.4) for label in shown]
    figure.legend(handles, shown, loc="outside lower center", ncols=len(shown), frameon=False, fontsize=8)


def outline(box: Sequence[float]) -> np.ndarray:
    """Return the five corners `(5, 2)` of a box, back to the first."""
    return np.take(box, [[0, 1], [2, 1], [2, 3], [0, 3], [0, 1]])


def extended_axes(axes: Axes, image_bgr: np.ndarray, title: str) -> list[Artist]:
    """Draw the panorama with its left quarter appended (pale), the seam, and the range that counts (dashed)."""
    extended = extend_seam(brighter(image_bgr))[..., ::-1]
    (height, end), width = extended.shape[:2], image_bgr.shape[1]
    shown = axes.imshow(extended, extent=(0, end, height, 0), interpolation="nearest")
    pale = axes.axvspan(width, end, color="white", alpha=0.35, linewidth=0)
    seam = axes.axvline(width, color=VERMILION, linewidth=2.0)
    edges = [axes.axvline(edge, color=BLACK, linewidth=1.6, linestyle="--") for edge in valid_range(width)]
    axes.grid(False)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]")
    axes.set(xlim=(0, end), ylim=(height, 0), xticks=np.linspace(0, end, 6))
    return [shown, pale, seam, *edges]


def idea_figure(image_bgr: np.ndarray, boxes: np.ndarray, labels: Sequence[str], counted: np.ndarray) -> Figure:
    """The extended panorama with every box that the network saw on it; thin and dotted where it does not count."""
    figure, axes = new_figure(size=(8.6, 3.7))
    extended_axes(axes, image_bgr, "What the network sees on the extended image (dashed: the range that counts)")
    for box, label, counts in zip(boxes, labels, counted, strict=True):
        colour, _ = class_style(label)
        axes.plot(*outline(box).T, "-" if counts else ":", color=colour, linewidth=2.2 if counts else 1.6)
        axes.plot((box[0] + box[2]) / 2, (box[1] + box[3]) / 2, ".", color=colour, markersize=6)
    class_legend(figure, labels)
    alt = "A panorama with its left quarter appended at the right; boxes around furniture, some of them on both copies."
    return described(figure, alt)


def training_figure(taught: TrainingPicture, chosen: int) -> Figure:
    """The picture with its exact boxes; close up, one object, the cells that answer for it, and their three shapes."""
    label, (low, high) = taught.labels[chosen], taught.boxes[chosen].reshape(2, 2)
    size, centre, (shapes, cells) = high - low, (low + high) / 2, (values / INPUT_SCALE for values in anchors())
    shared = np.minimum(size, shapes).prod(axis=1)
    best = np.argmax(shared / (size.prod() + shapes.prod(axis=1) - shared))
    cell, (height, width) = cells[best], taught.image.shape[:2]
    figure, (whole, close) = new_figure(1, 2, size=(8.6, 3.4))
    whole.get_gridspec().set_width_ratios([2.2, 1])
    panorama(whole, brighter(taught.image), "A picture of the training, and what is asked for")
    for box, name in zip(taught.boxes, taught.labels, strict=True):
        draw_box(whole, box, width, name)
    close.imshow(brighter(taught.image)[..., ::-1], extent=(0, width, height, 0))
    close.grid(False)
    close.set(title=f"{label.capitalize()}: cells, shapes", xlabel="column u [pixels]", ylabel="row v [pixels]")
    close.set(xlim=(centre[0] - 80, centre[0] + 80), ylim=(centre[1] + 80, centre[1] - 80))
    for edge in np.arange(0, width, cell):
        close.axvline(edge, color="white", linewidth=0.4)
        close.axhline(edge, color="white", linewidth=0.4)
    column, row = np.floor(centre / cell)  # the cell of the centre; beside it and above or below it, the nearest ones
    beside, above = np.where(centre / cell % 1 < 0.5, -1, 1)
    for u, v in ((column, row), (column + beside, row), (column, row + above)):
        close.add_patch(Rectangle((u * cell, v * cell), cell, cell, color=YELLOW, alpha=0.55, linewidth=0))
    for k in np.flatnonzero(cells == cell):
        look = {"edgecolor": VERMILION, "linewidth": 2.0} if k == best else {"edgecolor": BLACK, "linewidth": 1.2}
        close.add_patch(Rectangle(centre - shapes[k] / 2, *shapes[k], fill=False, linestyle="--", **look))
    close.add_patch(Rectangle(low, *size, edgecolor=class_style(label)[0], linewidth=2.4, fill=False))
    class_legend(figure, taught.labels)
    return described(
        figure,
        "A photograph of a generated room with the exact boxes of its furniture; close up, a plant over a grid of "
        "cells, three of them marked, and three dashed rectangles of different shape about its centre.",
    )


def threshold_figure(scores: dict[float, ThresholdScore], chosen: float) -> Figure:
    """Precision and recall over the score threshold, with Wilson's 95 % intervals."""
    figure, axes = new_figure(size=(6.4, 3.2))
    for index, (name, of) in enumerate((("precision", "made"), ("recall", "wanted"))):
        counts = [(one.right, getattr(one, of)) for one in scores.values()]
        shares = np.array([right / total for right, total in counts])
        bars = np.abs(np.array([wilson_percent(*count) for count in counts]).T / 100 - shares)
        axes.errorbar(np.add(list(scores), 0.006 * index), shares, bars, label=name, capsize=3, **line_style(index))
    axes.axvline(chosen, color=BLACK, linewidth=1.2, linestyle="--", label="chosen in training")
    axes.set(title="A threshold is a bargain", xlabel="score threshold [-]", ylabel="share [-]", ylim=(0.4, 1.02))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = (
        "Precision rises from 0.88 to 1 and recall falls from 0.96 to 0.63 as the score threshold goes from 0.1 to 0.9;"
    )
    return described(figure, f"{alt} bars show the 95 % intervals.")


def part_of(box: Sequence[float], share: float) -> np.ndarray:
    """Return the box about the same centre with `share` of the width and of the height."""
    return np.add(np.multiply(box, 1 + share), np.multiply(np.take(box, [2, 3, 0, 1]), 1 - share)) / 2


def crop_of(image_bgr: np.ndarray, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray, float]:
    """Return a square around a box `(CROP, CROP, 3)` RGB, its corner (u, v) and its side, pixels of the panorama.

    Columns go around the seam, rows beyond the image are white.
    """
    low, high = np.reshape(box, (2, 2))
    side = 1.25 * max(high - low)
    corner = (low + high - side) / 2
    height, width = image_bgr.shape[:2]
    columns, rows = np.floor(corner[:, None] + (np.arange(CROP) + 0.5) * side / CROP).astype(int)
    crop = image_bgr[np.ix_(np.clip(rows, 0, height - 1), columns % width, [2, 1, 0])]
    crop[(rows < 0) | (rows >= height)] = 255
    return crop, corner, side


def crops_figure(image_bgr: np.ndarray, boxes: dict[str, Sequence[float]]) -> Figure:
    """Some boxes close up, each with the central half in which its colour is measured."""
    figure, axes = new_figure(1, len(boxes), size=(2.5 * len(boxes), 2.8))
    for a, (name, box) in zip(axes, boxes.items(), strict=True):
        crop, corner, side = crop_of(image_bgr, box)
        a.imshow(crop, extent=(0, side, side, 0))
        for frame, dashes in ((box, "-"), (part_of(box, 0.5), "--")):
            a.plot(*(outline(frame) - corner).T, color="white", linewidth=3.2)
            a.plot(*(outline(frame) - corner).T, dashes, color=BLACK, linewidth=1.6)
        a.grid(False)
        a.set(title=name, xlabel="columns [pixels]", ylabel="rows [pixels]")
    alt = "Three red sofas close up, each with its central half marked; a blue table covers much of the second one."
    return described(figure, alt)
