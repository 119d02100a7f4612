"""Lesson 12's panels: slide the seam through the sofa; hue and saturation of a part of a box."""

from itertools import zip_longest

import cv2
import numpy as np
from matplotlib import colormaps
from matplotlib.collections import LineCollection

from course_lib.lessons.kit.live_figure import LiveFigure
from course_lib.lessons.kit.panel import Choice, Drawing, Panel, Slider, Switch
from course_lib.lessons.kit.room_photographs import the_image, the_pair
from course_lib.lessons.lesson_12.figures import CROP, brighter, class_legend, crop_of, extended_axes, outline, part_of
from course_lib.lessons.lesson_12.measures import cut_sofa, hues_and_saturations, is_large, pieces_of_sofa
from course_lib.plots.figures import BLACK, BLUE, ORANGE, new_figure
from course_lib.plots.panorama_drawing import class_style
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.detected_object import box_centre, box_iou
from course_lib.spherical_stereo.detection.seam import extend_seam, valid_range

N_BINS = 36  # of hue, 10 degrees each
SEAM_CONTROLS = [
    Slider("cut", "seam at [% of the sofa]", 0, 100, 50, 10),
    Switch("extension", "append the left quarter (extension)", True),
    Slider("threshold", "score threshold [-]", 0.1, 0.9, 0.5, 0.05),
]


def seam_panel() -> Panel:
    """Slide the seam through the sofa, with and without the extension; a score threshold. The network runs first."""
    cuts = {percent: cut_sofa(percent) for percent in range(0, 101, 10)}
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
        pieces, overlap = pieces_of_sofa(now, extension, threshold)
        for name, piece in zip_longest(names, pieces):
            name.set_text(f"sofa {piece.score:.1f}" if piece else "")
            u_min, v_min, _, _ = (
                (where_they_count(piece.box, width) if extension else piece.box) if piece else np.zeros(4)
            )
            name.set_position((max(u_min, 0), v_min - 6))
        way = f"{'with' if extension else 'without'} the extension, threshold {threshold:.2f}"
        place = f"seam at {cut:.0f} % of the sofa, {way}"
        numbers = (
            f"boxes on this sofa: {len(pieces)}; best overlap with its exact box (IoU) {overlap:.2f}; "
            f"in the image: {len(seen.boxes)} boxes, {len(objects.boxes)} objects in the end"
        )
        return Drawing(live.png(), f"A panorama with the boxes of detected objects. {place}", f"{place}\n{numbers}")

    return Panel("12 slide the seam", SEAM_CONTROLS, draw, photograph=True)


def where_they_count(boxes: np.ndarray, width: int) -> np.ndarray:
    """Return the boxes `(..., 4)`, each shifted by whole turns so that its centre lies in the range that counts."""
    turns = np.floor((box_centre(boxes)[..., :1] - valid_range(width)[0]) / width)
    return boxes - width * turns * [1, 0, 1, 0]


def hue_panel() -> Panel:
    """An object, and how much of its exact box is used: its hues as a histogram, their mean on the circle and plain."""
    image = the_image()
    things = {
        f"{thing.number}: {thing.label}{'' if thing.visible_fraction > 0.9 else ', partly hidden'}": thing
        for thing in sorted(the_pair().upper_objects, key=lambda thing: thing.number)
        if is_large(thing)
    }
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
        hues, saturations = hues_and_saturations(image, used)
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
