"""A sofa that the seam cuts in many places, and what the network makes of it with and without the extension."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import cv2
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from course_lib.lessons.kit.display import described
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.room_photographs import the_image, the_pair
from course_lib.paths import data_path
from course_lib.plots import figures
from course_lib.plots.figures import BLACK, VERMILION
from course_lib.plots.panorama_drawing import CLASS_STYLES, class_style
from course_lib.spherical_stereo.detection.detected_object import box_area, box_iou, shared_area, wrapped_box
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.seam import appended_columns, extend_seam, select_on_circle, valid_range
from course_lib.spherical_stereo.recording import TrueObject

LOWEST = 0.1  # score: what the sliders can go down to; the network runs once, the rest is sorting
SOFA = 2  # number in the map of the sofa across the seam
CUTS = range(0, 101, 10)  # percent of the sofa's width at which the seam cuts it
WHOLE_IOU = 0.7  # overlap with the exact box from which a sofa counts as found whole (chosen)
GAMMA = 0.65  # of pictures as they are drawn: the rooms are dim


@functools.cache
def detector(score_threshold: float | None = None) -> YoloDetector:
    """Return the course's detector, by default with the threshold that its training chose."""
    options = {} if score_threshold is None else {"score_threshold": score_threshold}
    return YoloDetector.load(data_path("detector"), **options)


def true_object(number: int) -> TrueObject:
    """Return an object of this lesson's panorama by its number in the map, with its exact box."""
    return next(thing for thing in the_pair().upper_objects if thing.number == number)


class Found(NamedTuple):
    """Boxes `(n, 4)` in edge coordinates, scores `(n,)`, classes `(n,)` (indices into `detector().labels`)."""

    boxes: np.ndarray
    scores: np.ndarray
    classes: np.ndarray

    def above(self, threshold: float) -> Found:
        kept = self.scores >= threshold
        return Found(self.boxes[kept], self.scores[kept], self.classes[kept])

    @property
    def labels(self) -> list[str]:
        return [detector().labels[index] for index in self.classes]


class Cut(NamedTuple):
    """The panorama rolled so that the seam cuts the sofa, and what the network sees, without and with the extension."""

    image: np.ndarray
    sofa: np.ndarray  # `(4,)` its exact box there
    plain: Found
    extended: Found

    def objects(self, extension: bool, threshold: float) -> Found:
        """Return what comes out in the end: one box for each object, 0 <= u_min < W."""
        if not extension:
            return self.plain.above(threshold)
        extended = self.extended.above(threshold)
        return Found(*select_on_circle(*extended, self.image.shape[1], detector().iou_threshold))


@functools.cache
def cut_sofa(percent: int) -> Cut:
    """Cut at so many percent of the sofa's width; the network runs twice."""
    box, width = np.array(true_object(SOFA).visible_box), the_image().shape[1]
    shift = round(width - box[0] - percent / 100 * (box[2] - box[0]))
    rolled = np.roll(the_image(), shift, axis=1)
    found = [Found(*detector(LOWEST).detect_in_plane(seen)) for seen in (rolled, extend_seam(rolled))]
    return Cut(rolled, wrapped_box(box + [shift, 0, shift, 0], width), *found)


def cut_sofas() -> dict[int, Cut]:
    return {percent: cut_sofa(percent) for percent in progress(CUTS, "the network runs twice for every cut")}


class OnSofa(NamedTuple):
    """What the network says of a place on the sofa, whatever it takes it for; overlap: IoU with the exact box."""

    label: str
    score: float
    box: np.ndarray
    overlap: float


def said_of_the_sofa(cut: Cut, extension: bool, threshold: float) -> list[OnSofa]:
    """Return every box of which at least half lies inside the sofa's exact box, the surest first."""
    found, width = cut.objects(extension, threshold), cut.image.shape[1]
    boxes = wrapped_box(found.boxes, width)
    inside = shared_area(boxes, cut.sofa, width)[:, 0] / box_area(boxes)
    said = map(OnSofa, found.labels, found.scores, boxes, box_iou(boxes, cut.sofa, width)[:, 0])
    on_it = [one for one, share in zip(said, inside, strict=True) if share >= 0.5]
    return sorted(on_it, key=lambda one: -one.score)


def pieces_of_sofa(cut: Cut, extension: bool, threshold: float) -> tuple[list[OnSofa], float]:
    """Return the boxes on the sofa that are called one, and their best overlap with it."""
    pieces = [one for one in said_of_the_sofa(cut, extension, threshold) if one.label == "sofa"]
    return pieces, max((piece.overlap for piece in pieces), default=0.0)


def cut_table(cuts: dict[int, Cut], threshold: float) -> str:
    """Return a row for each place of the seam: boxes on the sofa and the best overlap, without and with the extension."""
    lines = ["seam at [% of the sofa]   without: boxes, best IoU   with: boxes, best IoU"]
    for percent, cut in cuts.items():
        found = [pieces_of_sofa(cut, extension, threshold) for extension in (False, True)]
        columns = [f"{len(pieces):>10}{overlap:>11.2f}" for pieces, overlap in found]
        lines.append(f"{percent:>12}{'':13}{columns[0]}{'':6}{columns[1]}")
    return "\n".join(lines)


def cut_counts(cuts: dict[int, Cut], threshold: float, extension: bool) -> dict[str, int]:
    """Return in how many places of the seam the sofa is found once and whole, more than once, or not whole at all."""
    found = [pieces_of_sofa(cut, extension, threshold) for cut in cuts.values()]
    twice = sum(len(pieces) > 1 for pieces, _ in found)
    whole = sum(len(pieces) == 1 and overlap >= WHOLE_IOU for pieces, overlap in found)
    return {"once and whole": whole, "more than once": twice, "only a part, or not at all": len(found) - twice - whole}


def brighter(image_bgr: np.ndarray) -> np.ndarray:
    """Return the picture as it is drawn, its dark parts lifted; the network gets it as it is."""
    return cv2.LUT(image_bgr, np.round(255 * (np.arange(256) / 255) ** GAMMA).astype(np.uint8))


def class_legend(figure: Figure, labels: Iterable[str] = CLASS_STYLES) -> None:
    """Say which colour a box of a class has, below everything else."""
    shown = [label for label in CLASS_STYLES if label in set(labels)]
    handles = [Line2D([], [], color=class_style(label)[0], linewidth=2.4) for label in shown]
    figure.legend(handles, shown, loc="outside lower center", ncols=len(shown), frameon=False, fontsize=8)


def outline(box: Sequence[float]) -> np.ndarray:
    """Return the five corners `(5, 2)` of a box, back to the first."""
    return np.take(box, [[0, 1], [2, 1], [2, 3], [0, 3], [0, 1]])


def extended_axes(axes: Axes, image_bgr: np.ndarray, title: str) -> list[Artist]:
    """Draw the panorama with its left quarter appended (pale), the seam, and the range that counts (dashed).

    Returns the image, the pale part, the seam, the two ends of the range.
    """
    height, width = image_bgr.shape[:2]
    end = width + appended_columns(width)
    seen = extend_seam(brighter(image_bgr))[..., ::-1]
    shown = axes.imshow(seen, extent=(0, end, height, 0), interpolation="nearest")
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
        axes.plot(*outline(box).T, "-" if counts else ":", color=colour, linewidth=2.2 if counts else 1.6)
        axes.plot((box[0] + box[2]) / 2, (box[1] + box[3]) / 2, ".", color=colour, markersize=6)
    class_legend(figure, labels)
    alt = "A panorama with its left quarter appended at the right; boxes around furniture, some of them on both copies."
    return described(figure, alt)
