"""What the network was taught and what it sees, a sofa that the seam cuts, and colours in boxes against the map's."""

from __future__ import annotations

import functools
import json
from collections import namedtuple
from collections.abc import Sequence

import cv2
import numpy as np

from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.darknet import read_cfg
from course_lib.spherical_stereo.detection.detected_object import box_area, box_iou, shared_area, wrapped_box
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.detection.seam import extend_seam, select_on_circle
from course_lib.spherical_stereo.panorama import read_panorama
from courseware.experiments.room_evaluation import match_detections
from courseware.lessons.kit.progress_bar import progress
from courseware.lessons.kit.room_data import room_map, room_recording, the_image, the_pair
from courseware.paths import data_path
from courseware.simulation.room import stereo_recording
from courseware.simulation.room.stereo_recording import TrueObject

SOFA = 2  # number in the map of the sofa across the seam
WHOLE_IOU = 0.7  # overlap with the exact box from which a sofa counts as found whole (chosen)
SCORED_PAIRS = (0, 3, 9, 15)  # of experiment 1, spread over the room (chosen)
TrainingPicture = namedtuple("TrainingPicture", "image labels boxes")  # (H, W, 3) uint8 BGR, n texts, (n, 4)
ThresholdScore = namedtuple("ThresholdScore", "right made wanted")  # boxes right, boxes made, objects there are
OnSofa = namedtuple("OnSofa", "box score label overlap")  # a box on the sofa, its IoU with the sofa's exact box


def training_picture() -> TrainingPicture:
    """Return the stored picture with the objects that the training asks for: at least half visible, largest first."""
    folder = data_path("detector/training_picture")
    (entry,) = json.loads((folder / "boxes.json").read_text(encoding="utf-8"))["images"]
    things = [thing for thing in map(stereo_recording.true_object, entry["objects"]) if thing.visible_fraction >= 0.5]
    things.sort(key=lambda thing: -np.prod(np.subtract(thing.visible_box[2:], thing.visible_box[:2])))
    boxes = np.array([thing.visible_box for thing in things])
    return TrainingPicture(read_panorama(folder / entry["file"]).image, [thing.label for thing in things], boxes)


def anchors() -> tuple[np.ndarray, np.ndarray]:
    """Return the network's nine shapes `(9, 2)`, width and height in pixels of its input, and the stride of each."""
    heads = [s for s in read_cfg(next(data_path("detector").glob("*.cfg"))) if s.kind == "yolo"]
    shapes, strides = np.array(heads[0].integers("anchors")).reshape(-1, 2), np.zeros(9, dtype=int)
    for head, stride in zip(heads, (32, 16, 8), strict=True):
        strides[head.integers("mask")] = stride
    return shapes, strides


@functools.cache
def keen_detector() -> YoloDetector:
    """Return the course's detector with a low threshold, so that it runs once and the sliders choose their own."""
    return YoloDetector.load(data_path("detector"), score_threshold=0.1)


def true_object(number: int) -> TrueObject:
    """Return an object of this lesson's panorama by its number in the map, with its exact box."""
    return next(thing for thing in the_pair().upper_objects if thing.number == number)


class Found(namedtuple("Found", "boxes scores labels")):
    """Boxes `(n, 4)` in edge coordinates, with a score and a label each `(n,)`."""

    def above(self, threshold: float) -> Found:
        return Found(*(values[self.scores >= threshold] for values in self))


class Cut(namedtuple("Cut", "image sofa plain extended")):
    """The panorama with the seam through the sofa, its exact box, and what is seen without and with the extension."""

    def objects(self, extension: bool, threshold: float) -> Found:
        """Return what comes out in the end: one box for each object, 0 <= u_min < W."""
        if not extension:
            return self.plain.above(threshold)
        seen = self.extended.above(threshold)
        return Found(*select_on_circle(*seen, self.image.shape[1], keen_detector().iou_threshold))


