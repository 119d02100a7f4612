"""The rooms of projects P2 and P3: what two spherical cameras saw in each room, and where they stood.

`tools.make_data projects` makes them once. P2 starts at the boxes of both images, P3 at the observations of sections
2.2 to 2.4. Students work on the practice rooms.
"""

import json
from collections import namedtuple
from functools import cache

import numpy as np

from course_lib.spherical_stereo.detection.detected_object import Detection
from course_lib.spherical_stereo.panorama import StereoRig
from courseware.experiments import observed_rooms
from courseware.paths import data_path

PRACTICE_SEEDS = tuple(range(10_601, 10_605))  # tuning seeds

# upper, lower: `Detection`s in one pair of panoramas. observations: objects with a place, matched by the photographs'
# features (2.3) and triangulated (2.4). shows: the landmark of each observation, or -1. pose: the true x, y [m],
# theta [rad]. rig: `StereoRig`. size: width and height of both panoramas, pixels.
ProjectView = namedtuple("ProjectView", "upper lower observations shows pose rig size")
# look_alike: the class of the objects of one shape and one colour.
ProjectRoom = namedtuple("ProjectRoom", "seed semantic_map look_alike views")
# What P2's function gets: two spherical cameras, one `baseline` [m] above the other, and their images' size, pixels.
Rig = namedtuple("Rig", "baseline width height")


def read_rooms(text: str) -> tuple[ProjectRoom, ...]:
    """Return the rooms in the text of a file that `tools.make_data projects` wrote."""
    return tuple(
        ProjectRoom(room["seed"], observed_rooms.stored_map(room), room["look_alike"], tuple(map(_view, room["views"])))
        for room in json.loads(text)["rooms"]
    )


@cache
def rooms_of(name: str) -> tuple[ProjectRoom, ...]:
    """Return the rooms in data/projects/rooms_NAME.json: "practice"."""
    return read_rooms(data_path(f"projects/rooms_{name}.json").read_text(encoding="utf-8"))


def room_of(seed: int) -> ProjectRoom:
    """Return a practice room by its seed. Raises `ValueError`, which names these rooms, if there is none."""
    for room in rooms_of("practice"):
        if room.seed == seed:
            return room
    raise ValueError(f"there is no room of seed {seed}; the practice rooms are {str(PRACTICE_SEEDS)[1:-1]}")


def _view(stored: dict) -> ProjectView:
    upper, lower = (
        tuple(Detection(*start, np.nan if hue is None else hue, saturation) for *start, hue, saturation in stored[side])
        for side in ("upper", "lower")
    )
    seen = tuple(observed_rooms.stored_observations(stored)), tuple(stored["shows"])
    return ProjectView(upper, lower, *seen, tuple(stored["pose"]), StereoRig(stored["baseline"]), tuple(stored["size"]))
