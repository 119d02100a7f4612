"""Load the experiment's room: its map, its recordings, and what detecting and matching find of exact boxes."""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.matching.features import PanoramaFeatures, detect_features
from course_lib.spherical_stereo.panorama import StereoRig, View, open_view
from course_lib.spherical_stereo.pose.rigid_fit import Pose2D, rotation_2d
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
from courseware.experiments.room import exact_detections, run_experiment
from courseware.paths import data_path
from courseware.simulation.room.stereo_recording import StereoPair, StereoRecording, read_stereo_recording


@functools.cache
def room_map() -> SemanticMap:
    """Return the surveyed map of the room."""
    return SemanticMap.load(data_path("room/semantic_map.json"))


@functools.cache
def room_recording(experiment: int) -> StereoRecording:
    """Return the 20 pairs of panoramas of experiment 1 or 2."""
    return read_stereo_recording(data_path(f"room/experiment_{experiment}"))


def pair_of(recording: StereoRecording, name: str) -> StereoPair:
    """Return the pair of this name, such as "09_a". Raises `KeyError` if there is none."""
    return {pair.name: pair for pair in recording.pairs}[name]


def the_pair() -> StereoPair:
    """Return the pair of panoramas that lessons 11 and 12 show. A sofa lies across its seam."""
    return room_recording(1).pairs[9]


@functools.cache
def the_image() -> np.ndarray:
    """Return the upper panorama of `the_pair`, `(640, 1280, 3)` uint8 BGR."""
    return the_pair().images()[0]


class Side(NamedTuple):
    """One panorama `(H, W, 3)` uint8 BGR, its objects with exact boxes, their rows in the map, and its features."""

    image: np.ndarray
    objects: list[Detection]
    numbers: list[int]
    features: PanoramaFeatures

    def view(self, objects: Sequence[Detection] | None = None) -> View:
        """Return the panorama in the library's form. objects: detections that replace its own."""
        chosen = self.objects if objects is None else objects
        return open_view(self.image).replace(detections=chosen, features=self.features)


class Scene(NamedTuple):
    """The two panoramas of one place."""

    upper: Side
    lower: Side
    rig: StereoRig


@functools.lru_cache(maxsize=8)
def scene(name: str = "09_a") -> Scene:
    """Return one place of the room with its features. The first call takes half a second.

    In 09_a, a chair stands before another, and a table lies across the seam.
    """
    recording = room_recording(2)
    pair = pair_of(recording, name)
    views = [
        Side(image, *exact_detections(things, image), detect_features(image))
        for image, things in zip(pair.images(), (pair.upper_objects, pair.lower_objects), strict=True)
    ]
    return Scene(*views, recording.rig)


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
