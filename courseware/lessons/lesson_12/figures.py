"""Figures of lesson 12: boxes on an extended panorama, a picture of the training, thresholds, boxes close up."""

from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import box_centre, box_iou
from course_lib.spherical_stereo.detection.seam import extend_seam, valid_range
from courseware.experiments.intervals import wilson_percent
from courseware.lessons.kit.display import described
from courseware.lessons.kit.live_figure import LiveFigure
from courseware.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from courseware.lessons.kit.room_data import the_image, the_pair
from courseware.lessons.lesson_12 import measures
from courseware.plots.figures import BLACK, BLUE, ORANGE, VERMILION, YELLOW, line_style, new_figure
from courseware.plots.panorama_drawing import CLASS_STYLES, class_style, draw_box, panorama

CROP = 220  # pixels of the square in which a box is shown
N_BINS = 36  # of hue, 10 degrees each
INPUT_SCALE = 0.8  # pixels of the network's input per pixel of a panorama 1280 wide


def brighter(image_bgr: np.ndarray) -> np.ndarray:
    """Return the picture as we draw it, with its dark parts lifted. The network gets it as it is."""
    return cv2.LUT(image_bgr, np.round(255 * (np.arange(256) / 255) ** 0.65).astype(np.uint8))


def class_legend(figure: Figure, labels: Iterable[str] = CLASS_STYLES) -> None:
    """Say which colour a box of a class has, below everything else."""
    shown = [label for label in CLASS_STYLES if label in labels]
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
    figure, axes = new_figure(size=(9.0, 4.2))
    extended_axes(axes, image_bgr, "What the network sees on the extended image (dashed: the range that counts)")
    for box, label, counts in zip(boxes, labels, counted, strict=True):
        colour, _ = class_style(label)
        axes.plot(*outline(box).T, "-" if counts else ":", color=colour, linewidth=2.2 if counts else 1.6)
        axes.plot((box[0] + box[2]) / 2, (box[1] + box[3]) / 2, ".", color=colour, markersize=6)
    class_legend(figure, labels)
    alt = "A panorama with its left quarter appended at the right; boxes around furniture, some of them on both copies."
    return described(figure, alt)


def training_figure(taught: measures.TrainingPicture, chosen: int) -> Figure:
    """The picture with its exact boxes; close up, one object, the cells that answer for it, and their three shapes."""
    label, (low, high) = taught.labels[chosen], taught.boxes[chosen].reshape(2, 2)
    size, centre, (shapes, cells) = (
        high - low,
        (low + high) / 2,
        (values / INPUT_SCALE for values in measures.anchors()),
    )
    shared = np.minimum(size, shapes).prod(axis=1)
    best = np.argmax(shared / (size.prod() + shapes.prod(axis=1) - shared))
    cell, (height, width) = cells[best], taught.image.shape[:2]
    figure, (whole, close) = new_figure(1, 2, size=(9.6, 4.2))
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
    alt = "A photograph of a generated room with the exact boxes of its furniture; close up, a plant over a grid of "
    alt += "cells, three of them marked, and three dashed rectangles of different shape about its centre."
    return described(figure, alt)


def threshold_figure(scores: dict[float, measures.ThresholdScore], chosen: float) -> Figure:
    """Precision and recall over the score threshold, with Wilson's 95 % intervals."""
    figure, axes = new_figure(size=(6.4, 3.2))
    for index, (name, of) in enumerate((("precision", "made"), ("recall", "wanted"))):
        counts = [(one.right, getattr(one, of)) for one in scores.values()]
        shares = np.array([right / total for right, total in counts])
        bars = np.abs(np.array([wilson_percent(*count) for count in counts]).T / 100 - shares)
        axes.errorbar(np.add(list(scores), 0.006 * index), shares, bars, label=name, capsize=3, **line_style(index))
    axes.axvline(chosen, color=BLACK, linewidth=1.2, linestyle="--", label="chosen in training")
    axes.set(title="Precision and recall", xlabel="score threshold [-]", ylabel="share [-]", ylim=(0.4, 1.02))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    alt = "Precision rises from 0.88 to 1 and recall falls from 0.96 to 0.63 as the score threshold goes from 0.1 to "
    return described(figure, alt + "0.9; bars show the 95 % intervals.")


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


