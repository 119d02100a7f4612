"""How good is it: tables 2 to 5 of paper 2 (section 3). The paper's own numbers are in `paper_tables`.

One pose is judged by `outcome`: correct, incorrect or unable to calculate, by table 2, with its absolute errors. Many
are counted and averaged by `summary`. What a detection really shows is told by the true boxes (`identify_detections`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.detection.detected_object import box_iou, canonical_label
from course_lib.spherical_stereo.pose.localization import OK, Localization

CORRECT, INCORRECT, UNABLE = "correct", "incorrect", "unable"
MAX_ERROR = 2.0  # m in x and in y; by table 2 exactly 2 m is correct and incorrect, here it is correct
MIN_PAIRS = 2  # table 2: "one set or fewer used" is unable to calculate
IDENTITY_IOU = 0.5  # overlap from which on a detection shows an object
NO_OBJECT = -1
"""In place of an index: the detection shows no object, or the object is on no map."""


class PoseOutcome(NamedTuple):
    """One pose judged by table 2."""

    kind: str  # "correct", "incorrect" or "unable"
    dx_m: float  # |x - true x|, metres; NaN when unable, as are the others
    dy_m: float  # |y - true y|, metres
    dtheta_deg: float  # |theta - true theta| on the circle, degrees [0, 180]


def outcome(localization: Localization, true_pose: Sequence[float], true_landmarks: Sequence[int]) -> PoseOutcome:
    """Judge one localization by table 2; its errors are absolute differences.

    unable: no pose, or fewer than two pairs used. correct: every used pair joins an observation to the landmark it
    really shows, and the errors in x and in y are at most 2 m each. incorrect: everything else. Table 2 calls unable
    only "one set or fewer used"; a fit that fails with more pairs is unable here as well, since it has no error.

    true_pose: [x, y, theta], metres and radians. true_landmarks: for every observation the index of its landmark, or
    `NO_OBJECT` (`true_landmarks_of` makes it). Source: paper 2, table 2.
    """
    wrong = wrong_pairs(localization, true_landmarks)
    if localization.status != OK or len(localization.used_pairs) < MIN_PAIRS:
        return PoseOutcome(UNABLE, math.nan, math.nan, math.nan)
    dx, dy = abs(float(localization.pose.x - true_pose[0])), abs(float(localization.pose.y - true_pose[1]))
    dtheta = abs(math.degrees(wrap_angle(localization.pose.theta - true_pose[2])))
    return PoseOutcome(CORRECT if not wrong and max(dx, dy) <= MAX_ERROR else INCORRECT, dx, dy, dtheta)


def wrong_pairs(localization: Localization, true_landmarks: Sequence[int]) -> tuple[tuple[int, int, int], ...]:
    """Return the used pairs that are wrong: (observation, landmark it was given, landmark it shows or `NO_OBJECT`)."""
    if len(true_landmarks) != len(localization.observations):
        raise ValueError(
            f"one true landmark an observation is needed; got {len(true_landmarks)} for "
            f"{len(localization.observations)} observations"
        )
    return tuple((i, j, int(true_landmarks[i])) for i, j in localization.used_pairs if int(true_landmarks[i]) != j)


def identify_detections(
    detections: Sequence, true_objects: Sequence[tuple[str, Sequence[float], Sequence[float]]], width: float
) -> tuple[int, ...]:
    """Return which true object each detection shows: its index, or `NO_OBJECT`.

    A detection shows an object of its class whose box it overlaps with IoU >= 0.5, on the circle of columns; each
    object is shown once, by the detection that overlaps it most. An object half hidden has two boxes, around what is
    seen of it and around all of it, and a detector may give either: the greater overlap counts. true_objects: (label,
    visible box, unoccluded box). width: of the panorama, pixels. Source: paper 2, section 3 (where people judged it).
    """
    found = [NO_OBJECT] * len(detections)
    if not len(detections) or not len(true_objects):
        return tuple(found)
    boxes = [one.box for one in detections]
    overlap = np.maximum(*(box_iou(boxes, [thing[k] for thing in true_objects], width) for k in (1, 2)))
    labels = [canonical_label(thing[0]) for thing in true_objects]
    for i, one in enumerate(detections):
        overlap[i, [label != canonical_label(one.label) for label in labels]] = 0.0
    while overlap.max() >= IDENTITY_IOU:
        i, k = np.unravel_index(np.argmax(overlap), overlap.shape)
        found[i] = int(k)
        overlap[i, :] = overlap[:, k] = 0.0
    return tuple(found)


def true_landmarks_of(
    localization: Localization,
    upper_identity: Sequence[int],
    landmark_of_object: Mapping[int, int] | Sequence[int],
    lower_identity: Sequence[int] | None = None,
) -> tuple[int, ...]:
    """Return for every observation the landmark it really shows, or `NO_OBJECT`.

    upper_identity, lower_identity: true object of each detection (`identify_detections`); an observation made from two
    different objects shows neither. landmark_of_object: index on the map of each true object that is on it.
    """
    landmarks = landmark_of_object if isinstance(landmark_of_object, Mapping) else dict(enumerate(landmark_of_object))
    true = [NO_OBJECT] * len(localization.observations)
    for one in localization.objects:
        if one.observation is None:
            continue
        shown = int(upper_identity[one.upper])
        if lower_identity is None or int(lower_identity[one.lower]) == shown:
            true[one.observation] = int(landmarks.get(shown, NO_OBJECT))
    return tuple(true)


def summary(outcomes: Sequence[PoseOutcome]) -> dict:
    """Return tables 3 to 5 of one experiment: rates, and means, standard deviations and medians of the errors.

    Keys: n, correct_percent, incorrect_percent, unable_percent, and for "all" (everything but unable), "correct" and
    "incorrect": n, mean_dx_m, mean_dy_m, mean_dtheta_deg, the same with std_ and median_; None where there is nothing
    to average. The standard deviation is that of the *absolute* differences about their mean, with divisor n:
    so reckoned, the paper's rows "correct" (13 poses) and "incorrect" (5) give its row "All" (18).
    Source: paper 2, tables 3 to 5.
    """
    kinds = [one.kind for one in outcomes]
    result: dict = {"n": len(kinds)}
    result |= {f"{kind}_percent": 100.0 * kinds.count(kind) / len(kinds) for kind in (CORRECT, INCORRECT, UNABLE)}
    for name, members in (("all", (CORRECT, INCORRECT)), (CORRECT, (CORRECT,)), (INCORRECT, (INCORRECT,))):
        errors = np.array([one[1:] for one in outcomes if one.kind in members]).reshape(-1, 3)
        group: dict = {"n": len(errors)}
        for statistic, reduce in (("mean", np.mean), ("std", np.std), ("median", np.median)):
            for column, unit in enumerate(PoseOutcome._fields[1:]):
                group[f"{statistic}_{unit}"] = float(reduce(errors[:, column])) if len(errors) else None
        result[name] = group
    return result
