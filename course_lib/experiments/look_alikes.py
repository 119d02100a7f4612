"""Rooms that look alike: answers within half a metre and 10 degrees, wrong ones given out, and none given.

Table 2 of the paper calls a pose correct when every match is right and the errors are below 2 m. Here a pose is judged
by where it is. The paper's measure, all matches right, stands beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.confidence import MIN_CONFIDENCE
from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.hypotheses import rotations
from course_lib.beyond.look_alikes.matchers import ASSOCIATIONS, matcher
from course_lib.beyond.several_views import Motion, SemanticTracker
from course_lib.experiments.intervals import share_intervals, wilson_percent
from course_lib.experiments.observed_rooms import stored_map, stored_observations, stored_sequences
from course_lib.experiments.room import PairResult
from course_lib.experiments.room_evaluation import NO_OBJECT
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

CORRECT, WRONG, UNANSWERED = "correct", "wrong", "unanswered"
KINDS = (CORRECT, WRONG, UNANSWERED)
MAX_ERROR_M, MAX_TURN_DEG = 0.5, 10.0
ODOMETRY_STREAM = 0x0D0  # joins a room's seed
THINNING_STREAM = 0x7117  # likewise
LEFT_OUT = 0.5  # share of the observations, drawn one by one; chosen
HEADS = ("n", *KINDS, "all matches right", "dx [m]", "dy [m]", "dtheta [deg]")
WIDTHS = (5, 20, 18, 20, 22, 9, 9, 14)  # of the table's columns
SAME_PLACE = 0.05  # m, within which two poses of a recording are one place
# Without each part in turn: what it is worth.
ABLATION: dict[str, Evidence] = {
    "everything": Evidence(),
    "no_colour": Evidence(colour=False),
    "no_one_to_one": Evidence(one_to_one=False),
    "no_stereo_covariance": Evidence(stereo_covariance=False),
    "no_refit": Evidence(refit=False),
    "no_negative_evidence": Evidence(negative=False),
    "no_free_space": Evidence(free_space=False),
    "gap_alone": Evidence(absolute=False),
    "geometry_alone": Evidence(colour=False, negative=False, free_space=False),
}


class OdometryModel(NamedTuple):
    """How well a rig on wheels knows its steps: standard deviations."""

    distance: float = 0.01  # metres, however short the step; chosen
    distance_share: float = 0.05  # of the step; chosen: wheels slip
    turn: float = float(np.deg2rad(1.0))  # radians, however small the turn; chosen
    turn_share: float = 0.05  # of the turn; chosen


class Answer(NamedTuple):
    """One pose that was asked for, and what came."""

    seed: int
    experiment: int
    name: str
    method: str
    kind: str  # "correct", "wrong" or "unanswered"
    confidence: float  # 0 to 1; of a method that has none, 1 for what is given out
    best_is_right: bool  # Whether the most believed pose is right, given out or not
    dx_m: float  # Absolute error of the pose given out; NaN without one
    dy_m: float
    dtheta_deg: float
    all_matches_right: bool | None
    """The paper's measure, of a pose given out; None where nobody told what each observation shows."""


def pose_errors(pose: Pose2D | None, true_pose: Sequence[float]) -> tuple[float, float, float]:
    """|dx|, |dy| in metres and |dtheta| in degrees; NaN without a pose."""
    if pose is None:
        return (np.nan,) * 3
    dx, dy = (abs(float(a - b)) for a, b in zip(pose[:2], true_pose[:2], strict=True))
    return dx, dy, abs(float(np.degrees(wrap_angle(pose.theta - true_pose[2]))))


def is_right(errors: tuple[float, float, float]) -> bool:
    """Whether an error is within half a metre and 10 degrees; False for NaN."""
    return bool(np.hypot(*errors[:2]) <= MAX_ERROR_M and errors[2] <= MAX_TURN_DEG)


def judged(where: tuple, method: str, given: Pose2D | None, best: Pose2D | None, confidence, true_pose, pairs_right):
    """The `Answer` of one pose. where: (seed, experiment, name). best: the most believed pose, be it given or not."""
    errors = pose_errors(given, true_pose)
    kind = UNANSWERED if given is None else CORRECT if is_right(errors) else WRONG
    right = is_right(pose_errors(best, true_pose))
    pairs_right = None if pairs_right is None else bool(given is not None and pairs_right)
    return Answer(*where, method, kind, float(confidence), right, *errors, pairs_right)