SEAM_CONTROLS = [
    Slider("cut", "seam at [% of the sofa]", 0, 100, 50, 10),
    Switch("extension", "append the left quarter (extension)", True),
    Slider("threshold", "score threshold [-]", 0.1, 0.9, 0.5, 0.05),
]


def seam_panel() -> Panel:
    """Slide the seam through the sofa, with and without the extension; a score threshold. The network runs first."""
    cuts = {percent: measures.cut_sofa(percent) for percent in range(0, 101, 10)}
    width = cuts[0].image.shape[1]
    turn = np.array([width, 0.0, width, 0.0])
    figure, axes = new_figure(size=(9.2, 4.1))
    title = "Dotted: the sofa's exact box. Thick: objects in the end. Thin: seen, but not counted"
    shown, pale, seam, *edges = extended_axes(axes, cuts[0].image, title)
    halved = {k: cv2.resize(extend_seam(brighter(cut.image)), None, fx=0.5, fy=0.5) for k, cut in cuts.items()}
    exact, dropped, kept = (
        axes.add_collection(LineCollection([], colors=BLACK, linewidths=wide, linestyles=dashes))
        for wide, dashes in ((1.4, ":"), (1.2, (0, (3, 2))), (2.4, "-"))
    )
    ground = {"facecolor": BLACK, "pad": 1.0}
    names = [axes.text(0, 0, "", fontsize=8, color="white", va="bottom", bbox=ground) for _ in range(4)]
    class_legend(figure)
    live = LiveFigure(figure, [shown, pale, seam, *edges, exact, dropped, kept, *names])

    def draw(cut: float, extension: bool, threshold: float) -> Drawing:
        now = cuts[round(cut)]
        objects = now.objects(extension, threshold)
        seen = (now.extended if extension else now.plain).above(threshold)
        drawn = where_they_count(objects.boxes, width) if extension else objects.boxes
        shown.set_data(halved[round(cut)][..., ::-1])
        pale.set(color="white" if extension else "0.9", alpha=0.35 if extension else 1)
        for edge in edges:
            edge.set_visible(extension)
        exact.set_segments([outline(box) for box in (now.sofa, now.sofa - turn)])
        # What is drawn as an object is not drawn again. On so long a circle nothing wraps.
        new = box_iou(seen.boxes + turn, drawn + turn, 10.0 * width).max(axis=1, initial=0) <= 0.95
        for lines, boxes, labels in ((kept, drawn, objects.labels), (dropped, seen.boxes[new], seen.labels[new])):
            lines.set_segments([outline(box) for box in boxes])
            lines.set_color([class_style(label)[0] for label in labels] or BLACK)
        pieces, overlap = measures.pieces_of_sofa(now, extension, threshold)
        for name, piece in zip(names, [*pieces, *[None] * len(names)], strict=False):
            name.set_text(f"sofa {piece.score:.1f}" if piece else "")
            if piece:
                u_min, v_min, _, _ = where_they_count(piece.box, width) if extension else piece.box
                name.set_position((max(u_min, 0), v_min - 6))
        way = f"{'with' if extension else 'without'} the extension, threshold {threshold:.2f}"
        place = f"seam at {cut:.0f} % of the sofa, {way}"
        of_sofa = f"boxes on this sofa: {len(pieces)}; best overlap with its exact box (IoU) {overlap:.2f}"
        of_all = f"in the image: {len(seen.boxes)} boxes, {len(objects.boxes)} objects in the end"
        alt = f"A panorama with the boxes of detected objects. {place}"
        return Drawing(live.png(), alt, f"{place}\n{of_sofa}; {of_all}")

    return Panel("12 slide the seam", SEAM_CONTROLS, draw, photograph=True)


