"""The rooms of projects P2 and P3: what two spherical cameras saw in each room, and where they stood.

`tools.make_data projects` makes them once. P2 starts at the boxes of both images, P3 at the observations of sections
2.2 to 2.4. Students work on the practice rooms. The hidden rooms are for the score alone.
"""

import json
from collections import namedtuple
from functools import cache
from pathlib import Path

import numpy as np

from course_lib.files import atomic_write
from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.panorama import StereoRig
from courseware.experiments import observed_rooms
from courseware.experiments.room import localize_pair
from courseware.experiments.runner import kept_rows
from courseware.paths import data_path
from courseware.simulation.room.look_alike_recording import RecordingModels, surveyed_room

# Practice rooms have tuning seeds. Hidden rooms have seeds that neither tuning nor reporting uses.
SEEDS = {"practice": tuple(range(10_601, 10_605)), "hidden": tuple(range(6101, 6113))}
POSES = 4  # at each of the paper's two heights

# upper, lower: `Detection`s in one pair of panoramas. observations: objects with a place, matched by the photographs'
# features (2.3) and triangulated (2.4). shows: the landmark of each observation, or -1. pose: the true x, y [m],
# theta [rad]. rig: `StereoRig`. size: width and height of both panoramas, pixels.
ProjectView = namedtuple("ProjectView", "upper lower observations shows pose rig size")
# look_alike: the class of the objects of one shape and one colour.
ProjectRoom = namedtuple("ProjectRoom", "seed semantic_map look_alike views")
# What P2's function gets: two spherical cameras, one `baseline` [m] above the other, and their images' size, pixels.
Rig = namedtuple("Rig", "baseline width height")


def record_room(seed: int, detector, poses: int = POSES, models: RecordingModels = observed_rooms.MODELS) -> dict:
    """Make a room, photograph and survey it, and note what the method sees from each pose; for JSON.

    detector: the network, or its folder.
    """
    detector = YoloDetector.load(detector) if isinstance(detector, str) else detector
    room, semantic_map = surveyed_room(seed, models)
    views = []
    for _, localizer, pair in observed_rooms.photographed_pairs(room, semantic_map, seed, poses, models, detector):
        result = localize_pair(pair, localizer)
        found = result.localization
        views.append(
            {
                "pose": np.round(pair.pose, 4).tolist(),
                "baseline": localizer.rig.baseline,
                "size": result.size,
                "upper": _rounded([[d.label, d.score, d.box, _hue(d), d.saturation] for d in found.upper_detections]),
                "lower": _rounded([[d.label, d.score, d.box, _hue(d), d.saturation] for d in found.lower_detections]),
                "observations": _rounded(observed_rooms.record_of_observations(found.observations)),
                "shows": list(result.true_landmarks),
            }
        )
    landmarks = _rounded([[one.label, one.x, one.y, _hue(one), one.saturation] for one in semantic_map.landmarks])
    about = {"seed": seed, "look_alike": room.objects[0].label, "map": landmarks}
    return {**about, "walls": semantic_map.walls.tolist(), "views": views}


def _hue(one) -> float | None:
    """Return a hue as JSON holds it. 359.99999 is rounded to 0, not to 360."""
    return None if np.isnan(one.hue) else round(one.hue, 4) % 360.0


def _rounded(value):
    """Return the numbers of a nested list to four decimals."""
    if isinstance(value, list | tuple):
        return [_rounded(one) for one in value]
    return round(value, 4) if isinstance(value, float) else value


def make_project_rooms(out: Path, detector: Path, work: Path, processes: int | None = None, progress=iter) -> dict:
    """Write `rooms_practice.json` and `rooms_hidden.json` into a folder. Return the number of views of each.

    detector: folder of the network. work: folder of finished rooms. A run that was stopped goes on from there.
    """
    counts = {}
    for name, seeds in SEEDS.items():
        points = [{"seed": seed, "detector": str(detector.absolute())} for seed in seeds]
        rooms = kept_rows(record_room, points, Path(work) / f"rooms_{name}.jsonl", processes, progress)
        text = json.dumps({"version": 1, "rooms": rooms}, separators=(",", ":"))
        atomic_write(Path(out) / f"rooms_{name}.json", text.replace('{"seed"', '\n{"seed"') + "\n")
        counts[name] = sum(len(room["views"]) for room in rooms)
    return counts


@cache
def project_rooms(path: Path) -> tuple[ProjectRoom, ...]:
    """Return the rooms in one of the files of `make_project_rooms`."""
    return tuple(
        ProjectRoom(room["seed"], observed_rooms.stored_map(room), room["look_alike"], tuple(map(_view, room["views"])))
        for room in json.loads(Path(path).read_text())["rooms"]
    )


def rooms_of(name: str) -> tuple[ProjectRoom, ...]:
    """Return the "practice" rooms, or the "hidden" ones."""
    return project_rooms(data_path(f"projects/rooms_{name}.json"))


def room_of(seed: int) -> ProjectRoom:
    """Return a room by its seed. Raises `ValueError`, which names the practice rooms, if there is none."""
    rooms = {room.seed: room for name in SEEDS for room in rooms_of(name)}
    if seed not in rooms:
        raise ValueError(f"there is no room of seed {seed}; the practice rooms are {str(SEEDS['practice'])[1:-1]}")
    return rooms[seed]


def _view(stored: dict) -> ProjectView:
    upper, lower = (
        tuple(Detection(*start, np.nan if hue is None else hue, saturation) for *start, hue, saturation in stored[side])
        for side in ("upper", "lower")
    )
    seen = tuple(observed_rooms.stored_observations(stored)), tuple(stored["shows"])
    return ProjectView(upper, lower, *seen, tuple(stored["pose"]), StereoRig(stored["baseline"]), tuple(stored["size"]))