def answers_of_rooms(
    rooms: Sequence[dict], methods: Sequence[str] = tuple(ASSOCIATIONS), progress: Callable = iter
) -> list[Answer]:
    """Every pose of every room by every matcher, one view each; none is rejected by its residuals."""
    answers = []
    for room in progress(rooms):
        semantic_map = stored_map(room)
        # The observations are made: of the rig nothing is asked any more.
        localizers = {
            name: SemanticLocalizer(StereoRig(0.3), semantic_map, association=matcher(name), reject_implausible=False)
            for name in methods
        }
        for pose in room["poses"]:
            observations = stored_observations(pose["sources"]["images"])
            truth = pose["sources"]["images"]["true_landmarks"]
            where = (room["seed"], pose["experiment"], pose["name"])
            for name, localizer in localizers.items():
                found = localizer.localize_observations(observations)
                best = found.alternatives[0].pose if found.alternatives else found.pose
                confidence = float(found.pose is not None) if found.confidence is None else found.confidence
                right = all(truth[i] == j for i, j in found.used_pairs)
                answers.append(judged(where, name, found.pose, best, confidence, pose["pose"], right))
    return answers


def answers_of_evidence(
    rooms: Sequence[dict], variants: dict[str, Evidence] = ABLATION, wrong_map: bool = False, progress: Callable = iter
) -> list[Answer]:
    """Localize every pose of every room by the consistent matcher, its evidence switched off in parts.

    wrong_map: look for every room on the map of the next one, where no answer is right.
    """
    answers = []
    for number, room in enumerate(progress(rooms)):
        semantic_map = stored_map(rooms[(number + 1) % len(rooms)] if wrong_map else room)
        for pose in room["poses"]:
            entry = pose["sources"]["images"]
            pairs = zip(stored_observations(entry), entry["true_landmarks"], strict=True)
            kept = [pair for pair in pairs if pair[0].label in semantic_map.labels]
            observations, truth = [one for one, _ in kept], [landmark for _, landmark in kept]
            true_pose = (np.inf, np.inf, 0.0) if wrong_map else pose["pose"]
            for name, evidence in variants.items():
                found = associate_consistent(observations, semantic_map, evidence=evidence)
                best = found.hypotheses[0].pose if found.hypotheses else None
                given = best if found.confidence >= MIN_CONFIDENCE else None
                right = not wrong_map and all(truth[i] == j for i, j in found.pairs)
                where = (room["seed"], pose["experiment"], pose["name"])
                answers.append(judged(where, name, given, best, found.confidence, true_pose, right))
    return answers


def measured_motion(
    start: np.ndarray,
    end: np.ndarray,
    rng: np.random.Generator,
    model: OdometryModel = OdometryModel(),  # noqa: B008 (it cannot change)
) -> Motion:
    """What odometry says of the way between two poses `(3,)` [x, y, theta], with its noise."""
    forward, left = rotations(np.array(start[2])).T @ (np.asarray(end[:2]) - start[:2])
    turn = wrap_angle(end[2] - start[2])
    along = model.distance + model.distance_share * np.hypot(forward, left)
    sigma = np.array([along, along, model.turn + model.turn_share * abs(turn)])
    return Motion(*(np.array([forward, left, turn]) + sigma * rng.standard_normal(3)), np.diag(sigma**2))


def answers_of_sequences(rooms: Sequence[dict], views: Sequence[list[dict]], progress: Callable = iter) -> list[Answer]:
    """Follow every sequence of views (`observe_views`) with odometry and without, and judge the last answer."""
    return [
        answer
        for where, semantic_map, sequence, number in _sequences(rooms, views, progress)
        for answer in followed(where, semantic_map, sequence.poses, sequence.observations, number)
    ]