def where_they_count(boxes: np.ndarray, width: int) -> np.ndarray:
    """Return the boxes `(..., 4)`, each shifted by whole turns so that its centre lies in the range that counts."""
    turns = np.floor((box_centre(boxes)[..., :1] - valid_range(width)[0]) / width)
    return boxes - width * turns * [1, 0, 1, 0]


def hue_panel() -> Panel:
    """An object, and how much of its exact box is used: its hues as a histogram, their mean on the circle and plain."""
    image = the_image()
    large = sorted(filter(measures.is_large, the_pair().upper_objects), key=lambda thing: thing.number)
    hidden = ["" if thing.visible_fraction > 0.9 else ", partly hidden" for thing in large]
    things = {f"{thing.number + 1}: {thing.label}{note}": thing for thing, note in zip(large, hidden, strict=True)}
    figure, (close, histogram) = new_figure(1, 2, size=(9.4, 3.4))
    close.get_gridspec().set_width_ratios([1, 1.9])
    picture = close.imshow(np.zeros((CROP, CROP, 3), np.uint8), extent=(0, 1, 1, 0))
    close.grid(False)
    close.set(title="The box, and the part used (dashed)", xlabel="across [share]", ylabel="down [share]")
    (whole,) = close.plot([], [], color=BLACK, linewidth=2.0)
    (part,) = close.plot([], [], "--", color="white", linewidth=2.2)
    middles = (np.arange(N_BINS) + 0.5) * 360 / N_BINS
    bars = histogram.bar(middles, 0 * middles, 360 / N_BINS, color=colormaps["hsv"](middles / 360))
    (circular,) = histogram.plot([], [], color=BLUE, linewidth=2.4, label="mean on the circle")
    (plain,) = histogram.plot([], [], "--", color=ORANGE, linewidth=2.4, label="plain mean of H")
    histogram.set(title="Hues in that part", xlabel="hue H [degrees]", ylabel="share of the colour [-]")
    histogram.set(xlim=(0, 360), ylim=(0, 1.0), xticks=np.arange(0, 361, 60))
    histogram.legend(loc="upper center", ncols=2, frameon=False)
    live = LiveFigure(figure, [picture, whole, part, *bars, circular, plain])

    def draw(thing: str, share: float) -> Drawing:
        used = part_of(box := things[thing].visible_box, share)
        crop, corner, side = crop_of(image, box)
        picture.set_data(crop)
        for line, frame in ((whole, box), (part, used)):
            line.set_data(*((outline(frame) - corner) / side).T)
        hues, saturations = measures.hues_and_saturations(image, used)
        weights, _ = np.histogram(hues, N_BINS, (0, 360), weights=saturations)
        for bar, weight in zip(bars, weights / max(weights.sum(), 1e-9), strict=True):
            bar.set_height(weight)
        # The library measures in the central half of what it is given.
        hue, saturation = mean_hue_saturation(image, tuple(part_of(used, 2.0)))
        circular.set_data([hue, hue], [0, 0.88])
        plain.set_data([hues.mean()] * 2, [0, 0.88])
        named = "grey, no hue" if np.isnan(hue) else f"H {hue:.0f} degrees on the circle"
        line = f"{thing}, {share:.0%} of the box each way: {named} (plain mean {hues.mean():.0f}), "
        line += f"S {saturation:.0f} %, {len(hues)} pixels"
        return Drawing(live.png(), f"A box with a part marked, and the hues in it. {line}", line)

    choice = Choice("thing", "object", tuple(things), next(iter(things)))
    controls = [choice, Slider("share", "part of the box [share]", 0.1, 1.0, 0.5, 0.1)]
    return Panel("12 hue and saturation", controls, draw, photograph=True)


PANELS = {"12 slide the seam": seam_panel, "12 hue and saturation": hue_panel}
