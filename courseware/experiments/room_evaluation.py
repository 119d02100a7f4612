"""How good is it: tables 2 to 5 of paper 2 (section 3), and the paper's own numbers."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.detection.detected_object import Detection, box_iou, canonical_label
from course_lib.spherical_stereo.outcomes import Status
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from courseware.simulation.room.stereo_recording import TrueObject

KINDS = CORRECT, INCORRECT, UNABLE = "correct", "incorrect", "unable"
MAX_ERROR = 2.0  # m in x and in y; by table 2 exactly 2 m is correct and incorrect, here it is correct
MIN_PAIRS = 2  # table 2: "one set or fewer used" is unable to calculate
IOU_THRESHOLD = 0.5  # overlap from which on a detection shows an object
MIN_VISIBLE = 0.5  # share of an object's pixels that must be seen for it to count; chosen
MIN_HEIGHT = 30.0  # pixels at a width of 1280 that its visible box must be high to count; chosen
NO_OBJECT = -1  # in place of an object's or a landmark's number: none is shown, or it is on no map
ERRORS = ("mean_dx_m", "mean_dy_m", "mean_dtheta_deg", "std_dx_m", "std_dy_m", "std_dtheta_deg")


def _rows(**rows: tuple[float, ...]) -> dict[str, dict[str, float]]:
    return {kind: dict(zip(ERRORS, values, strict=True)) for kind, values in rows.items()}


# Table 3, experiment 1. The text gives the mean heading error of the correct ones as 11.92 degrees, the table 11.94;
# only the table's fits the row "All": (13 * 11.94 + 5 * 69.70) / 18 = 27.98, against 27.99 printed.
PAPER_TABLE_3 = _rows(
    all=(0.53, 0.62, 27.99, 0.81, 0.60, 41.85),
    correct=(0.23, 0.44, 11.94, 0.19, 0.41, 25.42),
    incorrect=(1.31, 1.10, 69.70, 1.19, 0.74, 47.09),
)
PAPER_TABLE_4 = _rows(  # experiment 2
    all=(0.59, 0.31, 14.75, 0.98, 0.29, 25.34),
    correct=(0.19, 0.20, 2.79, 0.19, 0.21, 1.82),
    incorrect=(1.65, 0.59, 45.85, 1.34, 0.29, 31.05),
)
# Table 5, percent of 20 poses, experiment by experiment: 13 correct, 5 incorrect, 2 unable.
PAPER_TABLE_5 = {k: {"correct_percent": 65.0, "incorrect_percent": 25.0, "unable_percent": 10.0} for k in (1, 2)}


class PoseOutcome(NamedTuple):
    """One pose judged by table 2: its kind, and absolute errors (m, m, degrees [0, 180]), which are NaN when unable."""

    kind: str
    dx_m: float
    dy_m: float
    dtheta_deg: float


def pose_errors(pose: Pose2D | None, true_pose: Sequence[float]) -> tuple[float, float, float]:
    """Return |dx|, |dy| in metres and |dtheta| in degrees; NaN without a pose."""
    if pose is None:
        return (np.nan,) * 3
    dx, dy = (abs(float(a - b)) for a, b in zip(pose[:2], true_pose[:2], strict=True))
    return dx, dy, abs(float(np.degrees(wrap_angle(pose.theta - true_pose[2]))))


def outcome(localization: Localization, true_pose: Sequence[float], true_landmarks: Sequence[int]) -> PoseOutcome:
    """Judge one localization against [x, y, theta], and the landmark that each observation shows (or `NO_OBJECT`).

    Table 2 calls unable only "one set or fewer used"; a fit that fails with more pairs is unable here as well, since
    it has no error. Source: paper 2, table 2.
    """
    wrong = wrong_pairs(localization, true_landmarks)
    if localization.status != Status.OK or len(localization.used_pairs) < MIN_PAIRS:
        return PoseOutcome(UNABLE, *pose_errors(None, true_pose))
    errors = pose_errors(localization.pose, true_pose)
    return PoseOutcome(CORRECT if not wrong and max(errors[:2]) <= MAX_ERROR else INCORRECT, *errors)


def wrong_pairs(localization: Localization, true_landmarks: Sequence[int]) -> tuple[tuple[int, int, int], ...]:
    """Return the used pairs that are wrong: (observation, landmark it was given, landmark it shows or `NO_OBJECT`)."""
    return tuple((i, j, int(true_landmarks[i])) for i, j in localization.used_pairs if int(true_landmarks[i]) != j)


def counts_as_object(thing: TrueObject, width: int) -> bool:
    """Return whether an object must be found: half of it is visible, in a box 30 pixels high at a width of 1280."""
    _, v_min, _, v_max = thing.visible_box
    return thing.visible_fraction >= MIN_VISIBLE and (v_max - v_min) * 1280 / width >= MIN_HEIGHT


def _overlaps(detections: Sequence[Detection], objects: Sequence[TrueObject], boxes: str, width: int) -> np.ndarray:
    """Return IoU `(n, m)` with the visible or the unoccluded boxes of the objects, 0 where the classes differ."""
    found, true = [one.box for one in detections], [getattr(thing, boxes) for thing in objects]
    overlap = box_iou(found, true, width) if found and true else np.zeros((len(found), len(true)))
    labels = [np.array([canonical_label(one.label) for one in side], object) for side in (detections, objects)]
    return np.where(labels[0][:, None] == labels[1], overlap, 0.0)


def identify_detections(detections: Sequence[Detection], objects: Sequence[TrueObject], width: int) -> tuple[int, ...]:
    """Return the number of the object that each detection shows, or `NO_OBJECT`. width: of the panorama, pixels.

    Each object is shown once, by the detection of its class that overlaps it most: around what is seen of it, or around
    all of it. Source: paper 2, section 3 (by people).
    """
    found = [NO_OBJECT] * len(detections)
    overlap = np.maximum(*(_overlaps(detections, objects, f"{box}_box", width) for box in ("visible", "unoccluded")))
    while overlap.size and overlap.max() >= IOU_THRESHOLD:
        i, k = np.unravel_index(np.argmax(overlap), overlap.shape)
        found[i] = objects[k].number
        overlap[i, :] = overlap[:, k] = 0.0
    return tuple(found)


class Matching(NamedTuple):
    """What became of the k detections of one panorama that count."""

    scores: np.ndarray  # `(k,)` falling
    correct: np.ndarray  # `(k,)` bool: found an object that no better detection had found
    n_objects: int  # Objects to be found


def match_detections(
    detections: Sequence[Detection], objects: Sequence[TrueObject], width: int, counts: Sequence[bool] | None = None
) -> Matching:
    """Judge the detections of a panorama, best score first: each takes the free object of its class it overlaps most.

    IoU must be 0.5 at least. counts: whether each object is to be found (None: `counts_as_object`). The others are
    ignored: what finds none, but overlaps one of these that much, is left out of the count.
    Source: paper 2, section 2.2 (the detector); the rules are the PASCAL VOC challenge's.
    """
    wanted = np.array([counts_as_object(one, width) for one in objects] if counts is None else counts, bool)
    scores, overlap = np.array([one.score for one in detections]), _overlaps(detections, objects, "visible_box", width)
    excused = (overlap[:, ~wanted] >= IOU_THRESHOLD).any(axis=1)
    overlap[:, ~wanted] = 0.0
    kept, correct = [], []
    for index in np.argsort(-scores, kind="stable"):
        is_right = bool((overlap[index] >= IOU_THRESHOLD).any())
        if is_right:
            overlap[:, overlap[index].argmax()] = 0.0  # taken
        if is_right or not excused[index]:
            kept.append(index)
            correct.append(is_right)
    return Matching(scores[kept], np.array(correct, bool), int(wanted.sum()))


def true_landmarks_of(
    found: Localization, upper_shows: Sequence[int], lower_shows: Sequence[int], n_landmarks: int
) -> tuple[int, ...]:
    """Return for every observation the landmark (object k is landmark k) that both its detections show, or -1."""
    true = [NO_OBJECT] * len(found.observations)
    for one in found.objects:
        shown = upper_shows[one.upper]
        if one.observation is not None and shown == lower_shows[one.lower] and shown < n_landmarks:
            true[one.observation] = shown
    return tuple(true)


def summary(outcomes: Sequence[PoseOutcome]) -> dict:
    """Return tables 3 to 5 of one experiment: rates, and means, standard deviations and medians of the errors.

    "all" is everything but unable. The standard deviation is that of the *absolute* differences about their mean, with
    divisor n: so reckoned, the paper's rows "correct" (13 poses) and "incorrect" (5) give its row "All" (18).
    Source: paper 2, tables 3 to 5.
    """
    kinds = [one.kind for one in outcomes]
    result: dict = {"n": len(kinds)} | {f"{kind}_percent": 100.0 * kinds.count(kind) / len(kinds) for kind in KINDS}
    for name, members in (("all", (CORRECT, INCORRECT)), (CORRECT, (CORRECT,)), (INCORRECT, (INCORRECT,))):
        errors = np.array([one[1:] for one in outcomes if one.kind in members]).reshape(-1, 3)
        result[name] = {"n": len(errors)} | statistics_of(errors, mean=np.mean, std=np.std, median=np.median)
    return result


def statistics_of(errors: np.ndarray, **statistics) -> dict[str, float | None]:
    """Return every statistic of |dx|, |dy|, |dtheta| `(n, 3)` by name, such as mean_dx_m; None where n is 0."""
    return {
        f"{name}_{unit}": float(reduce(errors[:, column])) if len(errors) else None
        for name, reduce in statistics.items()
        for column, unit in enumerate(PoseOutcome._fields[1:])
    }


def median(values: Sequence[float]) -> float | None:
    """Return the median; None of nothing."""
    return float(np.median(values)) if len(values) else None
