"""How the greedy matcher does on the room: with other weights, and with objects hidden."""

import contextlib
from collections import namedtuple
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.optimize import linear_sum_assignment

from course_lib.spherical_stereo.pose.rigid_fit import RigidFitError, fit_rigid_2d
from course_lib.spherical_stereo.semantic_map.association import PenaltyWeights, associate_greedy, penalty_table
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments.intervals import bootstrap_percent
from courseware.lessons.kit.room_data import MatchingScene, room_map, room_scenes

PAIR = "03_b"  # thirteen of fourteen objects in view, nothing special (chosen)
SOFAS = (0, 1, 2)  # their lines in the map

Score = namedtuple("Score", "poses_right poses pairs_right pairs sofas_right sofas")
HiddenScore = namedtuple("HiddenScore", "percent_right interval_percent wrong wrong_sofas error_right error_wrong")
TwoSearches = namedtuple("TwoSearches", "greedy_percent least_sum_percent gain_percent same_percent")


def min_object_weight(
    observations: Sequence, semantic_map: SemanticMap, weights: PenaltyWeights, term: str = "absolute"
) -> float:
    """Return the p_obj above which no pair of unlike classes is cheaper than one of like classes, here.

    p_obj > max over like pairs - min over unlike pairs, of the sum of the other three terms. No p_obj is large enough
    for all worlds, because the distance term has no upper limit. weights: its own p_obj must be above 0.
    """
    table = penalty_table(observations, semantic_map, weights, term)
    others, like = table.hue + table.saturation + table.distance, table.object == 0
    return max(0.0, float(others[like].max() - others[~like].min()))


def score(weights: PenaltyWeights, distance_term: str = "absolute") -> Score:
    """Return how many poses, pairs and sofas the greedy matcher gets right on the pairs of photographs. A pose is
    right if every observation got its landmark.
    """
    scenes = room_scenes().values()
    found = [associate_greedy(scene.observations, room_map(), weights, distance_term).pairs for scene in scenes]
    shown = np.array([scene.true_landmarks[i] for scene, pairs in zip(scenes, found, strict=True) for i, _ in pairs])
    right, is_sofa = shown == [j for pairs in found for _, j in pairs], np.isin(shown, SOFAS)
    wrong_poses = set(np.repeat(range(len(found)), [len(pairs) for pairs in found])[~right])
    poses = len(found) - len(wrong_poses), len(found)
    return Score(*poses, right.sum(), right.size, right[is_sofa].sum(), is_sofa.sum())


def hidden_trials(n_hidden: int, n_trials: int, rng: np.random.Generator) -> Iterator[tuple[MatchingScene, np.ndarray]]:
    """Yield each scene n_trials times with the indices of its observations, but without `n_hidden` random ones."""
    for scene in room_scenes().values():
        for _ in range(n_trials):
            yield scene, np.sort(rng.permutation(len(scene.observations))[n_hidden:])


def hidden_score(n_hidden: int, n_trials: int, rng: np.random.Generator) -> HiddenScore:
    """Return how the greedy matcher does in `hidden_trials`: percent of the trials with all pairs right, and its 95 %
    interval by the bootstrap over the photographs; wrong pairs, and sofas among them; median errors of place [m] of
    the pose that the pairs give (lesson 16), where all pairs were right and where not.
    """
    right, wrong, errors = [], [], {True: [], False: []}
    for scene, kept in hidden_trials(n_hidden, n_trials, rng):
        seen = [scene.observations[k] for k in kept]
        pairs = associate_greedy(seen, room_map()).usable_pairs
        mistaken = [j for i, j in pairs if scene.true_landmarks[kept[i]] != j]
        right.append(not mistaken)
        wrong += mistaken
        with contextlib.suppress(RigidFitError):  # some pairs give no pose
            pose = fit_rigid_2d([seen[i][1:3] for i, _ in pairs], room_map().positions[[j for _, j in pairs]])
            errors[not mistaken].append(np.hypot(pose.x - scene.pose.x, pose.y - scene.pose.y))
    interval = bootstrap_percent(np.reshape(right, (-1, n_trials)).mean(axis=1))
    medians = [np.median(errors[kind] or np.nan) for kind in (True, False)]
    return HiddenScore(100 * np.mean(right), interval, len(wrong), np.isin(wrong, SOFAS).sum(), *medians)


def two_searches(n_hidden: int, n_trials: int, rng: np.random.Generator) -> TwoSearches:
    """Return in how many percent of the `hidden_trials` the repeated minimum, and the least sum, got every pair right;
    the 95 % interval of the gain, by the bootstrap over the photographs; in how many percent both found the same.
    """
    right, same = [], []
    for scene, kept in hidden_trials(n_hidden, n_trials, rng):
        found = associate_greedy([scene.observations[k] for k in kept], room_map())
        greedy, least = set(found.pairs), set(zip(*linear_sum_assignment(found.table.total), strict=True))
        true = {(row, scene.true_landmarks[k]) for row, k in enumerate(kept)}
        right.append([greedy == true, least == true])
        same.append(greedy == least)
    shares = np.reshape(right, (-1, n_trials, 2)).mean(axis=1)
    gain = bootstrap_percent(shares[:, 1] - shares[:, 0])
    return TwoSearches(*100 * shares.mean(axis=0), gain, 100 * np.mean(same))
