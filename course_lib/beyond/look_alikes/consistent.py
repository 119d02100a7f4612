"""Rooms that look alike: the poses that everything seen agrees on, how sure the best is, and which others there are.

hypotheses (every two matches give a pose) -> score (one-to-one assignment, unmatched allowed) -> refit -> the best few
distinct poses -> confidence. Beyond the paper, whose own `associate_greedy` asks for no pose.
"""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.beyond.look_alikes.confidence import (
    MIN_CONFIDENCE,
    confidence_of,
    score_of_nothing,
    why_unable,
    with_shares,
)
from course_lib.beyond.look_alikes.evidence import (
    CLUTTER_DENSITY,
    Evidence,
    colour_costs,
    detection_probabilities,
    free_space_costs,
    place_distances,
)
from course_lib.beyond.look_alikes.hypotheses import PoseHypothesis, Scene, fit_poses, pair_poses, scene_of
from course_lib.geometry import wrap_angle
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D
from course_lib.spherical_stereo.semantic_map import association
from course_lib.spherical_stereo.semantic_map.association import Association, Observation, PenaltyWeights
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SAME_POSE_M, SAME_POSE_RAD = 0.5, np.deg2rad(10.0)  # metres, radians: two poses that are nearer are one answer
SHORT_LIST = 30  # Distinct poses that are assigned and refitted.
ALTERNATIVES = 3  # Poses that an answer keeps besides the best one.
ROUNDS = 2  # Assignments and refits in turn. The second changes few pairs, a third changed none that mattered.


def rank_poses(
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    evidence: Evidence = Evidence(),  # noqa: B008 (it cannot change)
    n: int = 1 + ALTERNATIVES,
) -> tuple[PoseHypothesis, ...]:
    """Return the n best distinct poses, best first, each with its share of the belief; () if no two matches agree."""
    scene = scene_of(observations, semantic_map)
    if not evidence.stereo_covariance:
        mean = np.trace(scene.covariances, axis1=1, axis2=2).mean() / 2 if len(observations) else 1.0
        scene = scene._replace(covariances=np.tile(mean * np.eye(2), (len(observations), 1, 1)))
    found = pair_poses(scene)
    if not len(found.poses):
        return ()
    first = quick_scores(scene, found.poses, found.covariances, evidence)
    chosen = distinct(found.poses, first, SHORT_LIST)
    ranked = explain(scene, found.poses[chosen], found.covariances[chosen], evidence)
    if not ranked:
        return ()
    kept = distinct(np.array([one.pose for one in ranked]), np.array([one.score for one in ranked]), len(ranked))
    ranked = [ranked[k] for k in kept]
    nothing = len(observations) * score_of_nothing(semantic_map) if evidence.absolute else None
    return with_shares(ranked, nothing)[:n]


def associate_consistent(
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008
    distance_term: str = "absolute",
    evidence: Evidence = Evidence(),  # noqa: B008
    min_confidence: float = MIN_CONFIDENCE,
) -> Association:
    """Return the pairs of the pose that explains everything best, that pose, its alternatives, and how sure it is.

    Called as `associate_greedy`; weights and distance_term serve for the table only. Below min_confidence, `reason` and
    `explanation` say why the pose should not be given out.
    """
    if not 0 <= min_confidence <= 1:
        raise ValueError(f"min_confidence must lie between 0 and 1; got {min_confidence!r}")
    table = association.penalty_table(observations, semantic_map, weights, distance_term)
    ranked = rank_poses(observations, semantic_map, evidence)
    pairs = ranked[0].pairs if ranked else ()
    confidence = confidence_of(ranked[0], evidence) if ranked else 0.0
    others = ", ".join(
        f"({one.pose.x:.2f}, {one.pose.y:.2f}) m at {np.degrees(one.pose.theta):.0f} degrees ({one.share:.0%})"
        for one in ranked
    )
    return association.association_of(pairs, observations, semantic_map, table)._replace(
        hypotheses=ranked,
        confidence=confidence,
        reason=why_unable(len(ranked), len(pairs), confidence, min_confidence),
        explanation=f"confidence {confidence:.2f}, {min_confidence:.2f} is asked for"
        + (f"; poses: {others}" if others else ""),
    )


