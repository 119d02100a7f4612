"""Why a pose of the room experiment fails: would it be right with true places, true colours, or a true centroid?"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.experiments.room import PairResult
from course_lib.experiments.room_evaluation import NO_OBJECT, UNABLE, PoseOutcome, outcome, wrong_pairs
from course_lib.lessons.kit.room_observations import in_body_frame
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.semantic_map.association import Observation, PenaltyWeights, penalty
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

CURES = ("true places", "true colours", "true centroid")
"""What a failing pose is given in place of its measurement, one at a time."""


class Thinned(NamedTuple):
    """One pose of which some objects were not seen."""

    found: object
    """`Localization` from the objects that were left."""
    outcome: PoseOutcome
    true_landmarks: tuple[int, ...]
    """Landmark of each observation that was left."""
    true_pose: np.ndarray
    """[x, y, theta], metres and radians."""


def thinned(result: PairResult, keep: Sequence[int], localizer: SemanticLocalizer) -> Thinned:
    """The pose of `result` from the observations `keep` alone, judged by table 2."""
    observations = [result.localization.observations[index] for index in keep]
    landmarks = tuple(result.true_landmarks[index] for index in keep)
    found = localizer.localize_observations(observations)
    return Thinned(found, outcome(found, result.pair.pose, landmarks), landmarks, result.pair.pose)


def randomly_thinned(
    results: Sequence[PairResult],
    localizer: SemanticLocalizer,
    share_seen: float,
    repeats: int,
    rng: np.random.Generator,
) -> list[Thinned]:
    """Every pose `repeats` times, each of its objects seen with probability `share_seen`, by itself."""
    found = []
    for result in results:
        n = len(result.localization.observations)
        for _ in range(repeats):
            found.append(thinned(result, np.flatnonzero(rng.random(n) < share_seen), localizer))
    return found


def greedy_pairs(total: np.ndarray) -> list[tuple[int, int]]:
    """Repeated minimum of a penalty table `(n, m)` until one side is used up (section 2.5)."""
    cost, pairs = total.copy(), []
    for _ in range(min(cost.shape)):
        i, j = (int(k) for k in np.unravel_index(np.argmin(cost), cost.shape))
        pairs.append((i, j))
        cost[i, :] = cost[:, j] = np.inf
    return pairs


def is_matched_rightly(
    observations: Sequence[Observation],
    true_landmarks: Sequence[int],
    true_pose: Sequence[float],
    semantic_map: SemanticMap,
    cure: str | None = None,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008 (it cannot change)
) -> bool:
    """Whether eq. (1) and the greedy search give every pair of like classes rightly, with `cure` (one of `CURES`).

    "true places": each object where the map has it, seen from the true pose. "true colours": the map's own. "true
    centroid": x_G.camera is the map's centroid seen from the true pose, as if every object had been seen. An
    observation of no object keeps what was measured. Raises `ValueError` for another cure.
    """
    if cure is not None and cure not in CURES:
        raise ValueError(f"the cure must be one of {CURES} or None; got {cure!r}")
    labels = np.array([one.label for one in observations], dtype=object)
    places = np.array([[one.x, one.y] for one in observations])
    colours = np.array([[one.hue, one.saturation] for one in observations])
    known = np.array(true_landmarks) != NO_OBJECT
    shown = np.array(true_landmarks)[known]
    if cure == "true places":
        places[known] = in_body_frame(semantic_map.positions[shown], true_pose)
    if cure == "true colours":
        colours[known] = np.column_stack([semantic_map.hues[shown], semantic_map.saturations[shown]])
    centroid = places.mean(axis=0)
    if cure == "true centroid":
        centroid = in_body_frame(semantic_map.centroid[None], true_pose)[0]
    rows = Observation(labels[:, None], *places.T[:, :, None], *colours.T[:, :, None])
    columns = Observation(
        np.array(semantic_map.labels, dtype=object)[None],
        *semantic_map.positions.T[:, None],
        semantic_map.hues[None],
        semantic_map.saturations[None],
    )
    total = penalty(rows, columns, centroid, semantic_map.centroid, weights).total
    return all(true_landmarks[i] == j for i, j in greedy_pairs(total) if labels[i] == semantic_map.labels[j])


def cured_by(failing: Sequence[Thinned | PairResult], semantic_map: SemanticMap) -> dict[str, int]:
    """How many failing poses each cure alone would have mended."""
    counts = dict.fromkeys(CURES, 0)
    for one in failing:
        found, pose = (one.found, one.true_pose) if isinstance(one, Thinned) else (one.localization, one.pair.pose)
        for cure in CURES:
            counts[cure] += is_matched_rightly(found.observations, one.true_landmarks, pose, semantic_map, cure)
    return counts


def rate_of(found: Sequence[Thinned], kind: str) -> float:
    """Percent of the poses that are of a kind of table 2."""
    return 100.0 * float(np.mean([one.outcome.kind == kind for one in found]))


def position_errors(found: Sequence[Thinned], kind: str) -> np.ndarray:
    """Distances of estimate and truth `(n,)`, metres, of the poses of a kind; empty for "unable"."""
    if kind == UNABLE:
        return np.empty(0)
    return np.array([np.hypot(one.outcome.dx_m, one.outcome.dy_m) for one in found if one.outcome.kind == kind])


def failures(result: PairResult, semantic_map: SemanticMap) -> list[str]:
    """What went wrong with one pose, a line each: which observation was taken for which landmark."""
    if result.localization.pose is None:
        return [f"{result.localization.reason}: {result.localization.explanation}"]
    lines = []
    for observation, landmark, shown in wrong_pairs(result.localization, result.true_landmarks):
        label = result.localization.observations[observation].label
        x, y = semantic_map.positions[landmark]
        at = "the {} at ({:.1f}, {:.1f})".format(semantic_map.labels[shown], *semantic_map.positions[shown])
        truth = "nothing" if shown == NO_OBJECT else at
        lines.append(f"the {label} that shows {truth} was taken for the one at ({x:.1f}, {y:.1f})")
    return lines
