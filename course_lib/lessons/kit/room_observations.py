"""Load the matcher's input for the experiment's room, made from exact boxes. Lessons 15 to 18 use it."""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.experiments.room import PairResult, run_experiment
from course_lib.lessons.kit.room_photographs import room_map, room_recording
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.semantic_map.association import Observation


class MatchingScene(NamedTuple):
    """The matcher's input from one pair of photographs, and the truth that the matcher does not get."""

    observations: tuple[Observation, ...]
    true_landmarks: tuple[int, ...]
    """Index of the landmark that each observation shows."""
    pose: Pose2D


def in_body_frame(points: np.ndarray, pose: Sequence[float]) -> np.ndarray:
    """Return R(theta)' (p - t): world points p `(n, 2)` [m] in the body frame [x, y, theta]. Inverts `Pose2D.apply`."""
    return (np.asarray(points) - np.asarray(pose[:2])) @ rotation_2d(pose[2])


@functools.cache
def room_scenes(experiment: int = 1) -> dict[str, MatchingScene]:
    """Return name of a pair of photographs -> its scene. The boxes are exact, so no network runs."""
    recording = room_recording(experiment)
    results = run_experiment(
        recording, SemanticLocalizer(recording.rig, room_map(), reject_implausible=False), "exact_boxes"
    )
    rng = np.random.default_rng(15)
    return {result.pair.name: _scene(result, rng) for result in results}


def _scene(result: PairResult, rng: np.random.Generator) -> MatchingScene:
    # Exact boxes have the order of the map, which would help the matcher: of equal penalties it takes the first.
    order = rng.permutation(len(result.true_landmarks))
    seen, shows = result.localization.observations, result.true_landmarks
    pose = Pose2D(*(float(value) for value in result.pair.pose))
    return MatchingScene(tuple(seen[k] for k in order), tuple(int(shows[k]) for k in order), pose)
