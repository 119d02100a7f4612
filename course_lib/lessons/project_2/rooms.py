"""The rooms of projects P2 and P3: what two spherical cameras saw in each, once detected, and where they stood.

`tools.make_data projects` makes them once. P2 starts at the boxes of both images, P3 at the observations that sections
2.2 to 2.4 make of them. Students work on the practice rooms; the hidden rooms are for the score alone.
"""

import json
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from course_lib.experiments.observed_rooms import (
    photographed_pairs,
    record_of_observations,
    stored_map,
    stored_observations,
)
from course_lib.experiments.room import localize_pair
from course_lib.experiments.runner import kept_rows
from course_lib.files import atomic_write
from course_lib.simulation.room.look_alike_recording import RecordingModels, surveyed_room
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.panorama import StereoRig
from course_lib.spherical_stereo.semantic_map.association import Observation
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

RoomSet = Literal["practice", "hidden"]
SEEDS: dict[RoomSet, tuple[int, ...]] = {"practice": tuple(range(10_601, 10_605)), "hidden": tuple(range(6101, 6113))}
"""Practice rooms are of tuning seeds; hidden ones of seeds that neither tuning nor reporting uses."""
POSES = 4  # at each of the paper's two heights


class ProjectView(NamedTuple):
    """What one pair of panoramas showed, and where it was taken."""

    upper: tuple[Detection, ...]  # Detections of the upper image
    lower: tuple[Detection, ...]
    observations: tuple[Observation, ...]
    """Objects with a place, body frame: matched by the photographs' features (section 2.3), triangulated (2.4)."""
    shows: tuple[int, ...]  # For every observation the landmark that it really shows; -1: none of the map
    pose: tuple[float, float, float]  # The truth: x, y in metres, theta in radians
    rig: StereoRig
    size: tuple[int, int]  # Width and height of both panoramas, pixels


class ProjectRoom(NamedTuple):
    """One room: its map and what was seen in it."""

    seed: int
    semantic_map: SemanticMap
    look_alike: str  # Class of the objects of one shape and one colour
    views: tuple[ProjectView, ...]


def made_room(seed: int, detector: str) -> dict:
    """Return `record_room` of the reported models. detector: folder of the network."""
    return record_room(seed, POSES, RecordingModels(), YoloDetector.load(detector))


def record_room(seed: int, poses: int, models: RecordingModels, detector) -> dict:
    """Make a room, photograph and survey it, and note what the method sees from each pose; for JSON."""
    room, semantic_map = surveyed_room(seed, models)
    views = []
    for _, localizer, pair in photographed_pairs(room, semantic_map, seed, poses, models, detector):
        result = localize_pair(pair, localizer)
        found = result.localization
        views.append(
            {
                "pose": np.round(pair.pose, 4).tolist(),
                "baseline": localizer.rig.baseline,
                "size": result.size,
                "upper": [_row(one) for one in found.upper_detections],
                "lower": [_row(one) for one in found.lower_detections],
                "observations": _rounded(record_of_observations(found.observations)),
                "shows": list(result.true_landmarks),
            }
        )
    landmarks = [[one.label, one.x, one.y, _or_none(one.hue), one.saturation] for one in semantic_map.landmarks]
    return {
        "seed": seed,
        "look_alike": room.objects[0].label,
        "map": _rounded(landmarks),
        "walls": semantic_map.walls.tolist(),
        "views": views,
    }


def make_project_rooms(
    out: str | Path,
    detector: Path,
    work: Path,
    processes: int | None = None,
    progress: Callable[[Iterable], Iterable] = iter,
) -> dict[str, int]:
    """Write `rooms_practice.json` and `rooms_hidden.json` into a folder; return how many views each holds.

    detector: folder of the network. work: folder of finished rooms, from which a run that was stopped goes on.
    """
    counts = {}
    for name, seeds in SEEDS.items():
        points = [{"seed": seed, "detector": str(detector.absolute())} for seed in seeds]
        rooms = kept_rows(made_room, points, Path(work) / f"rooms_{name}.jsonl", processes, progress)
        text = json.dumps({"version": 1, "rooms": rooms}, separators=(",", ":"))
        atomic_write(Path(out) / f"rooms_{name}.json", text.replace('{"seed"', '\n{"seed"') + "\n")
        counts[name] = sum(len(room["views"]) for room in rooms)
    return counts


@cache
def project_rooms(path: Path) -> tuple[ProjectRoom, ...]:
    """The rooms in one of the files of `make_project_rooms`."""
    rooms = json.loads(Path(path).read_text())["rooms"]
    return tuple(
        ProjectRoom(room["seed"], stored_map(room), room["look_alike"], tuple(map(_view, room["views"])))
        for room in rooms
    )


def _view(stored: dict) -> ProjectView:
    return ProjectView(
        *(tuple(_detection(row) for row in stored[side]) for side in ("upper", "lower")),
        tuple(stored_observations(stored)),
        tuple(stored["shows"]),
        tuple(stored["pose"]),
        StereoRig(stored["baseline"]),
        tuple(stored["size"]),
    )


def _row(one: Detection) -> list:
    """A detection as the files hold it: label, score, box, hue (None: grey), saturation."""
    return [one.label, *_rounded([one.score, list(one.box), _or_none(one.hue), one.saturation])]


def _detection(row: Sequence) -> Detection:
    label, score, box, hue, saturation = row
    return Detection(label, score, tuple(box), np.nan if hue is None else hue, saturation)


def _or_none(hue: float) -> float | None:
    """A hue as JSON holds it; 359.99999 would be rounded to 360, which is 0."""
    return None if np.isnan(hue) else round(hue, 4) % 360.0


def _rounded(value):
    """Numbers of a nested list to four decimals."""
    if isinstance(value, list | tuple):
        return [_rounded(one) for one in value]
    return round(value, 4) if isinstance(value, float) else value
