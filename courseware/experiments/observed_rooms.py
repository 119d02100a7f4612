"""What paper 2's method sees in generated rooms: a room a seed, poses at both heights, and views a few steps on.

Sections 2.2 to 2.4 take long: they are done once for each room and kept as a record. Map matching and fit (2.5, 2.6)
are done from the records, by every variant.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from course_lib.files import temporary_folder
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.localizer import SemanticLocalizer
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.pose.localization import Localization
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from courseware.experiments.room import SOURCES, localize_pair
from courseware.experiments.room_evaluation import PoseOutcome, match_detections, outcome
from courseware.simulation.room import look_alike_recording
from courseware.simulation.room.look_alike_recording import RecordingModels, WalkModel, experiment_of, surveyed_room
from courseware.simulation.room.measurement_places import CAMERA_HEIGHTS
from courseware.simulation.room.scene import Room
from courseware.simulation.room.stereo_recording import StereoPair, read_stereo_recording

MODELS = RecordingModels()  # those of the reported tables


class JudgedPose(NamedTuple):
    """One pose of one room, localized and judged."""

    seed: int
    experiment: int
    name: str
    source: str
    method: str
    pose: tuple[float, float, float]
    localization: Localization
    outcome: PoseOutcome
    true_landmarks: tuple[int, ...]


def loaded(network: Sequence) -> YoloDetector:
    """Return the detector of [folder, checksum of its files, input size, score threshold]; None is the folder's own."""
    folder, _, size, threshold = network
    options = {"input_size": size and tuple(size), "score_threshold": threshold}
    return YoloDetector.load(folder, **{key: value for key, value in options.items() if value is not None})


def observe_room(seed: int, poses: int, network: Sequence, tilt_deg: float | None, models=MODELS) -> dict:
    """Make a room, photograph and survey it, and note what the method sees from each pose at each height; for JSON.

    network: as in `loaded`. tilt_deg: of the lower camera against the upper one; None: drawn.
    """
    models, detector = replace(models, tilt_deg=tilt_deg), loaded(network)
    room, semantic_map = surveyed_room(seed, models)
    alike, seen = room.objects[0].label, []
    for number, localizer, pair in photographed_pairs(room, semantic_map, seed, poses, models, detector):
        results = {source: localize_pair(pair, localizer, source) for source in SOURCES}
        sources = {}
        for source, one in results.items():
            observations = record_of_observations(one.localization.observations)
            sources[source] = {"observations": observations, "true_landmarks": list(one.true_landmarks)}
        found, width = results["images"].localization, results["images"].size[0]
        sides = (found.upper_detections, pair.upper_objects), (found.lower_detections, pair.lower_objects)
        counted = [match_detections(*side, width) for side in sides]
        seen.append(
            {
                "experiment": number,
                "name": pair.name,
                "pose": pair.pose.tolist(),
                "sources": sources,
                "objects": sum(one.n_objects for one in counted),
                "found": sum(int(one.correct.sum()) for one in counted),
                "detections": sum(len(one.correct) for one in counted),
                "seconds": results["images"].seconds,
            }
        )
    return {
        "seed": seed,
        "look_alike": {"label": alike, "n": sum(thing.label == alike for thing in room.objects)},
        "map": [_thing(one) for one in semantic_map.landmarks],
        "walls": semantic_map.walls.tolist(),
        "poses": seen,
    }


def photographed_pairs(
    room: Room, semantic_map: SemanticMap, seed: int, poses: int, models: RecordingModels, detector, **options
) -> Iterator[tuple[int, SemanticLocalizer, StereoPair]]:
    """Photograph a room at both heights; yield the experiment's number, the localizer, and each pair."""
    with temporary_folder() as temporary:
        folders = look_alike_recording.photograph_room(temporary, room, seed, poses, models)
        for number, folder in enumerate(folders, start=1):
            recording = read_stereo_recording(folder)
            options = {"reject_implausible": False} | options  # the paper's method
            localizer = SemanticLocalizer(recording.rig, semantic_map, detector, **options)
            for pair in recording.pairs:
                yield number, localizer, pair


def observe_views(seed: int, poses: int, network: Sequence, views: int) -> list[dict]:
    """Make the room of a seed again, walk on from each of its first poses, and note what is seen there; for JSON.

    views: of a sequence, the first one counted, which is a pose of `observe_room` as it stands there.
    """
    detector, (room, semantic_map), sequences = loaded(network), surveyed_room(seed, MODELS), []
    with temporary_folder() as folder:
        walks = look_alike_recording.photograph_walks(folder, room, seed, poses, views - 1, MODELS, WalkModel())
        for k, walk in enumerate(walks):
            localizer = SemanticLocalizer(rig_of_walk(k), semantic_map, detector, reject_implausible=False)
            seen = []
            for view in walk:
                found = localizer.localize(view.upper_image, view.lower_image)
                seen.append({"pose": view.pose.tolist(), "observations": record_of_observations(found.observations)})
            sequences.append({"experiment": experiment_of(k), "name": f"{k:02d}", "views": seen})
    return sequences


def rig_of_walk(k: int) -> StereoRig:
    """Return the rig of the walk from pose k."""
    upper, lower = CAMERA_HEIGHTS[experiment_of(k)]
    return StereoRig(round(upper - lower, 6), upper)


def judged_poses(
    rooms: Iterable[dict], maps: Iterable[dict], methods: dict[str, dict], sources: Sequence[str] = SOURCES
) -> Iterator[JudgedPose]:
    """Localize every pose of every room's record from its observations, and judge it; by every method in turn.

    maps: the record whose map each room is looked for on: its own. methods: options of `SemanticLocalizer`.
    Source: paper 2, sections 2.5, 2.6 and table 2.
    """
    for room, other in zip(rooms, maps, strict=True):
        semantic_map = stored_map(other)
        # The observations are made: of the rig nothing is asked any more.
        localizers = {
            name: SemanticLocalizer(StereoRig(0.3), semantic_map, **options) for name, options in methods.items()
        }
        for pose, source in product(room["poses"], sources):
            entry = pose["sources"][source]
            seen = zip(stored_observations(entry), entry["true_landmarks"], strict=True)
            known = [one for one in seen if one[0].label in semantic_map.labels]
            truth = tuple(landmark for _, landmark in known)
            for name, localizer in localizers.items():
                found = localizer.localize_observations([one for one, _ in known])
                where = (room["seed"], pose["experiment"], pose["name"], source, name, tuple(pose["pose"]))
                yield JudgedPose(*where, found, outcome(found, pose["pose"], truth), truth)


def record_of_observations(observations: Sequence[Observation]) -> list[list]:
    """Return observations as a record holds them: label, x, y, hue (None: grey), saturation, covariance."""
    return [[*_thing(one), np.asarray(one.covariance).tolist()] for one in observations]


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


def _thing(one: Observation | Landmark) -> list:
    return [one.label, one.x, one.y, None if np.isnan(one.hue) else one.hue, one.saturation]
