"""Precision and recall of a finished detector on panoramas whose objects are known, at its one threshold."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from course_lib.experiments.detection_scores import Boxes, DetectionScoreError, Matching, match_detections
from course_lib.experiments.room import counts_as_object
from course_lib.spherical_stereo.recording import StereoRecording, TrueObject


class DetectorScore(NamedTuple):
    """How well a detector did, at IoU 0.5."""

    images: int
    objects: int
    """To be found: half visible, 30 pixels high at a width of 1280."""
    found: int
    false_alarms: int

    @property
    def precision(self) -> float:
        """Right detections over all detections that count; nan without any."""
        return self.found / (self.found + self.false_alarms) if self.found + self.false_alarms else float("nan")

    @property
    def recall(self) -> float:
        """Objects found over objects to be found."""
        return self.found / self.objects


def score_detector(detector, labelled: Iterable[tuple[np.ndarray, Sequence[TrueObject]]]) -> DetectorScore:
    """Run a detector over images and count.

    detector: anything with `detect(image_bgr)`. labelled: (panorama, all that can be seen on it); objects that do
    not count are ignored, neither hit nor false alarm. Raises `DetectionScoreError` when there is no object to find.
    Source: paper 2, section 2.2.
    """
    matchings = [match_image(detector.detect(image), things, image.shape[1]) for image, things in labelled]
    n_objects = sum(matching.n_objects for matching in matchings)
    if n_objects == 0:
        raise DetectionScoreError("there is no object to be found in these panoramas, so recall is not defined")
    found = sum(int(matching.correct.sum()) for matching in matchings)
    return DetectorScore(len(matchings), n_objects, found, sum(len(m.correct) for m in matchings) - found)


def match_image(detections: Sequence, objects: Sequence[TrueObject], width: int) -> Matching:
    """The detections of one panorama against its objects."""
    wanted = [thing for thing in objects if counts_as_object(thing, width)]
    ignored = [thing for thing in objects if not counts_as_object(thing, width)]
    boxes = np.array([one.box for one in detections], float).reshape(-1, 4)
    scores = np.array([one.score for one in detections], float)
    return match_detections(
        Boxes([one.label for one in detections], boxes, scores), *map(_boxes, (wanted, ignored)), width
    )


def labelled_panoramas(recording: StereoRecording) -> Iterable[tuple[np.ndarray, Sequence[TrueObject]]]:
    """Every image of a recording with its objects."""
    for pair in recording.pairs:
        upper, lower = pair.images()
        yield upper, pair.upper_objects
        yield lower, pair.lower_objects


def _boxes(objects: Sequence[TrueObject]) -> Boxes:
    return Boxes([thing.label for thing in objects], np.array([thing.visible_box for thing in objects]).reshape(-1, 4))
