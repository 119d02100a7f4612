"""How the greedy matcher does on the room: with other weights, and with objects hidden."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.experiments.intervals import bootstrap_percent
from course_lib.lessons.kit.room_observations import room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.spherical_stereo.detection.detected_object import canonical_label
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d
from course_lib.spherical_stereo.semantic_map.association import (
    Observation,
    PenaltyWeights,
    associate_greedy,
    penalty_table,
)
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

PAIR = "03_b"  # thirteen of fourteen objects in view, nothing special (chosen)
SOFAS = (0, 1, 2)  # their lines in the map


def min_object_weight(
    observations: Sequence[Observation],
    semantic_map: SemanticMap,
    weights: PenaltyWeights = PenaltyWeights(),  # noqa: B008
    distance_term: str = "absolute",
) -> float:
    """Return the p_obj above which no pair of unlike classes is cheaper than one of like classes, here.

    p_obj > max over like pairs - min over unlike pairs, of the sum of the other three terms. No p_obj is large enough
    for all worlds, because the distance term has no upper limit.
    """
    table = penalty_table(observations, semantic_map, weights, distance_term)
    others = table.hue + table.saturation + table.distance
    seen = np.array([canonical_label(one.label) for one in observations])
    like = seen.reshape(-1, 1) == np.array(semantic_map.labels)[None]
    if not like.any() or like.all():
        return 0.0
    return max(0.0, float(others[like].max() - others[~like].min()))


class Score(NamedTuple):
    """How a matcher did on all pairs of photographs of an experiment."""

    poses_right: int
    """Pairs of photographs in which every observation got its landmark."""
    poses: int
    pairs_right: int
    pairs: int
    sofas_right: int
    sofas: int
    unlike: int
    """Pairs of unlike classes."""


class HiddenScore(NamedTuple):
    """How the matcher did with some of the objects hidden at random."""

    percent_right: float
    """Percent of the trials in which every observation got its landmark."""
    interval_percent: list[float]
    """95 % interval of it, by the bootstrap over the pairs of photographs: trials with one of them are no new ones."""
    wrong: int
    """Wrong pairs in all trials."""
    wrong_sofas: int
    """Of them, those that took a sofa for another."""
    error_right: float
    """Metres: median error of the fitted position where all pairs were right."""
    error_wrong: float
    """Metres: the same where not."""


def score(weights: PenaltyWeights, distance_term: str = "absolute") -> Score:
    """The greedy matcher with these weights on the twenty pairs of photographs of experiment 1."""
    poses_right = pairs_right = pairs = sofas_right = sofas = unlike = 0
    scenes = room_scenes().values()
    for scene in scenes:
        found = associate_greedy(scene.observations, room_map(), weights, distance_term)
        right = [scene.true_landmarks[i] == j for i, j in found.pairs]
        of_sofas = [one for one, (i, _) in zip(right, found.pairs, strict=True) if scene.true_landmarks[i] in SOFAS]
        poses_right += all(right)
        pairs_right, pairs = pairs_right + sum(right), pairs + len(right)
        sofas_right, sofas = sofas_right + sum(of_sofas), sofas + len(of_sofas)
        unlike += len(found.pairs) - len(found.usable_pairs)
    return Score(poses_right, len(scenes), pairs_right, pairs, sofas_right, sofas, unlike)


def hidden_score(n_hidden: int, n_trials: int, rng: np.random.Generator) -> HiddenScore:
    """The matcher where `n_hidden` of the objects in view, drawn at random, stay unseen; n_trials a photograph pair."""
    right_trials, wrong_pairs, wrong_sofas = np.zeros((len(room_scenes()), n_trials)), 0, 0
    errors: dict[bool, list[float]] = {True: [], False: []}
    for number, scene in enumerate(room_scenes().values()):
        for trial in range(n_trials):
            kept = np.sort(rng.permutation(len(scene.observations))[n_hidden:])
            seen = [scene.observations[k] for k in kept]
            pairs = associate_greedy(seen, room_map()).usable_pairs
            wrong = [j for i, j in pairs if scene.true_landmarks[kept[i]] != j]
            right_trials[number, trial] = not wrong
            wrong_pairs += len(wrong)
            wrong_sofas += sum(j in SOFAS for j in wrong)
            pose = fitted_pose(seen, pairs)
            if pose is not None:
                errors[not wrong].append(float(np.hypot(pose.x - scene.pose.x, pose.y - scene.pose.y)))
    medians = (float(np.median(errors[kind])) if errors[kind] else np.nan for kind in (True, False))
    interval = bootstrap_percent(right_trials.mean(axis=1))
    return HiddenScore(100 * float(right_trials.mean()), interval, wrong_pairs, wrong_sofas, *medians)


class TwoSearches(NamedTuple):
    """The repeated minimum and the least sum of penalties on the same observations."""

    greedy_percent: float
    """Percent of the trials in which the repeated minimum got every pair right."""
    least_sum_percent: float
    gain_percent: list[float]
    """95 % interval of the second minus the first, by the bootstrap over the pairs of photographs."""
    same_percent: float
    """Percent of the trials in which both searches gave the same pairs."""


def two_searches(n_hidden: int, n_trials: int, rng: np.random.Generator) -> TwoSearches:
    """Both searches where `n_hidden` objects in view, drawn at random, stay unseen; n_trials a pair of photographs."""
    right = np.zeros((2, len(room_scenes()), n_trials))
    same = 0
    for number, scene in enumerate(room_scenes().values()):
        for trial in range(n_trials):
            kept = np.sort(rng.permutation(len(scene.observations))[n_hidden:])
            found = associate_greedy([scene.observations[k] for k in kept], room_map())
            rows, columns = linear_sum_assignment(found.table.total)
            answers = set(found.pairs), set(zip(rows.tolist(), columns.tolist(), strict=True))
            true = {(row, scene.true_landmarks[k]) for row, k in enumerate(kept)}
            right[:, number, trial] = [answer == true for answer in answers]
            same += answers[0] == answers[1]
    gain = bootstrap_percent(np.diff(right.mean(axis=2), axis=0)[0])
    return TwoSearches(*(100 * right.mean(axis=(1, 2))), gain, 100 * same / right[0].size)


def fitted_pose(observations: list[Observation], pairs: tuple) -> Pose2D | None:
    """The pose that these pairs give (lesson 16), or None where they give none."""
    source = np.array([[observations[i].x, observations[i].y] for i, _ in pairs]).reshape(-1, 2)
    try:
        return fit_rigid_2d(source, room_map().positions[[j for _, j in pairs]])
    except RigidFitError:
        return None
