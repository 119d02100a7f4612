"""Lesson 12's panels: slide the seam through the sofa; hue and saturation of a part of a box."""

from collections.abc import Sequence

import cv2
import numpy as np
from matplotlib import colormaps
from matplotlib.collections import LineCollection
from matplotlib.patches import Rectangle

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.room_photographs import the_image, the_pair
from course_lib.lessons.lesson_12.figures import (
    CROP,
    brighter,
    class_legend,
    crop_of,
    extended_axes,
    hues_and_saturations,
    outline,
    part_of,
)
from course_lib.lessons.lesson_12.seam_cuts import CUTS, best_overlap, cut_sofa, pieces_of_sofa
from course_lib.plots import figures
from course_lib.plots.figures import BLACK, BLUE, ORANGE
from course_lib.plots.panorama_drawing import class_style
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import box_iou
from course_lib.spherical_stereo.detection.seam import appended_columns, extend_seam, valid_range
from course_lib.spherical_stereo.recording import TrueObject

_N_BINS = 36  # of hue, 10 degrees each


def seam_panel(percents: Sequence[int] = CUTS) -> Panel:
    """Slide the seam through the sofa, with and without the extension; a score threshold.

    percents: where the seam may cut the sofa, in percent of its width; the network runs twice for each.
    """
    cuts = {percent: cut_sofa(percent) for percent in percents}
    first = next(iter(cuts.values()))
    height, width = first.image.shape[:2]
    end = width + appended_columns(width)
    figure, axes = figures.new_figure(size=(9.2, 4.1))
    title = "Dotted: the sofa's exact box. Thick: objects in the end. Thin: seen, but not counted"
    shown, pale, seam, *edges = extended_axes(axes, first.image, title)
    small = {
        p: cv2.resize(extend_seam(brighter(cut.image)), None, fx=0.5, fy=0.5)[..., ::-1] for p, cut in cuts.items()
    }
    hidden = axes.add_patch(Rectangle((width, 0), end - width, height, color="0.9", linewidth=0))
    exact = axes.add_collection(LineCollection([], colors=BLACK, linewidths=1.4, linestyles=":"))
    dropped = axes.add_collection(LineCollection([], linewidths=1.2, linestyles=(0, (3, 2))))
    kept = axes.add_collection(LineCollection([], linewidths=2.4))
    names = [
        axes.text(0, 0, "", fontsize=8, color="white", va="bottom", bbox={"facecolor": BLACK, "pad": 1.0})
        for _ in range(4)
    ]
    class_legend(figure)
    live = LiveFigure(figure, [shown, pale, hidden, seam, *edges, exact, dropped, kept, *names])

    def draw(cut: float, extension: bool, threshold: float) -> Drawing:
        now = cuts[round(cut)]
        objects = now.objects(extension, threshold)
        seen = (now.extended if extension else now.plain).above(threshold)
        shown.set_data(small[round(cut)])
        hidden.set_visible(not extension)
        for edge in edges:
            edge.set_visible(extension)
        exact.set_segments([outline(now.sofa), outline(now.sofa - [width, 0, width, 0])])
        drawn = where_they_count(objects.boxes, width) if extension else objects.boxes
        kept.set_segments([outline(box) for box in drawn])
        kept.set_color([class_style(label)[0] for label in objects.labels] or BLACK)
        away = [i for i, box in enumerate(seen.boxes) if not _is_drawn(box, drawn, width)]
        dropped.set_segments([outline(seen.boxes[i]) for i in away])
        dropped.set_color([class_style(seen.labels[i])[0] for i in away] or BLACK)
        pieces = pieces_of_sofa(objects, now.sofa, width)
        spots = [(drawn[index], index) for index in pieces][: len(names)]
        for text, spot in zip(names, [*spots, *[None] * len(names)], strict=False):
            text.set_text("" if spot is None else f"sofa {objects.scores[spot[1]]:.1f}")
            if spot is not None:
                text.set_position((max(spot[0][0], 0), spot[0][1] - 6))
        overlap = best_overlap(objects, now.sofa, width)
        lines = [
            f"seam at {cut:.0f} % of the sofa, {'with' if extension else 'without'} the extension, threshold "
            f"{threshold:.2f}",
            f"boxes on this sofa: {len(pieces)}; best overlap with its exact box (IoU) {overlap:.2f}; "
            f"in the image: {len(seen.boxes)} boxes, {len(objects.boxes)} objects in the end",
        ]
        return Drawing(live.png(), f"A panorama with the boxes of detected objects. {lines[0]}", "\n".join(lines))

    controls = [
        Slider("cut", "seam at [% of the sofa]", 0, 100, 50, 10),
        Switch("extension", "append the left quarter (extension)", True),
        Slider("threshold", "score threshold [-]", 0.1, 0.9, 0.5, 0.05),
    ]
    return Panel("12 slide the seam", controls, draw, photograph=True)


