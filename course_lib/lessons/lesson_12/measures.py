"""What the network was taught, how often it is right, and how far the colours in boxes are from the map's."""

import json
from collections import namedtuple
from collections.abc import Sequence

import cv2
import numpy as np

from course_lib.experiments.room_evaluation import match_detections
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_12.seam_cuts import keen_detector
from course_lib.paths import data_path
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation
from course_lib.spherical_stereo.detection.darknet import read_cfg
from course_lib.spherical_stereo.panorama import read_panorama
from course_lib.spherical_stereo.recording import TrueObject, true_object

SCORED_PAIRS = (0, 3, 9, 15)  # of experiment 1, spread over the room (chosen)
TrainingPicture = namedtuple("TrainingPicture", "image labels boxes")  # (H, W, 3) uint8 BGR, n texts, (n, 4)
ThresholdScore = namedtuple("ThresholdScore", "right made wanted")  # boxes right, boxes made, objects there are


def training_picture() -> TrainingPicture:
    """Return the stored picture with the objects that the training asks for: at least half visible, largest first."""
    folder = data_path("detector/training_picture")
    (entry,) = json.loads((folder / "boxes.json").read_text(encoding="utf-8"))["images"]
    things = [thing for thing in map(true_object, entry["objects"]) if thing.visible_fraction >= 0.5]
    things.sort(key=lambda thing: -np.prod(np.subtract(thing.visible_box[2:], thing.visible_box[:2])))
    boxes = np.array([thing.visible_box for thing in things])
    return TrainingPicture(read_panorama(folder / entry["file"]), [thing.label for thing in things], boxes)


def anchors() -> tuple[np.ndarray, np.ndarray]:
    """Return the network's nine shapes `(9, 2)`, width and height in pixels of its input, and the stride of each."""
    heads = [s for s in read_cfg(next(data_path("detector").glob("*.cfg"))) if s.kind == "yolo"]
    shapes, strides = np.array(heads[0].integers("anchors")).reshape(-1, 2), np.zeros(9, dtype=int)
    for head, stride in zip(heads, (32, 16, 8), strict=True):
        strides[head.integers("mask")] = stride
    return shapes, strides


def precision_and_recall(thresholds: Sequence[float]) -> dict[float, ThresholdScore]:
    """Return the scores at IoU 0.5 over the upper images of `SCORED_PAIRS`. The network runs once an image."""
    record, scores = room_recording(1), {}
    pairs = [record.pairs[index] for index in SCORED_PAIRS]
    seen = [keen_detector().detect(pair.images()[0]) for pair in progress(pairs, "detecting objects")]
    for threshold in thresholds:
        total = np.zeros(3, dtype=int)
        for pair, found in zip(pairs, seen, strict=True):
            kept = [one for one in found if one.score >= threshold]
            matching = match_detections(kept, pair.upper_objects, record.width)
            total += [matching.correct.sum(), len(matching.correct), matching.n_objects]
        scores[threshold] = ThresholdScore(*total.tolist())
    return scores


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
            hue, saturation = mean_hue_saturation(image, thing.visible_box)
            landmark = room_map().landmarks[thing.number]
            gap = abs((hue - landmark.hue + 180) % 360 - 180)
            rows.append((gap, abs(saturation - landmark.saturation), thing.visible_fraction))
    return np.array(rows).T


def hues_and_saturations(image_bgr: np.ndarray, box: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return hue [degrees] and saturation [0 to 1] `(n,)` of every pixel of a box, also across the seam."""
    u_min, v_min, u_max, v_max = np.ceil(np.subtract(box, 0.5)).astype(int)
    columns = np.arange(u_min, max(u_max, u_min + 1)) % image_bgr.shape[1]
    rows = np.arange(max(v_min, 0), min(max(v_max, v_min + 1), len(image_bgr)))
    pixels = image_bgr[np.ix_(rows, columns)].astype(np.float32) / 255
    hsv = cv2.cvtColor(pixels, cv2.COLOR_BGR2HSV).reshape(-1, 3).astype(np.float64)
    return hsv[:, 0], hsv[:, 1]
