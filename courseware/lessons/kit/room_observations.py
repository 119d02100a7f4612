"""Load the matcher's input for the experiment's room, made from exact boxes. Lessons 15 to 18 use it."""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.semantic_map.association import Observation
from courseware.experiments.room import run_experiment
from courseware.lessons.kit.room_photographs import room_map, room_recording


class MatchingScene(NamedTuple):
    """The matcher's input from one pair of photographs, and the truth that the matcher does not get.

    true_landmarks: index of the landmark that each observation shows.
    """

    observations: tuple[Observation, ...]
    true_landmarks: tuple[int, ...]
    pose: Pose2D


def in_body_frame(points: np.ndarray, pose: Sequence[float]) -> np.ndarray:
    """Return R(theta)' (p - t): world points p `(n, 2)` [m] in the body frame [x, y, theta]. Inverts `Pose2D.apply`."""
    return (np.asarray(points) - np.asarray(pose[:2])) @ rotation_2d(pose[2])


@functools.cache
def room_scenes(experiment: int = 1) -> dict[str, MatchingScene]:
    """Return name of a pair of photographs -> its scene. The boxes are exact, so no network runs."""
    recording = room_recording(experiment)
    localizer = SemanticLocalizer(recording.rig, room_map(), reject_implausible=False)
    rng, scenes = np.random.default_rng(15), {}
    for result in run_experiment(recording, localizer, "exact_boxes"):
        # Exact boxes have the order of the map, which would help the matcher: of equal penalties it takes the first.
        order = rng.permutation(len(result.true_landmarks))
        seen = tuple(result.localization.observations[k] for k in order)
        pose = Pose2D(*map(float, result.pair.pose))
        scenes[result.pair.name] = MatchingScene(seen, tuple(int(result.true_landmarks[k]) for k in order), pose)
    return scenes