def answers_of_thinned_sequences(
    rooms: Sequence[dict], views: Sequence[list[dict]], progress: Callable = iter
) -> list[Answer]:
    """Follow the same sequences with `LEFT_OUT` of all observations, after one view, after two, and so on.

    Where one view tells nearly everything, more cannot tell more: this is what they are worth where it does not.
    """
    answers = []
    for where, semantic_map, sequence, number in _sequences(rooms, views, progress):
        rng = np.random.default_rng([THINNING_STREAM, where[0], number])
        seen = [[one for one in view if rng.random() >= LEFT_OUT] for view in sequence.observations]
        for n in range(1, len(seen) + 1):
            for one in followed(where, semantic_map, sequence.poses[:n], seen[:n], number):
                answers.append(one._replace(method=f"{n}_views_{one.method}"))
    return answers


def _sequences(rooms: Sequence[dict], views: Sequence[list[dict]], progress: Callable) -> Iterator[tuple]:
    """(seed, experiment, name), map, sequence, and its number in the room, of every sequence of every room."""
    for room, further in progress(list(zip(rooms, views, strict=True))):
        semantic_map = stored_map(room)
        for number, sequence in enumerate(stored_sequences(room, further)):
            yield (room["seed"], sequence.experiment, sequence.name), semantic_map, sequence, number


def answers_of_places(results: Sequence[PairResult], semantic_map: SemanticMap, experiment: int = 1) -> list[Answer]:
    """The paper's own recording: at every place the rig is turned once, and the two views are followed."""
    answers = []
    for number, (first, second) in enumerate(pairwise(results)):
        start, end = first.pair.pose, second.pair.pose
        if np.hypot(*(end[:2] - start[:2])) < SAME_PLACE:
            observations = [one.localization.observations for one in (first, second)]
            where = (0, experiment, second.pair.name)
            answers += followed(where, semantic_map, np.array([start, end]), observations, number)
    return answers


def followed(where: tuple, semantic_map: SemanticMap, poses: np.ndarray, views: Sequence, number: int) -> list[Answer]:
    """Follow one sequence of views with odometry and without, and judge after the last.

    poses: `(n, 3)` where the rig really stood. views: the observations from each. number: of the sequence in its room.
    """
    answers = []
    for method in ("odometry", "no_odometry"):
        rng = np.random.default_rng([ODOMETRY_STREAM, where[0], number])
        tracker = SemanticTracker(semantic_map)
        for k, observations in enumerate(views):
            known = method == "odometry" and k > 0
            track = tracker.step(observations, measured_motion(poses[k - 1], poses[k], rng) if known else None)
        best = track.alternatives[0][0] if track.alternatives else None
        answers.append(judged(where, method, track.pose, best, track.confidence, poses[-1], None))
    return answers


def answers_table(answers: Sequence[Answer]) -> dict:
    """Shares in percent with their 95 % intervals (Wilson's, and over rooms by bootstrap), and errors when correct."""
    seeds, n = np.array([one.seed for one in answers]), len(answers)
    table: dict = {"n": n}
    for kind in KINDS:
        hits = np.array([one.kind == kind for one in answers])
        table[f"{kind}_percent"] = 100.0 * float(hits.mean())
        table |= share_intervals(kind, hits, seeds)
    for name in ("all_matches_right", "best_is_right"):
        hits = [getattr(one, name) for one in answers]
        known = None not in hits
        table[f"{name}_percent"] = 100.0 * float(np.mean(hits)) if known else None
        table[f"{name}_wilson_percent"] = wilson_percent(sum(hits), n) if known else None
    correct = np.array([one[-4:-1] for one in answers if one.kind == CORRECT]).reshape(-1, 3)
    for statistic, reduce in (("mean", np.mean), ("median", np.median)):
        for column, name in enumerate(("dx_m", "dy_m", "dtheta_deg")):
            table[f"{statistic}_{name}"] = float(reduce(correct[:, column])) if len(correct) else None
    return table


def tables_by_method(answers: Sequence[Answer]) -> dict[str, dict]:
    """`answers_table` of every method, in the order in which they came."""
    return {
        method: answers_table([one for one in answers if one.method == method])
        for method in dict.fromkeys(one.method for one in answers)
    }


def risk_coverage(answers: Sequence[Answer]) -> dict[str, list[float]]:
    """Return what a threshold on the confidence buys: share answered, and of the answered wrong, in percent."""
    confidence = np.array([one.confidence for one in answers])
    wrong = ~np.array([one.best_is_right for one in answers], dtype=bool)
    thresholds = np.unique(confidence[confidence > 0])[::-1]
    given = [confidence >= threshold for threshold in thresholds]
    return {
        "threshold": [float(threshold) for threshold in thresholds],
        "coverage_percent": [100.0 * float(one.mean()) for one in given],
        "risk_percent": [100.0 * float(wrong[one].mean()) for one in given],
    }


