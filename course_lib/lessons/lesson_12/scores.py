"""Precision and recall over thresholds, and how far measured colours are from the map's."""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.experiments.room_evaluation import counts_as_object, match_detections
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.lessons.lesson_12.seam_cuts import keen_detector
from course_lib.spherical_stereo.detection.colour import mean_hue_saturation

SCORED_PAIRS = (0, 3, 9, 15)  # of experiment 1, spread over the room (chosen)


class ThresholdScore(NamedTuple):
    """What a score threshold gives: boxes that are right, boxes made, objects that there are."""

    right: int
    made: int
    wanted: int

    @property
    def precision(self) -> float:
        """Share of the boxes that are right; NaN where there are none."""
        return self.right / self.made if self.made else float("nan")

    @property
    def recall(self) -> float:
        """Share of the objects that are found."""
        return self.right / self.wanted


def precision_and_recall(thresholds: Sequence[float]) -> dict[float, ThresholdScore]:
    """Scores at IoU 0.5 over SCORED_PAIRS' upper images, for each score threshold.

    The network runs once an image; objects that hardly show are neither right nor wrong.
    """
    pairs = [room_recording(1).pairs[index] for index in SCORED_PAIRS]
    seen = [keen_detector().detect(pair.images()[0]) for pair in progress(pairs, "detecting objects")]
    width, scores = room_recording(1).width, {}
    for threshold in thresholds:
        matchings = [
            match_detections([one for one in found if one.score >= threshold], pair.upper_objects, width)
            for pair, found in zip(pairs, seen, strict=True)
        ]
        right, made = (
            int(sum(part)) for part in zip(*((m.correct.sum(), len(m.correct)) for m in matchings), strict=True)
        )
        scores[threshold] = ThresholdScore(right, made, sum(matching.n_objects for matching in matchings))
    return scores


class Colours(NamedTuple):
    """Hue and saturation of objects, measured in exact boxes, against the map's; `(n,)` each."""

    hue_difference: np.ndarray
    """Degrees, 0 to 180; NaN where one of both is grey."""
    saturation_difference: np.ndarray
    """Percent."""
    visible: np.ndarray
    """Share of the object that shows, 0 to 1."""


@functools.cache
def colours_against_map() -> Colours:
    """Every object of the upper images of experiment 1 that counts or is half hidden."""
    semantic_map = room_map()
    rows = []
    for pair in room_recording(1).pairs:
        image = pair.images()[0]
        for thing in pair.upper_objects:
            if thing.visible_box[3] - thing.visible_box[1] < 30 and not counts_as_object(thing, image.shape[1]):
                continue
            hue, saturation = mean_hue_saturation(image, thing.visible_box)
            landmark = semantic_map.landmarks[thing.number]
            gap = abs((hue - landmark.hue + 180) % 360 - 180)
            rows.append((gap, abs(saturation - landmark.saturation), thing.visible_fraction))
    return Colours(*np.array(rows).T)
