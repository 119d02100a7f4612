"""Figures of lesson 12: boxes on an extended panorama, thresholds, crops and their hues."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from course_lib.experiments.intervals import wilson_percent
from course_lib.lessons.lesson_12.scores import ThresholdScore
from course_lib.plots import figures
from course_lib.plots.figures import BLACK, VERMILION
from course_lib.plots.panorama_drawing import CLASS_STYLES, class_style
from course_lib.spherical_stereo.detection.seam import appended_columns, extend_seam, valid_range

CROP = 160  # pixels of the square in which a box is shown
GAMMA = 0.65  # of pictures as they are drawn: the rooms are dim


def brighter(image_bgr: np.ndarray) -> np.ndarray:
    """The picture as it is drawn, its dark parts lifted; the network gets it as it is."""
    return cv2.LUT(image_bgr, np.round(255 * (np.arange(256) / 255) ** GAMMA).astype(np.uint8))


def class_legend(figure: Figure, labels: Iterable[str] = CLASS_STYLES) -> None:
    """Which colour a box of a class has, below everything else."""
    shown = [label for label in CLASS_STYLES if label in set(labels)]
    handles = [Line2D([], [], color=class_style(label)[0], linewidth=2.4) for label in shown]
    figure.legend(handles, shown, loc="outside lower center", ncols=len(shown), frameon=False, fontsize=8)


def outline(box: Sequence[float]) -> np.ndarray:
    """The five corners `(5, 2)` of a box, back to the first."""
    u_min, v_min, u_max, v_max = box
    return np.array([[u_min, v_min], [u_max, v_min], [u_max, v_max], [u_min, v_max], [u_min, v_min]])


def extended_axes(axes: Axes, image_bgr: np.ndarray, title: str) -> list[Artist]:
    """The panorama with its left quarter appended (pale), the seam, and the range that counts (dashed).

    Returns what it drew, from the ground up: the image, the pale part, the seam, the two ends of the range.
    """
    height, width = image_bgr.shape[:2]
    end = width + appended_columns(width)
    shown = axes.imshow(
        extend_seam(brighter(image_bgr))[..., ::-1], extent=(0, end, height, 0), interpolation="nearest"
    )
    pale = axes.add_patch(Rectangle((width, 0), end - width, height, color="white", alpha=0.35, linewidth=0))
    seam = axes.axvline(width, color=VERMILION, linewidth=2.0)
    edges = [axes.axvline(edge, color=BLACK, linewidth=1.6, linestyle="--") for edge in valid_range(width)]
    axes.grid(False)
    axes.set(title=title, xlabel="column u [pixels]", ylabel="row v [pixels]", xlim=(0, end), ylim=(height, 0))
    axes.set_xticks(np.linspace(0, end, 6))
    return [shown, pale, seam, *edges]


def idea_figure(image_bgr: np.ndarray, boxes: np.ndarray, labels: Sequence[str], counted: np.ndarray) -> Figure:
    """The extended panorama with every box that the network saw on it; thin and dotted where it does not count."""
    figure, axes = figures.new_figure(size=(8.6, 3.7))
    extended_axes(axes, image_bgr, "What the network sees on the extended image (dashed: the range that counts)")
    for box, label, counts in zip(boxes, labels, counted, strict=True):
        colour, _ = class_style(label)
        style = {"linewidth": 2.2, "linestyle": "-"} if counts else {"linewidth": 1.6, "linestyle": ":"}
        axes.plot(*outline(box).T, color=colour, **style)
        axes.plot((box[0] + box[2]) / 2, (box[1] + box[3]) / 2, ".", color=colour, markersize=6)
    class_legend(figure, labels)
    return figure


def threshold_figure(scores: dict[float, ThresholdScore], chosen: float) -> Figure:
    """Precision and recall over the score threshold, with Wilson's 95 % intervals."""
    figure, axes = figures.new_figure(size=(6.4, 3.2))
    for index, (name, total) in enumerate((("precision", "made"), ("recall", "wanted"))):
        shares = np.array([getattr(one, name) for one in scores.values()])
        ends = [wilson_percent(one.right, getattr(one, total)) for one in scores.values()]
        bars = np.abs(np.array(ends).T / 100 - shares)
        axes.errorbar(
            np.add(list(scores), 0.006 * index), shares, bars, **figures.line_style(index), label=name, capsize=3
        )
    axes.axvline(chosen, color=BLACK, linewidth=1.2, linestyle="--", label="chosen in training")
    axes.set(title="A threshold is a bargain", xlabel="score threshold [-]", ylabel="share [-]", ylim=(0.4, 1.02))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def crop_of(image_bgr: np.ndarray, box: Sequence[float], size: int = CROP) -> tuple[np.ndarray, float, np.ndarray]:
    """A square around a box `(size, size, 3)` RGB, its pixels per panorama pixel, and its corner (u, v).

    Columns go around the seam, rows beyond the image are white.
    """
    u_min, v_min, u_max, v_max = box
    side = 1.25 * max(u_max - u_min, v_max - v_min)
    corner = np.array([(u_min + u_max - side) / 2, (v_min + v_max - side) / 2])
    height, width = image_bgr.shape[:2]
    steps = (np.arange(size) + 0.5) * side / size
    columns = np.floor(corner[0] + steps).astype(int) % width
    rows = np.floor(corner[1] + steps).astype(int)
    crop = image_bgr[np.ix_(np.clip(rows, 0, height - 1), columns)].copy()
    crop[(rows < 0) | (rows >= height)] = 255
    return np.ascontiguousarray(crop[..., ::-1]), size / side, corner


