"""What paper 2's method sees in generated rooms: a room a seed, poses at both heights, and views a few steps on.

Photographs, detection, stereo matching and triangulation (sections 2.2 to 2.4) take long. They are done once for each
room and kept as a record. Map matching and fit (2.5, 2.6) are done anew from the records, by every variant.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

from course_lib.experiments.detection_scores import match_image
from course_lib.experiments.room import SOURCES, PairResult, localize_pair
from course_lib.files import temporary_folder
from course_lib.simulation.room.look_alike_recording import (
    RecordingModels,
    WalkModel,
    experiment_of,
    photograph_room,
    photograph_walks,
    surveyed_room,
)
from course_lib.simulation.room.measurement_places import CAMERA_HEIGHTS
from course_lib.simulation.room.scene import Room
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.recording import StereoPair, read_stereo_recording
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap


class Network(NamedTuple):
    """A detector as a point of `kept_rows` names it."""

    folder: str
    checksum: str  # Of the files: observations of another network are not used again
    input_size: tuple[int, int] | None = None
    score_threshold: float | None = None


def room_record(seed: int, poses: int, network: Sequence, tilt_deg: float | None) -> dict:
    """Return `observe_room` of the reported models, of a rig whose lower camera is tilted by so much (None: drawn)."""
    return observe_room(seed, poses, replace(RecordingModels(), tilt_deg=tilt_deg), _loaded(network))


def views_record(seed: int, poses: int, network: Sequence, views: int) -> list[dict]:
    """Return `observe_views` of the reported models."""
    return observe_views(seed, poses, views, RecordingModels(), _loaded(network))


def _loaded(network: Sequence) -> YoloDetector:
    folder, checksum, size, threshold = network
    return _load(folder, checksum, None if size is None else tuple(size), threshold)


@cache
def _load(folder: str, checksum: str, input_size: tuple[int, int] | None, score_threshold: float | None):
    """The detector, loaded once in each process."""
    options = {"input_size": input_size, "score_threshold": score_threshold}
    return YoloDetector.load(folder, **{key: value for key, value in options.items() if value is not None})


def observe_room(seed: int, poses: int, models: RecordingModels, detector) -> dict:
    """Make a room, photograph and survey it, and note what the method sees from each pose at each height; for JSON."""
    room, semantic_map = surveyed_room(seed, models)
    alike, seen = room.objects[0].label, []
    for number, localizer, pair in photographed_pairs(room, semantic_map, seed, poses, models, detector):
        results = {source: localize_pair(pair, localizer, source) for source in SOURCES}
        seen.append({"experiment": number, "name": pair.name, "pose": pair.pose.tolist()} | _seen(results))
    return {
        "seed": seed,
        "look_alike": {"label": alike, "n": sum(thing.label == alike for thing in room.objects)},
        "map": [[one.label, one.x, one.y, _or_none(one.hue), one.saturation] for one in semantic_map.landmarks],
        "walls": semantic_map.walls.tolist(),
        "poses": seen,
    }


def photographed_pairs(
    room: Room, semantic_map: SemanticMap, seed: int, poses: int, models: RecordingModels, detector
) -> Iterator[tuple[int, SemanticLocalizer, StereoPair]]:
    """Photograph a room at both heights; yield the experiment's number, the paper's localizer, and each pair."""
    with temporary_folder() as temporary:
        for number, folder in enumerate(photograph_room(temporary, room, seed, poses, models), start=1):
            recording = read_stereo_recording(folder)
            size = (recording.width, recording.height)
            localizer = SemanticLocalizer(
                recording.rig, semantic_map, detector, image_size=size, reject_implausible=False
            )
            for pair in recording.pairs:
                yield number, localizer, pair


def _seen(results: dict[str, PairResult]) -> dict:
    """Observations and their truth by source; how the detector did on the two images; seconds from images to pose."""
    from_images = results["images"]
    found, pair, width = from_images.localization, from_images.pair, from_images.size[0]
    counted = [
        match_image(found.upper_detections, pair.upper_objects, width),
        match_image(found.lower_detections, pair.lower_objects, width),
    ]
    return {
        "sources": {
            source: {
                "observations": record_of_observations(result.localization.observations),
                "true_landmarks": list(result.true_landmarks),
            }
            for source, result in results.items()
        },
        "objects": sum(one.n_objects for one in counted),
        "found": sum(int(one.correct.sum()) for one in counted),
        "detections": sum(len(one.correct) for one in counted),
        "seconds": from_images.seconds,
    }


def observe_views(seed: int, poses: int, views: int, models: RecordingModels, detector) -> list[dict]:
    """Make the room of a seed anew, walk on from each of its first poses, and note what is seen there; for JSON.

    views: of a sequence, the first one counted, which is a pose of `observe_room` as it stands there.
    """
    room, semantic_map = surveyed_room(seed, models)
    sequences = []
    with temporary_folder() as folder:
        for k, walk in enumerate(photograph_walks(folder, room, seed, poses, views - 1, models, WalkModel())):
            upper, lower = CAMERA_HEIGHTS[experiment_of(k)]
            rig, size = StereoRig(round(upper - lower, 6), upper), (models.width, models.width // 2)
            localizer = SemanticLocalizer(rig, semantic_map, detector, image_size=size, reject_implausible=False)
            found = [localizer.localize(view.upper_image, view.lower_image) for view in walk]
            seen = [
                {"pose": view.pose.tolist(), "observations": record_of_observations(one.observations)}
                for view, one in zip(walk, found, strict=True)
            ]
            sequences.append({"experiment": experiment_of(k), "name": f"{k:02d}", "views": seen})
    return sequences


class ViewSequence(NamedTuple):
    """Views of one room from places near each other, the first one a pose of `observe_room`."""

    experiment: int
    name: str
    poses: np.ndarray  # `(n, 3)` [x, y, heading] where the rig really stood
    observations: tuple[list[Observation], ...]  # What was seen from each


def stored_sequences(room: dict, views: Sequence[dict]) -> list[ViewSequence]:
    """Return the sequences of a room: its records of `observe_room` and of `observe_views` joined."""
    first = {(pose["experiment"], pose["name"]): pose for pose in room["poses"]}
    sequences = []
    for entry in views:
        pose = first[entry["experiment"], entry["name"]]
        poses = np.array([pose["pose"], *(view["pose"] for view in entry["views"])])
        seen = tuple(stored_observations(one) for one in (pose["sources"]["images"], *entry["views"]))
        sequences.append(ViewSequence(entry["experiment"], entry["name"], poses, seen))
    return sequences


def record_of_observations(observations: Sequence[Observation]) -> list[list]:
    """Return observations as a record holds them: label, x, y, hue (None: grey), saturation, covariance."""
    return [
        [one.label, one.x, one.y, _or_none(one.hue), one.saturation, np.asarray(one.covariance).tolist()]
        for one in observations
    ]


def stored_observations(entry: dict) -> list[Observation]:
    """Return the observations of one pose and source, from a room's record."""
    return [
        Observation(label, x, y, np.nan if hue is None else hue, saturation, np.array(covariance))
        for label, x, y, hue, saturation, covariance in entry["observations"]
    ]


def stored_map(room: dict) -> SemanticMap:
    """Return the semantic map of a room's record."""
    return SemanticMap(
        [Landmark(label, x, y, np.nan if hue is None else hue, s) for label, x, y, hue, s in room["map"]],
        walls=room.get("walls"),
    )


def _or_none(hue: float) -> float | None:
    return None if np.isnan(hue) else hue