def where_they_count(boxes: np.ndarray, width: int) -> np.ndarray:
    """The boxes (n, 4), each shifted by whole turns so that its centre lies in the range that counts."""
    turns = np.floor(((boxes[:, 0] + boxes[:, 2]) / 2 - valid_range(width)[0]) / width)
    return boxes - width * turns[:, None] * [1, 0, 1, 0]


def _is_drawn(box: np.ndarray, others: np.ndarray, width: int) -> bool:
    """Whether nearly the same box is drawn at this very place already."""
    if not len(others):
        return False
    right = np.array([width, 0.0, width, 0.0])
    far = 10.0 * width  # a circle so long that nothing wraps
    return float(box_iou((box + right)[None], others + right, far).max()) > 0.95


def hue_panel(image_bgr: np.ndarray, things: Sequence[TrueObject]) -> Panel:
    """An object, and how much of its exact box is used: its hues as a histogram, their mean on the circle and plain."""
    shown_things = {
        f"{thing.number}: {thing.label}{'' if thing.visible_fraction > 0.9 else ', partly hidden'}": thing
        for thing in sorted(things, key=lambda thing: thing.number)
        if thing.visible_box[3] - thing.visible_box[1] >= 30
    }
    figure, (close, histogram) = figures.new_figure(1, 2, size=(9.4, 3.4))
    close.get_gridspec().set_width_ratios([1, 1.9])
    picture = close.imshow(np.zeros((CROP, CROP, 3), np.uint8), extent=(0, 1, 1, 0))
    close.grid(False)
    close.set(title="The box, and the part used (dashed)", xlabel="across [share]", ylabel="down [share]")
    whole = close.plot([], [], color=BLACK, linewidth=2.0)[0]
    part = close.plot([], [], color="white", linewidth=2.2, linestyle="--")[0]
    middles = (np.arange(_N_BINS) + 0.5) * 360 / _N_BINS
    bars = histogram.bar(middles, np.zeros(_N_BINS), 360 / _N_BINS, color=colormaps["hsv"](middles / 360))
    circular = histogram.plot([], [], color=BLUE, linewidth=2.4, label="mean on the circle")[0]
    plain = histogram.plot([], [], color=ORANGE, linewidth=2.4, linestyle="--", label="plain mean of H")[0]
    histogram.set(title="Hues in that part", xlabel="hue H [degrees]", ylabel="share of the colour [-]")
    histogram.set(xlim=(0, 360), ylim=(0, 1.0), xticks=np.arange(0, 361, 60))
    histogram.legend(loc="upper center", ncols=2, frameon=False)
    live = LiveFigure(figure, [picture, whole, part, *bars, circular, plain])

    def draw(thing: str, share: float) -> Drawing:
        box = shown_things[thing].visible_box
        used = part_of(box, share)
        crop, scale, corner = crop_of(image_bgr, box)
        picture.set_data(crop)
        for line, frame in ((whole, box), (part, used)):
            line.set_data(*((outline(frame) - corner) * scale / CROP).T)
        hues, saturations = hues_and_saturations(image_bgr, used)
        weights, _ = np.histogram(hues, _N_BINS, (0, 360), weights=saturations)
        for bar, weight in zip(bars, weights / max(weights.sum(), 1e-9), strict=True):
            bar.set_height(weight)
        # The library measures in the central half of what it is given.
        hue, saturation = mean_hue_saturation(image_bgr, part_of(used, 2.0))
        circular.set_data([hue, hue], [0, 0.88])
        plain.set_data([hues.mean()] * 2, [0, 0.88])
        named = "grey, no hue" if np.isnan(hue) else f"H {hue:.0f} degrees on the circle"
        line = (
            f"{thing}, {share:.0%} of the box each way: {named} (plain mean {hues.mean():.0f}), "
            f"S {saturation:.0f} %, {len(hues)} pixels"
        )
        return Drawing(live.png(), f"A box with a part marked, and the hues in it. {line}", line)

    first = next(iter(shown_things))
    controls = [
        Choice("thing", "object", tuple(shown_things), first),
        Slider("share", "part of the box [share]", 0.1, 1.0, 0.5, 0.1),
    ]
    return Panel("12 hue and saturation", controls, draw, photograph=True)


PANELS = {
    "12 slide the seam": seam_panel,
    "12 hue and saturation": lambda: hue_panel(the_image(), the_pair().upper_objects),
}
