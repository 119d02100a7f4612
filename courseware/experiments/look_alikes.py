"""Rooms that look alike: answers within half a metre and 10 degrees, wrong ones given out, and none given.

Here a pose is judged by where it is. The tables also give the paper's measure, all matches right.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.matchers import ASSOCIATIONS
from course_lib.beyond.several_views import Motion, SemanticTracker
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments.intervals import share_intervals, wilson_percent
from courseware.experiments.observed_rooms import judged_poses, stored_map, stored_observations
from courseware.experiments.room_evaluation import NO_OBJECT, pose_errors, statistics_of

KINDS = CORRECT, WRONG, UNANSWERED = "correct", "wrong", "unanswered"
MAX_ERROR_M, MAX_TURN_DEG = 0.5, 10.0
NOWHERE = (np.inf, np.inf, 0.0)  # the true pose on a map of another room
ODOMETRY_STREAM = 0x0D0  # joins a room's seed
THINNING_STREAM = 0x7117  # likewise
MIN_STEP_SIGMA, MIN_TURN_SIGMA = 0.01, float(np.deg2rad(1.0))  # m, radians: of odometry that stands still; chosen
SLIP = 0.05  # share of a step or a turn that is added to it; chosen: wheels slip
LEFT_OUT = 0.5  # share of the observations, drawn one by one; chosen
HEADS = ("n", *KINDS, "all matches right", "dx [m]", "dy [m]", "dtheta [deg]")
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
    all_matches_right: bool | None  # The paper's measure; None if nobody knows what each observation shows


def is_right(errors: tuple[float, float, float]) -> bool:
    """Return whether an error is within half a metre and 10 degrees; False for NaN."""
    return bool(np.hypot(*errors[:2]) <= MAX_ERROR_M and errors[2] <= MAX_TURN_DEG)


def judged(where: tuple, method: str, given: Pose2D | None, best: Pose2D | None, confidence, true_pose, pairs_right):
    """Return the `Answer` of a pose. where: (seed, experiment, name). best: the most believed pose, given or not."""
    errors = pose_errors(given, true_pose)
    kind = UNANSWERED if given is None else CORRECT if is_right(errors) else WRONG
    right = is_right(pose_errors(best, true_pose))
    pairs_right = None if pairs_right is None else bool(given is not None and pairs_right)
    return Answer(*where, method, kind, float(confidence), right, *errors, pairs_right)


def answers_of_rooms(
    rooms: Sequence[dict], associations: dict[str, Callable], wrong_map: bool = False, progress: Callable = iter
) -> list[Answer]:
    """Localize every pose of every room by every matcher, one view each; none is rejected by its residuals.

    wrong_map: look for every room on the map of the next one, where no answer is right.
    """
    methods = {name: {"association": one, "reject_implausible": False} for name, one in associations.items()}
    answers = []
    maps = [*rooms[1:], rooms[0]] if wrong_map else rooms
    for one in judged_poses(progress(rooms), maps, methods, ("images",)):
        found, true_pose = one.localization, NOWHERE if wrong_map else one.pose
        best = found.alternatives[0].pose if found.alternatives else found.pose
        confidence = float(found.pose is not None) if found.confidence is None else found.confidence
        right = not wrong_map and all(one.true_landmarks[i] == j for i, j in found.used_pairs)
        answers.append(judged(one[:3], one.method, found.pose, best, confidence, true_pose, right))
    return answers


def measured_motion(start: np.ndarray, end: np.ndarray, rng: np.random.Generator) -> Motion:
    """Return the motion between two poses `(3,)` [x, y, theta] as odometry measures it, with noise."""
    forward, left = rotation_2d(start[2]).T @ (np.asarray(end[:2]) - start[:2])
    turn = wrap_angle(end[2] - start[2])
    along = MIN_STEP_SIGMA + SLIP * np.hypot(forward, left)
    sigma = np.array([along, along, MIN_TURN_SIGMA + SLIP * abs(turn)])
    return Motion(*(np.array([forward, left, turn]) + sigma * rng.standard_normal(3)), np.diag(sigma**2))


def answers_of_sequences(
    rooms: Sequence[dict], views: Sequence[list[dict]], thinned: bool = False, progress: Callable = iter
) -> list[Answer]:
    """Follow every sequence of views (`observe_views`) with odometry and without, and judge the last answer.

    thinned: without `LEFT_OUT` of all observations, after one view, after two, and so on.
    """
    answers = []
    for room, further in progress(list(zip(rooms, views, strict=True))):
        semantic_map = stored_map(room)
        first = {(pose["experiment"], pose["name"]): pose for pose in room["poses"]}
        for number, entry in enumerate(further):
            where = (room["seed"], entry["experiment"], entry["name"])
            pose = first[where[1:]]
            poses = np.array([pose["pose"], *(view["pose"] for view in entry["views"])])
            seen = [stored_observations(one) for one in (pose["sources"]["images"], *entry["views"])]
            rng = np.random.default_rng([THINNING_STREAM, room["seed"], number])
            if thinned:
                seen = [[one for one in view if rng.random() >= LEFT_OUT] for view in seen]
            for n in range(1 if thinned else len(seen), len(seen) + 1):
                found = followed(where, semantic_map, poses[:n], seen[:n], number)
                answers += [one._replace(method=f"{n}_views_{one.method}") for one in found] if thinned else found
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
    """Return shares in percent with 95 % intervals (Wilson's, and over rooms by bootstrap), and errors when correct."""
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
    return table | statistics_of(correct, mean=np.mean, median=np.median)


def tables_by_method(answers: Sequence[Answer]) -> dict[str, dict]:
    """Return the `answers_table` of every method, in the order in which they came."""
    methods = dict.fromkeys(one.method for one in answers)
    return {method: answers_table([one for one in answers if one.method == method]) for method in methods}


def risk_coverage(answers: Sequence[Answer]) -> dict[str, list[float]]:
    """Return what a threshold on the confidence buys: share answered, and of the answered wrong, in percent."""
    confidence = np.array([one.confidence for one in answers])
    wrong = ~np.array([one.best_is_right for one in answers], dtype=bool)
    thresholds = np.unique(confidence[confidence > 0])[::-1]
    given = [confidence >= threshold for threshold in thresholds]
    coverage, risk = ([100.0 * float(one.mean()) for one in told] for told in (given, [wrong[one] for one in given]))
    return {"threshold": thresholds.tolist(), "coverage_percent": coverage, "risk_percent": risk}


def why_not_answered(rooms: Sequence[dict], answers: Sequence[Answer]) -> dict[str, float | None]:
    """Return the mean number of observed landmarks of a pose, by the kind of its answer (`answers_of_rooms`)."""
    counts: dict[str, list[int]] = {kind: [] for kind in KINDS}
    poses = (pose for room in rooms for pose in room["poses"])
    for pose, one in zip(poses, answers, strict=True):
        shown = pose["sources"]["images"]["true_landmarks"]
        counts[one.kind].append(sum(landmark != NO_OBJECT for landmark in shown))
    return {f"{kind}_observations": float(np.mean(found)) if found else None for kind, found in counts.items()}


def answers_summary(
    rooms: Sequence[dict],
    methods: Sequence[str],
    views: Sequence[list[dict]] | None = None,
    ablation: bool = False,
    progress: Callable = iter,
) -> dict:
    """Return one view, several views if there are any, risk over coverage, and the ablation on either map."""
    one_view = answers_of_rooms(rooms, {name: ASSOCIATIONS[name] for name in methods}, progress=progress)
    found: dict = {"one_view": tables_by_method(one_view)}
    if "consistent" in methods:
        consistent = [one for one in one_view if one.method == "consistent"]
        found["risk_coverage"] = risk_coverage(consistent)
        found["why_unanswered"] = why_not_answered(rooms, consistent)
    if views is not None:
        found["n_views"] = 1 + len(views[0][0]["views"])
        for name, thinned in (("several_views", False), ("thinned_views", True)):
            found[name] = tables_by_method(answers_of_sequences(rooms, views, thinned, progress))
    if ablation:
        variants = {name: partial(associate_consistent, evidence=one) for name, one in ABLATION.items()}
        found["ablation"] = {}
        for name, wrong_map in (("right_map", False), ("wrong_map", True)):
            found["ablation"][name] = tables_by_method(answers_of_rooms(rooms, variants, wrong_map, progress))
    return found


def answer_tables(answers: dict) -> str:
    """Return a table of shares in percent with Wilson's 95 % intervals, and mean errors of the correct answers."""
    groups = {"One view": answers["one_view"]}
    if "several_views" in answers:
        groups[f"{answers['n_views']} views, consistent"] = answers["several_views"]
        groups["Half of all observations left out"] = answers["thinned_views"]
    for which, tables in answers.get("ablation", {}).items():
        groups[f"Evidence switched off, {which.replace('_', ' ')}"] = tables
    lines = [
        f"Answers [%]: correct within {MAX_ERROR_M:g} m and {MAX_TURN_DEG:g} degrees, wrong when given out and not; "
        "both heights, from images;",
        "95 % intervals as if poses were independent; mean errors when correct",
    ]
    for title, tables in groups.items():
        lines += ["", title, _line("", HEADS), *(_row(name, table) for name, table in tables.items())]
    return "\n".join(lines)


def _line(name: str, cells: Sequence) -> str:
    return f"  {name:24}" + "{:>5}{:>20}{:>18}{:>20}{:>22}{:>9}{:>9}{:>14}".format(*cells)


def _row(name: str, table: dict) -> str:
    shares = [(table[f"{kind}_percent"], table[f"{kind}_wilson_percent"]) for kind in (*KINDS, "all_matches_right")]
    told = ["-" if share is None else f"{share:.1f} ({ends[0]:.1f}-{ends[1]:.1f})" for share, ends in shares]
    errors = [table[f"mean_{error}"] for error in ("dx_m", "dy_m", "dtheta_deg")]
    texts = ["-" if error is None else f"{error:.3f}" for error in errors]
    return _line(name.replace("_", " "), (table["n"], *told, *texts))