def part_of(box: Sequence[float], share: float) -> tuple[float, float, float, float]:
    """The box about the same centre with `share` of the width and of the height."""
    u_min, v_min, u_max, v_max = box
    half_width, half_height = share * (u_max - u_min) / 2, share * (v_max - v_min) / 2
    u, v = (u_min + u_max) / 2, (v_min + v_max) / 2
    return u - half_width, v - half_height, u + half_width, v + half_height


def crops_figure(image_bgr: np.ndarray, boxes: dict[str, Sequence[float]]) -> Figure:
    """Some boxes close up, each with the central half in which its colour is measured."""
    figure, axes = figures.new_figure(1, len(boxes), size=(2.5 * len(boxes), 2.8))
    for a, (name, box) in zip(np.atleast_1d(axes), boxes.items(), strict=True):
        crop, scale, corner = crop_of(image_bgr, box, 220)
        a.imshow(crop, extent=(0, 220 / scale, 220 / scale, 0))
        for frame, style in ((box, "-"), (part_of(box, 0.5), "--")):
            a.plot(*(outline(frame) - corner).T, color="white", linewidth=3.2)
            a.plot(*(outline(frame) - corner).T, color=BLACK, linewidth=1.6, linestyle=style)
        a.grid(False)
        a.set(title=name, xlabel="columns [pixels]", ylabel="rows [pixels]")
    return figure


def hues_and_saturations(image_bgr: np.ndarray, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Hue [degrees] and saturation [0 to 1] `(n,)` of every pixel whose centre lies in a box, also across the seam."""
    height, width = image_bgr.shape[:2]
    u_min, v_min, u_max, v_max = box
    columns = np.arange(np.ceil(u_min - 0.5), max(np.ceil(u_max - 0.5), np.ceil(u_min - 0.5) + 1)).astype(int) % width
    rows = np.arange(np.ceil(v_min - 0.5), max(np.ceil(v_max - 0.5), np.ceil(v_min - 0.5) + 1)).astype(int)
    pixels = image_bgr[np.ix_(rows[(rows >= 0) & (rows < height)], columns)]
    hsv = cv2.cvtColor(pixels.astype(np.float32) / 255, cv2.COLOR_BGR2HSV).reshape(-1, 3).astype(np.float64)
    return hsv[:, 0], hsv[:, 1]