def match_costs(
    scene: Scene, poses: np.ndarray, covariances: np.ndarray | None, evidence: Evidence
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return costs `(h, n, m)` of every match against no match, base `(h,)`, and chances to be seen."""
    squared, log_size = place_distances(scene, poses, covariances)
    cost = squared / 2 + log_size[..., None] / 2 + np.log(2 * np.pi) + np.log(CLUTTER_DENSITY)
    if evidence.colour:
        cost = cost + colour_costs(scene)
    base = free_space_costs(scene.semantic_map, poses) if evidence.free_space else np.zeros(len(poses))
    chance = detection_probabilities(scene.semantic_map, poses)
    if evidence.negative:
        cost = cost - np.log(chance / (1 - chance))[:, None]
        base = base - np.log(1 - chance).sum(axis=1)
    return np.where(scene.like, cost, np.inf), base, chance


def quick_scores(scene: Scene, poses: np.ndarray, covariances: np.ndarray, evidence: Evidence) -> np.ndarray:
    """Return upper bounds `(h,)` of the scores of many poses: every observation takes the landmark it likes best."""
    cost, base, _ = match_costs(scene, poses, covariances, evidence)
    return -np.minimum(cost.min(axis=2), 0.0).sum(axis=1) - base


def assign(cost: np.ndarray, one_to_one: bool = True) -> tuple[tuple[int, int], ...]:
    """Return the one-to-one pairs of least total cost `(n, m)`. A pair that costs more than 0 is left unmatched."""
    if not one_to_one:
        best = cost.argmin(axis=1)
        return tuple((i, int(j)) for i, j in enumerate(best) if cost[i, j] < 0)
    gains = np.minimum(cost, 0.0)
    return tuple((int(i), int(j)) for i, j in zip(*linear_sum_assignment(gains), strict=True) if gains[i, j] < 0)


def explain(scene: Scene, poses: np.ndarray, covariances: np.ndarray, evidence: Evidence) -> list[PoseHypothesis]:
    """Return a hypothesis for each pose `(h, 3)` with its covariance `(h, 3, 3)`: assigned, refitted and scored.

    A pose that explains fewer than two observations is left out.
    """
    poses, spread = np.asarray(poses, dtype=np.float64), covariances
    for _ in range(ROUNDS if evidence.refit else 0):
        cost = match_costs(scene, poses, spread, evidence)[0]
        pairs = [assign(one, evidence.one_to_one) for one in cost]
        enough = [k for k, one in enumerate(pairs) if len(one) >= 2]
        if not enough:
            return []
        poses, spread = refit(scene, poses[enough], [pairs[k] for k in enough])
    # A refitted pose has no error of its own, because it comes from its matches, whose noise is counted already.
    cost, base, chance = match_costs(scene, poses, None if evidence.refit else spread, evidence)
    squared, _ = place_distances(scene, poses, None if evidence.refit else spread)
    explained = []
    for k, pose in enumerate(poses):
        pairs = assign(cost[k], evidence.one_to_one)
        if len(pairs) < 2:
            continue
        i, j = np.array(pairs).T
        score, chi_square = float(-cost[k][i, j].sum() - base[k]), float(squared[k][i, j].sum())
        missed = sorted(set(map(int, np.flatnonzero(chance[k] > 0.5))) - set(map(int, j)))
        pose = Pose2D(*map(float, pose))
        explained.append(PoseHypothesis(pose, spread[k], pairs, score, chi_square, tuple(missed)))
    return explained


def refit(scene: Scene, poses: np.ndarray, pairs: Sequence[tuple[tuple[int, int], ...]]) -> tuple:
    """Fit each pose `(h, 3)` to its own pairs, weighted by their observations' covariances: poses, covariances."""
    landmark = np.zeros((len(poses), len(scene.places)), dtype=int)
    used = np.zeros(landmark.shape, dtype=bool)
    for k, one in enumerate(pairs):
        i, j = np.array(one).T
        landmark[k, i], used[k, i] = j, True
    targets = scene.semantic_map.positions[landmark]
    return fit_poses(poses, scene.places[None], targets, scene.covariances[None], used)


def distinct(poses: np.ndarray, scores: np.ndarray, n: int) -> list[int]:
    """Return indices of the n best poses `(h, 3)` of which no two are one answer, best first."""
    chosen: list[int] = []
    left = np.isfinite(scores) & np.isfinite(poses).all(axis=1)
    while left.any() and len(chosen) < n:
        k = int(np.argmax(np.where(left, scores, -np.inf)))
        chosen.append(k)
        near = np.hypot(*(poses[:, :2] - poses[k, :2]).T) < SAME_POSE_M
        left &= ~(near & (np.abs(wrap_angle(poses[:, 2] - poses[k, 2])) < SAME_POSE_RAD))
        left[k] = False
    return chosen
