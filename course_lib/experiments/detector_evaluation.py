"""Precision and recall of a finished detector on panoramas whose objects are known, at its one threshold."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np

from course_lib.experiments.detection_scores import Boxes, DetectionScoreError, Matching, match_detections
from course_lib.experiments.room import counts_as_object
from course_lib.spherical_stereo.detection import detector as detector_module
from course_lib.spherical_stereo.detection import suppression
from course_lib.spherical_stereo.detection.detected_object import box_centre
from course_lib.spherical_stereo.recording import StereoRecording, TrueObject

VOTE_IOUS, VOTE_SCORES = (0.5, 0.6, 0.7, 0.8), (0.05, 0.1, 0.3)
"""What is tried for the two constants of `suppression.vote_on_boxes`."""
NO_VOTES = (1.0, 1.0)
"""As constants: no box votes but the one that stays."""


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
    return _count(match_image(detector.detect(image), things, image.shape[1]) for image, things in labelled)


class VotingScore(NamedTuple):
    """A detector with one choice of the voters' constants."""

    vote_iou: float
    vote_score: float
    score: DetectorScore
    jitter_u: float
    """Root mean square of the columns by which centres of found boxes miss those of the exact ones, pixels."""
    jitter_v: float
    """The same for rows, which distances depend on."""


def compare_voting(detector, labelled: Iterable[tuple[np.ndarray, Sequence[TrueObject]]]) -> list[VotingScore]:
    """Jitter of box centres, precision and recall for every choice of `VOTE_IOU` and `VOTE_SCORE`, and without votes.

    labelled: panoramas of validation rooms, with all that can be seen on them. An exact box is the visible one; the
    jitter is over the objects that count and were found. Source: paper 2, section 2.2 (silent about it).
    """
    labelled = list(labelled)
    choices = [NO_VOTES, *((iou, score) for iou in VOTE_IOUS for score in VOTE_SCORES)]
    found = []
    for iou, score in choices:
        with _voting(iou, score):
            detections = [detector.detect(image) for image, _ in labelled]
        pairs = list(zip(detections, labelled, strict=True))
        matchings = [match_image(many, things, image.shape[1]) for many, (image, things) in pairs]
        missed = np.concatenate(
            [
                centre_errors(matching, many, things, image.shape[1])
                for matching, (many, (image, things)) in zip(matchings, pairs, strict=True)
            ]
        )
        jitter = np.sqrt((missed**2).mean(axis=0)) if len(missed) else (np.nan, np.nan)
        found.append(VotingScore(iou, score, _count(matchings), *map(float, jitter)))
    return found


def centre_errors(matching: Matching, detections: Sequence, objects: Sequence[TrueObject], width: int) -> np.ndarray:
    """By how much the boxes of found objects miss the exact ones: `(n, 2)` columns and rows, centre to centre."""
    wanted = [thing for thing in objects if counts_as_object(thing, width)]
    errors = [
        np.subtract(box_centre(detections[i].box), box_centre(wanted[k].visible_box))
        for i, k in zip(matching.detection_index, matching.object_index, strict=True)
        if k >= 0
    ]
    errors = np.array(errors).reshape(-1, 2)
    errors[:, 0] = (errors[:, 0] + width / 2) % width - width / 2
    return errors


@contextmanager
def _voting(iou: float, score: float) -> Iterator[None]:
    """The detector's constants replaced for a while: they are no options, for nobody but this table changes them."""
    before = suppression.VOTE_IOU, suppression.VOTE_SCORE
    suppression.VOTE_IOU = iou
    suppression.VOTE_SCORE = detector_module.VOTE_SCORE = score
    try:
        yield
    finally:
        suppression.VOTE_IOU, suppression.VOTE_SCORE = before
        detector_module.VOTE_SCORE = before[1]


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


def _count(matchings: Iterable[Matching]) -> DetectorScore:
    matchings = list(matchings)
    n_objects = sum(matching.n_objects for matching in matchings)
    if n_objects == 0:
        raise DetectionScoreError("there is no object to be found in these panoramas, so recall is not defined")
    found = sum(int(matching.correct.sum()) for matching in matchings)
    return DetectorScore(len(matchings), n_objects, found, sum(len(m.correct) for m in matchings) - found)


def _boxes(objects: Sequence[TrueObject]) -> Boxes:
    return Boxes([thing.label for thing in objects], np.array([thing.visible_box for thing in objects]).reshape(-1, 4))
