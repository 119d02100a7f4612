"""How the matchers do on the room's 20 pairs of photographs when not everything is seen, and on a map that is wrong."""

from collections.abc import Callable

import numpy as np

from course_lib.beyond.look_alikes.consistent import assign, associate_consistent, match_costs
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.hypotheses import PairPoses, fit_poses, pair_poses, scene_of
from course_lib.beyond.look_alikes.matchers import associate_hungarian
from course_lib.beyond.several_views import SemanticTracker
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, fit_rigid_2d
from courseware.experiments.look_alikes import KINDS, NOWHERE, Answer, judged, measured_motion
from courseware.lessons.kit.progress_bar import progress
from courseware.lessons.kit.room_data import MatchingScene, room_map, room_scenes
from courseware.lessons.lesson_18.scenes import half_seen


def localizer_of(association: Callable, semantic_map=None) -> SemanticLocalizer:
    semantic_map = semantic_map or room_map()
    return SemanticLocalizer(StereoRig(0.3), semantic_map, association=association, reject_implausible=False)


def matched_by_colour(scene: MatchingScene) -> tuple[Pose2D, tuple]:
    """Return the pose after the assignment of least cost on class and colour, and its pairs (observation, landmark)."""
    found = localizer_of(associate_hungarian).localize_observations(scene.observations)
    return found.pose, found.used_pairs


def matched_by_two(scene: MatchingScene, landmarks: tuple[int, int]) -> tuple[Pose2D, tuple, np.ndarray]:
    """Return the pose of the right matches of two landmarks, the pairs that it then finds, and the two observations."""
    arrays = scene_of(scene.observations, room_map())
    two = pair_poses(arrays)
    k = np.flatnonzero(both_right(two, scene) & (np.sort(two.landmarks) == landmarks).all(axis=1))[-1]
    cost = match_costs(arrays, two.poses[k : k + 1], two.covariances[k : k + 1], Evidence())[0][0]
    return Pose2D(*two.poses[k]), assign(cost), two.observations[k]


def both_right(two: PairPoses, scene: MatchingScene) -> np.ndarray:
    """Return whether both matches of every pair are right: `(h,)` bool."""
    return (np.array(scene.true_landmarks)[two.observations] == two.landmarks).all(axis=1)


def fit_errors() -> dict[str, np.ndarray]:
    """Return name of a fit -> distances `(20,)`, metres, from the true place; both fits get the true pairs.

    "plain": `fit_rigid_2d`, the paper's, every error counted alike. "weighed": `fit_poses`, by the stereo covariance.
    """
    off: dict[str, list] = {"plain": [], "weighed": []}
    for scene in room_scenes().values():
        arrays, targets = scene_of(scene.observations, room_map()), room_map().positions[list(scene.true_landmarks)]
        plain = np.array(fit_rigid_2d(arrays.places, targets))[None]
        weighed = fit_poses(plain, arrays.places[None], targets[None], arrays.covariances[None])[0]
        for name, (pose,) in zip(off, (plain, weighed), strict=True):
            off[name].append(np.hypot(*(pose - scene.pose)[:2]))
    return {name: np.array(distances) for name, distances in off.items()}


def answers_of(scenes: dict, association: Callable = associate_consistent, semantic_map=None) -> list[Answer]:
    """Return what a matcher answers to each scene, judged: 0.5 m and 10 degrees. On another map no answer is right."""
    localizer, answers = localizer_of(association, semantic_map), []
    for name, scene in scenes.items():
        found = localizer.localize_observations(scene.observations)
        best = found.alternatives[0].pose if found.alternatives else found.pose
        confidence = float(found.pose is not None) if found.confidence is None else found.confidence
        right = all(scene.true_landmarks[i] == j for i, j in found.used_pairs)
        truth = scene.pose if localizer.semantic_map is room_map() else NOWHERE
        answers.append(judged((0, 1, name), "", found.pose, best, confidence, truth, right))
    return answers


def answers_of_two_views(draws: int) -> list[Answer]:
    """Return what is answered at every place of the room to two half-seen views, the rig turned between them.

    Methods "one view" and "two views, odometry"; odometry with its noise.
    """
    rng, scenes, answers = np.random.default_rng(18), room_scenes(), []
    places = [name[:-2] for name in scenes if name.endswith("_a") for _ in range(draws)]
    for place in progress(places, "places"):
        both = [scenes[f"{place}_{turn}"] for turn in "ab"]
        tracker = SemanticTracker(room_map())
        for k, method in enumerate(("one view", "two views, odometry")):
            motion = measured_motion(*(np.array(one.pose) for one in both), rng) if k else None
            track = tracker.step(half_seen(both[k], rng).observations, motion)
            best = track.alternatives[0][0] if track.alternatives else None
            answers.append(judged((0, 1, place), method, track.pose, best, track.confidence, both[k].pose, None))
    return answers


def shares_line(name: str, table: dict, width: int = 22) -> str:
    """Return one row of a printed table: correct, wrong and unanswered in percent, each with Wilson's 95 % interval."""
    cells = []
    for kind in KINDS:
        low, high = table[f"{kind}_wilson_percent"]
        cells.append(f"{kind} {table[f'{kind}_percent']:5.1f} ({low:4.1f} to {high:5.1f})")
    return f"{name:{width}} {', '.join(cells)} %"
