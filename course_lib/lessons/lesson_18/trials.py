"""How the matchers do on the room's 20 pairs of photographs when not everything is seen, and on a map that is wrong."""

from collections.abc import Sequence

import numpy as np

from course_lib.beyond.look_alikes.confidence import MIN_CONFIDENCE
from course_lib.beyond.look_alikes.consistent import associate_consistent
from course_lib.beyond.look_alikes.evidence import Evidence
from course_lib.beyond.look_alikes.matchers import ASSOCIATIONS
from course_lib.beyond.several_views import SemanticTracker
from course_lib.experiments.look_alikes import (
    Answer,
    is_right,
    judged,
    measured_motion,
    pose_errors,
)
from course_lib.lessons.kit.progress_bar import progress
from course_lib.lessons.kit.room_observations import MatchingScene, room_scenes
from course_lib.lessons.kit.room_photographs import room_map
from course_lib.lessons.lesson_18.scenes import half_seen, mirrored, thinned
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D

NOWHERE = (np.inf, np.inf, 0.0)  # the true pose on a map of another room
GAP_ALONE = Evidence(absolute=False)


def half_seen_scenes(draws: int, rng: np.random.Generator) -> list[tuple[str, MatchingScene]]:
    """Every pair of photographs `draws` times, each time with half of its objects left out at random."""
    return [(name, half_seen(scene, rng)) for name, scene in room_scenes().items() for _ in range(draws)]


def answers_of_matchers(scenes: list[tuple[str, MatchingScene]]) -> list[Answer]:
    """What each matcher answers to each scene, judged: 0.5 m and 10 degrees."""
    localizers = {
        name: SemanticLocalizer(StereoRig(0.3), room_map(), association=matcher, reject_implausible=False)
        for name, matcher in ASSOCIATIONS.items()
    }
    answers = []
    for name, scene in progress(scenes, "half-seen views"):
        for matcher, localizer in localizers.items():
            found = localizer.localize_observations(scene.observations)
            best = found.alternatives[0].pose if found.alternatives else found.pose
            confidence = float(found.pose is not None) if found.confidence is None else found.confidence
            right = all(scene.true_landmarks[i] == j for i, j in found.used_pairs)
            answers.append(judged((0, 1, name), matcher, found.pose, best, confidence, scene.pose, right))
    return answers


def answers_of_confidence(scenes: list[tuple[str, MatchingScene]], evidence: Evidence, wrong_map: bool) -> list[Answer]:
    """What the consistent matcher answers, on the room's map or on its mirror image, where no answer is right."""
    semantic_map = mirrored(room_map()) if wrong_map else room_map()
    answers = []
    for name, scene in scenes:
        found = associate_consistent(scene.observations, semantic_map, evidence=evidence)
        best = found.hypotheses[0].pose if found.hypotheses else None
        given = best if found.confidence >= MIN_CONFIDENCE else None
        truth = NOWHERE if wrong_map else scene.pose
        answers.append(judged((0, 1, name), "consistent", given, best, found.confidence, truth, None))
    return answers


def answers_on_both_maps(
    scenes: list[tuple[str, MatchingScene]], kinds: dict[str, Evidence]
) -> dict[str, tuple[list[Answer], list[Answer]]]:
    """Name -> what the matcher with that evidence answers on the room's map, and on its mirror image."""
    runs = [(name, wrong_map) for name in kinds for wrong_map in (False, True)]
    found = {run: answers_of_confidence(scenes, kinds[run[0]], run[1]) for run in progress(runs, "evidence and maps")}
    return {name: (found[name, False], found[name, True]) for name in kinds}


def answers_of_few(n_seen: int, draws: int, rng: np.random.Generator) -> list[Answer]:
    """What the consistent matcher answers when `n_seen` objects, drawn at random, are seen and no more."""
    scenes = [
        (name, thinned(scene, np.sort(rng.permutation(len(scene.observations))[:n_seen])))
        for name, scene in room_scenes().items()
        for _ in range(draws)
    ]
    return answers_of_confidence(scenes, Evidence(), False)


def answers_of_two_views(draws: int, rng: np.random.Generator) -> list[Answer]:
    """At every place of the room two half-seen views, the rig turned between them: after the first, after both.

    Methods "one view" and "two views, odometry"; odometry with its noise.
    """
    scenes = room_scenes()
    places = [name[:-2] for name in scenes if name.endswith("_a")]
    answers = []
    for place in progress([place for place in places for _ in range(draws)], "places"):
        both = [scenes[f"{place}_{turn}"] for turn in "ab"]
        tracker = SemanticTracker(room_map())
        poses = np.array([one.pose for one in both])
        for k, method in enumerate(("one view", "two views, odometry")):
            motion = measured_motion(poses[0], poses[1], rng) if k else None
            track = tracker.step(half_seen(both[k], rng).observations, motion)
            best = track.alternatives[0][0] if track.alternatives else None
            answers.append(judged((0, 1, place), method, track.pose, best, track.confidence, poses[k], None))
    return answers


def at_threshold(curve: dict[str, list[float]], threshold: float = MIN_CONFIDENCE) -> tuple[float, float]:
    """Coverage and risk, percent, of a `risk_coverage` curve at a threshold; (0, 0) where nothing is that sure."""
    sure = [k for k, value in enumerate(curve["threshold"]) if value >= threshold]
    return (curve["coverage_percent"][sure[-1]], curve["risk_percent"][sure[-1]]) if sure else (0.0, 0.0)


def belief_at(true_pose: np.ndarray, alternatives: Sequence[tuple[Pose2D, float]]) -> float:
    """Share of the belief of the poses that are right."""
    return sum(share for pose, share in alternatives if is_right(pose_errors(pose, true_pose)))