def why_not_answered(rooms: Sequence[dict], answers: Sequence[Answer]) -> dict[str, float | None]:
    """Return the mean number of observed landmarks of a pose, by the kind of its answer."""
    seen = {}
    for room in rooms:
        for pose in room["poses"]:
            shown = pose["sources"]["images"]["true_landmarks"]
            seen[room["seed"], pose["experiment"], pose["name"]] = sum(landmark != NO_OBJECT for landmark in shown)
    counts: dict[str, list[int]] = {kind: [] for kind in KINDS}
    for one in answers:
        counts[one.kind].append(seen[one.seed, one.experiment, one.name])
    return {f"{kind}_observations": float(np.mean(found)) if found else None for kind, found in counts.items()}


def answers_summary(
    rooms: Sequence[dict],
    methods: Sequence[str] = tuple(ASSOCIATIONS),
    views: Sequence[list[dict]] | None = None,
    ablation: bool = False,
    progress: Callable = iter,
) -> dict:
    """All of it: one view, several views where there are any, risk over coverage, and the ablation on either map."""
    one_view = answers_of_rooms(rooms, methods, progress=progress)
    found: dict = {"one_view": tables_by_method(one_view)}
    if "consistent" in methods:
        consistent = [one for one in one_view if one.method == "consistent"]
        found["risk_coverage"] = risk_coverage(consistent)
        found["why_unanswered"] = why_not_answered(rooms, consistent)
    if views is not None:
        found["n_views"] = 1 + len(views[0][0]["views"])
        found["several_views"] = tables_by_method(answers_of_sequences(rooms, views, progress))
        found["thinned_views"] = tables_by_method(answers_of_thinned_sequences(rooms, views, progress))
    if ablation:
        found["ablation"] = {
            name: tables_by_method(answers_of_evidence(rooms, ABLATION, wrong_map, progress))
            for name, wrong_map in (("right_map", False), ("wrong_map", True))
        }
    return found


def answer_tables(answers: dict) -> str:
    """Shares in percent with Wilson's 95 % intervals; mean errors of the correct ones."""
    lines = [*_what_is_counted("both heights, from images"), *_group("One view", answers["one_view"])]
    if "several_views" in answers:
        lines += _several(answers)
        lines += _group("Half of all observations left out", answers["thinned_views"])
    for which, tables in answers.get("ablation", {}).items():
        lines += _group(f"Evidence switched off, {which.replace('_', ' ')}", tables)
    return "\n".join(lines)


def views_table(found: dict) -> str:
    """Several views alone: n_views and several_views of a summary."""
    return "\n".join([*_what_is_counted("both experiments, from images"), *_several(found)])


def _what_is_counted(of: str) -> list[str]:
    return [
        f"Answers [%]: correct within {MAX_ERROR_M:g} m and {MAX_TURN_DEG:g} degrees, wrong when given out and "
        f"not; {of};",
        "95 % intervals as if poses were independent; mean errors when correct",
    ]


def _several(found: dict) -> list[str]:
    return _group(f"{found['n_views']} views, consistent", found["several_views"])


def _group(title: str, tables: dict) -> list[str]:
    return ["", title, _line("", HEADS), *(_row(name, table) for name, table in tables.items())]


def _line(name: str, cells: Sequence) -> str:
    return f"  {name:24}" + "".join(f"{cell:>{width}}" for cell, width in zip(cells, WIDTHS, strict=True))


def _row(name: str, table: dict) -> str:
    shares = [_share(table, kind) for kind in KINDS]
    right = _share(table, "all_matches_right") if table["all_matches_right_percent"] is not None else "-"
    errors = [table[f"mean_{error}"] for error in ("dx_m", "dy_m", "dtheta_deg")]
    texts = ["-" if error is None else f"{error:.3f}" for error in errors]
    return _line(name.replace("_", " "), (table["n"], *shares, right, *texts))


def _share(table: dict, kind: str) -> str:
    low, high = table[f"{kind}_wilson_percent"]
    return f"{table[f'{kind}_percent']:.1f} ({low:.1f}-{high:.1f})"
