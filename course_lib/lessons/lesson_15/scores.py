"""How the greedy matcher does on the room: with other weights, and with objects hidden."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from course_lib.lessons.kit.room_observations import room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, RigidFitError, fit_rigid_2d
from course_lib.spherical_stereo.semantic_map.association import Observation, PenaltyWeights, associate_greedy

PAIR = "03_b"  # thirteen of fourteen objects in view, nothing special (chosen)
SOFAS = (0, 1, 2)  # their lines in the map


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

    share_right: float
    """Share of trials in which every observation got its landmark."""
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
    right_trials, wrong_pairs, wrong_sofas = [], 0, 0
    errors: dict[bool, list[float]] = {True: [], False: []}
    for scene in room_scenes().values():
        for _ in range(n_trials):
            kept = np.sort(rng.permutation(len(scene.observations))[n_hidden:])
            seen = [scene.observations[k] for k in kept]
            pairs = associate_greedy(seen, room_map()).usable_pairs
            wrong = [j for i, j in pairs if scene.true_landmarks[kept[i]] != j]
            right_trials.append(not wrong)
            wrong_pairs += len(wrong)
            wrong_sofas += sum(j in SOFAS for j in wrong)
            pose = fitted_pose(seen, pairs)
            if pose is not None:
                errors[not wrong].append(float(np.hypot(pose.x - scene.pose.x, pose.y - scene.pose.y)))
    medians = (float(np.median(errors[kind])) if errors[kind] else np.nan for kind in (True, False))
    return HiddenScore(float(np.mean(right_trials)), wrong_pairs, wrong_sofas, *medians)


def fitted_pose(observations: list[Observation], pairs: tuple) -> Pose2D | None:
    """The pose that these pairs give (lesson 16), or None where they give none."""
    source = np.array([[observations[i].x, observations[i].y] for i, _ in pairs]).reshape(-1, 2)
    try:
        return fit_rigid_2d(source, room_map().positions[[j for _, j in pairs]])
    except RigidFitError:
        return None
