"""A sofa that the seam cuts in many places, and what the network makes of it with and without the extension."""

from __future__ import annotations

import functools
from collections import namedtuple
from typing import NamedTuple

import numpy as np

from course_lib.lessons.kit.room_photographs import the_image, the_pair
from course_lib.paths import data_path
from course_lib.spherical_stereo.detection.detected_object import box_area, box_iou, shared_area, wrapped_box
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.seam import extend_seam, select_on_circle
from course_lib.spherical_stereo.recording import TrueObject

LOWEST = 0.1  # score: what the sliders can go down to; the network runs once, the rest is sorting
SOFA = 2  # number in the map of the sofa across the seam
WHOLE_IOU = 0.7  # overlap with the exact box from which a sofa counts as found whole (chosen)


@functools.cache
def keen_detector() -> YoloDetector:
    """Return the course's detector with a very low threshold, so that sliders can choose theirs afterwards."""
    return YoloDetector.load(data_path("detector"), score_threshold=LOWEST)


def true_object(number: int) -> TrueObject:
    """Return an object of this lesson's panorama by its number in the map, with its exact box."""
    return next(thing for thing in the_pair().upper_objects if thing.number == number)


class Found(NamedTuple):
    """Boxes `(n, 4)` in edge coordinates, with a score and a label each `(n,)`."""

    boxes: np.ndarray
    scores: np.ndarray
    labels: np.ndarray

    def above(self, threshold: float) -> Found:
        return Found(*(values[self.scores >= threshold] for values in self))


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
        seen = self.extended.above(threshold)
        return Found(*select_on_circle(*seen, self.image.shape[1], keen_detector().iou_threshold))


@functools.cache
def cut_sofa(percent: int) -> Cut:
    """Cut at so many percent of the sofa's width; the network runs twice."""
    (u_min, _, u_max, _), width = true_object(SOFA).visible_box, the_image().shape[1]
    shift = round(width - u_min - percent / 100 * (u_max - u_min))
    rolled, found = np.roll(the_image(), shift, axis=1), []
    for seen in (rolled, extend_seam(rolled)):
        boxes, scores, classes = keen_detector().detect_in_plane(seen)
        found.append(Found(boxes, scores, np.array(keen_detector().labels)[classes]))
    sofa = np.add(true_object(SOFA).visible_box, [shift, 0, shift, 0])
    return Cut(rolled, wrapped_box(sofa, width), *found)


OnSofa = namedtuple("OnSofa", "box score label overlap")  # a box on the sofa, its IoU with the sofa's exact box


def said_of_the_sofa(cut: Cut, extension: bool, threshold: float) -> list[OnSofa]:
    """Return every box of which at least half lies inside the sofa's exact box, the surest first."""
    found, width = cut.objects(extension, threshold), cut.image.shape[1]
    inside = shared_area(found.boxes, cut.sofa, width)[:, 0] >= 0.5 * box_area(found.boxes)
    said = map(OnSofa, *found, box_iou(found.boxes, cut.sofa, width)[:, 0])
    return sorted((one for one, lies in zip(said, inside, strict=True) if lies), key=lambda one: -one.score)


def pieces_of_sofa(cut: Cut, extension: bool, threshold: float) -> tuple[list[OnSofa], float]:
    """Return the boxes on the sofa that are called one, and the best overlap of one with it."""
    pieces = [one for one in said_of_the_sofa(cut, extension, threshold) if one.label == "sofa"]
    return pieces, max((piece.overlap for piece in pieces), default=0.0)


def cut_table(cuts: dict[int, Cut], threshold: float) -> str:
    """Return a row for each place of the seam: boxes on the sofa and the best overlap, without and with extension."""
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
