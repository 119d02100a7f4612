"""A sofa that the seam cuts in many places, and what the network makes of it with and without the extension."""

from __future__ import annotations

import functools
import json
from typing import NamedTuple

import numpy as np

from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.room_photographs import the_image, the_pair
from course_lib.paths import data_path
from course_lib.spherical_stereo.detection.detected_object import box_area, shared_area, wrapped_box
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.seam import extend_seam, select_on_circle
from course_lib.spherical_stereo.recording import TrueObject

LOWEST = 0.1  # score: what the sliders can go down to; the network runs once, the rest is sorting
SOFA = 2  # number in the map of the sofa across the seam
CUTS = tuple(range(0, 101, 10))  # percent of the sofa's width at which the seam cuts it
WHOLE_IOU = 0.7  # overlap with the exact box from which a sofa counts as found whole (chosen)


@functools.cache
def detector() -> YoloDetector:
    """The course's detector with the threshold of its training."""
    return YoloDetector.load(data_path("detector"))


@functools.cache
def keen_detector() -> YoloDetector:
    """The same with a very low threshold, so that sliders can choose theirs afterwards."""
    return YoloDetector.load(data_path("detector"), score_threshold=LOWEST)


def chosen_threshold() -> float:
    """The score threshold that the training chose on its validation rooms."""
    return float(json.loads(data_path("detector/training.json").read_text(encoding="utf-8"))["score_threshold"])


def true_object(number: int) -> TrueObject:
    """An object of this lesson's panorama by its number in the map, with its exact box."""
    return next(thing for thing in the_pair().upper_objects if thing.number == number)


class Found(NamedTuple):
    """Boxes `(n, 4)` in edge coordinates, scores `(n,)`, classes `(n,)` (indices into `detector().labels`)."""

    boxes: np.ndarray
    scores: np.ndarray
    classes: np.ndarray

    def above(self, threshold: float) -> Found:
        """Those of at least this score."""
        kept = self.scores >= threshold
        return Found(self.boxes[kept], self.scores[kept], self.classes[kept])

    @property
    def labels(self) -> list[str]:
        """Class names."""
        return [detector().labels[index] for index in self.classes]


class Cut(NamedTuple):
    """The panorama rolled so that the seam cuts the sofa, and what the network sees, without and with the extension."""

    image: np.ndarray
    sofa: np.ndarray
    """`(4,)` its exact box there."""
    plain: Found
    extended: Found

    def objects(self, extension: bool, threshold: float) -> Found:
        """What comes out in the end: one box for each object, 0 <= u_min < W."""
        if not extension:
            return self.plain.above(threshold)
        width = self.image.shape[1]
        return Found(*select_on_circle(*self.extended.above(threshold), width, detector().iou_threshold))


@functools.cache
def cut_sofa(percent: int) -> Cut:
    """The seam at so many percent of the sofa's width; the network runs twice."""
    image, box = the_image(), np.array(true_object(SOFA).visible_box)
    width = image.shape[1]
    shift = round(width - box[0] - percent / 100 * (box[2] - box[0]))
    rolled = np.roll(image, shift, axis=1)
    sofa = wrapped_box(box + np.array([shift, 0, shift, 0]), width)
    plain, extended = (keen_detector().detect_in_plane(seen) for seen in (rolled, extend_seam(rolled)))
    return Cut(rolled, sofa, Found(*plain), Found(*extended))


def cut_sofas() -> dict[int, Cut]:
    """All of CUTS, with a progress bar."""
    return {percent: cut_sofa(percent) for percent in progress(CUTS, "the network runs twice for every cut")}


def pieces_of_sofa(found: Found, sofa: np.ndarray, width: int) -> np.ndarray:
    """Indices of the boxes called sofa that lie on this one: at least half of their own area inside its exact box."""
    if len(found.boxes) == 0:
        return np.zeros(0, dtype=int)
    boxes = wrapped_box(found.boxes, width)
    inside = shared_area(boxes, sofa[None], width)[:, 0] / box_area(boxes)
    return np.flatnonzero((inside >= 0.5) & (np.array(found.labels) == "sofa"))


def best_overlap(found: Found, sofa: np.ndarray, width: int) -> float:
    """Greatest IoU of a piece with the sofa's exact box; 0 without a piece."""
    pieces = pieces_of_sofa(found, sofa, width)
    if len(pieces) == 0:
        return 0.0
    boxes = wrapped_box(found.boxes[pieces], width)
    shared = shared_area(boxes, sofa[None], width)[:, 0]
    return float((shared / (box_area(boxes) + box_area(sofa) - shared)).max())


class OnSofa(NamedTuple):
    """What the network says of a place on the sofa, whatever it takes it for."""

    label: str
    score: float
    columns: tuple[float, float]
    overlap: float
    """IoU with the sofa's exact box."""


def said_of_the_sofa(cut: Cut, extension: bool, threshold: float) -> list[OnSofa]:
    """Every box of which at least half lies inside the sofa's exact box, the surest first."""
    found, width = cut.objects(extension, threshold), cut.image.shape[1]
    boxes = wrapped_box(found.boxes, width)
    shared = shared_area(boxes, cut.sofa[None], width)[:, 0]
    overlap = shared / (box_area(boxes) + box_area(cut.sofa) - shared)
    rows = zip(found.labels, found.scores.tolist(), boxes[:, [0, 2]].tolist(), overlap.tolist(), strict=True)
    on = [OnSofa(label, score, tuple(ends), iou) for label, score, ends, iou in rows]
    return [on[i] for i in np.argsort(-found.scores) if shared[i] >= 0.5 * box_area(boxes)[i]]


def cut_table(cuts: dict[int, Cut], threshold: float) -> str:
    """For each place of the seam: boxes on the sofa and the best overlap, without and with the extension."""
    lines = ["seam at [% of the sofa]   without: boxes, best IoU   with: boxes, best IoU"]
    for percent, cut in cuts.items():
        row = f"{percent:>12}             "
        for extension in (False, True):
            found, width = cut.objects(extension, threshold), cut.image.shape[1]
            count, overlap = len(pieces_of_sofa(found, cut.sofa, width)), best_overlap(found, cut.sofa, width)
            row += f"{count:>10}{overlap:>11.2f}" + " " * 6
        lines.append(row.rstrip())
    return "\n".join(lines)


def cut_counts(cuts: dict[int, Cut], threshold: float, extension: bool) -> dict[str, int]:
    """In how many places of the seam the sofa is found once and whole, more than once, or not whole at all."""
    counts = {"once and whole": 0, "more than once": 0, "only a part, or not at all": 0}
    for cut in cuts.values():
        found, width = cut.objects(extension, threshold), cut.image.shape[1]
        if len(pieces_of_sofa(found, cut.sofa, width)) > 1:
            counts["more than once"] += 1
        elif best_overlap(found, cut.sofa, width) >= WHOLE_IOU:
            counts["once and whole"] += 1
        else:
            counts["only a part, or not at all"] += 1
    return counts