@functools.cache
def cut_sofa(percent: int) -> Cut:
    """Cut at so many percent of the sofa's width; the network runs twice."""
    box, width = true_object(SOFA).visible_box, the_image().shape[1]
    shift = round(width - box[0] - percent / 100 * (box[2] - box[0]))
    rolled, found = np.roll(the_image(), shift, axis=1), []
    for seen in (rolled, extend_seam(rolled)):
        boxes, scores, classes = keen_detector().detect_in_plane(seen)
        found.append(Found(boxes, scores, np.array(keen_detector().labels)[classes]))
    return Cut(rolled, wrapped_box(np.add(box, [shift, 0, shift, 0]), width), *found)


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
        without, with_it = (pieces_of_sofa(cut, extension, threshold) for extension in (False, True))
        columns = f"{len(without[0]):>10}{without[1]:>11.2f}{'':6}{len(with_it[0]):>10}{with_it[1]:>11.2f}"
        lines.append(f"{percent:>12}{'':13}{columns}")
    return "\n".join(lines)


def cut_counts(cuts: dict[int, Cut], threshold: float, extension: bool) -> dict[str, int]:
    """Return in how many places of the seam the sofa is found once and whole, more than once, or not whole at all."""
    found = [pieces_of_sofa(cut, extension, threshold) for cut in cuts.values()]
    twice = sum(len(pieces) > 1 for pieces, _ in found)
    whole = sum(len(pieces) == 1 and overlap >= WHOLE_IOU for pieces, overlap in found)
    return {"once and whole": whole, "more than once": twice, "only a part, or not at all": len(found) - twice - whole}


def precision_and_recall(thresholds: Sequence[float]) -> dict[float, ThresholdScore]:
    """Return the scores at IoU 0.5 over the upper images of `SCORED_PAIRS`. The network runs once an image."""
    pairs, totals = [room_recording(1).pairs[index] for index in SCORED_PAIRS], np.zeros((len(thresholds), 3), int)
    for pair in progress(pairs, "detecting objects"):
        seen = keen_detector().detect(pair.images()[0])
        for total, threshold in zip(totals, thresholds, strict=True):
            kept = [one for one in seen if one.score >= threshold]
            matching = match_detections(kept, pair.upper_objects, room_recording(1).width)
            total += [matching.correct.sum(), len(matching.correct), matching.n_objects]
    return {threshold: ThresholdScore(*total) for threshold, total in zip(thresholds, totals.tolist(), strict=True)}


def is_large(thing: TrueObject) -> bool:
    """Whether an object is large enough to measure its colour: 30 pixels high."""
    return thing.visible_box[3] - thing.visible_box[1] >= 30


def colours_against_map() -> np.ndarray:
    """Return rows `(3, n)` for the large objects of experiment 1: how far the hue of the exact box [degrees, NaN for
    grey] and its saturation [%] are from the map's, and the share of the object that is visible."""
    rows = []
    for pair in room_recording(1).pairs:
        image = pair.images()[0]
        for thing in filter(is_large, pair.upper_objects):
            (hue, saturation), landmark = (
                mean_hue_saturation(image, thing.visible_box),
                room_map().landmarks[thing.number],
            )
            gap = abs((hue - landmark.hue + 180) % 360 - 180)
            rows.append((gap, abs(saturation - landmark.saturation), thing.visible_fraction))
    return np.array(rows).T


def hues_and_saturations(image_bgr: np.ndarray, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return hue [degrees] and saturation [0 to 1] `(n,)` of every pixel of a box, also across the seam."""
    u_min, v_min, u_max, v_max = np.ceil(np.subtract(box, 0.5)).astype(int)
    columns = np.arange(u_min, max(u_max, u_min + 1)) % image_bgr.shape[1]
    rows = np.arange(max(v_min, 0), min(max(v_max, v_min + 1), len(image_bgr)))
    pixels = image_bgr[np.ix_(rows, columns)].astype(np.float32) / 255
    return tuple(cv2.cvtColor(pixels, cv2.COLOR_BGR2HSV).reshape(-1, 3).astype(np.float64).T[:2])
