"""Read a folder of simulated pairs of panoramas: poses.json and the images that it names.

poses.json (version 1): seed, width, height, baseline, and for every pair its rig (where it really stood) and, for the
upper and the lower image, the file and the exact boxes of the objects that can be seen, in edge coordinates.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.files import is_file, read_json
from course_lib.spherical_stereo.detection.colour import Box
from course_lib.spherical_stereo.drawn_boxes import json_box, json_number
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, View, read_panorama

VERSION = 1
POSES_FILE = "poses.json"


@dataclass(frozen=True)
class TrueObject:
    """One object on one image, as it really is. Boxes in edge coordinates; visible_fraction of its pixels, 0 to 1."""

    number: int
    label: str
    visible_box: Box
    unoccluded_box: Box
    visible_fraction: float


@dataclass(frozen=True)
class StereoPair:
    """One pair of panoramas and where it was taken."""

    name: str
    pose: np.ndarray  # `(3,)` [x, y, heading] of the upper camera, metres and radians, heading in [-pi, pi]
    upper_file: Path
    lower_file: Path
    upper_objects: tuple[TrueObject, ...]
    lower_objects: tuple[TrueObject, ...]
    size: tuple[int, int]  # (width, height) of both, pixels

    def images(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the upper and the lower panorama, `(H, W, 3)` uint8 BGR."""
        views = read_panorama(self.upper_file), read_panorama(self.lower_file)
        for file, view in zip((self.upper_file, self.lower_file), views, strict=True):
            if view.size != self.size:
                raise PanoramaError(f"{file} has (width, height) {view.size}; {POSES_FILE} says {self.size}")
        return views[0].image, views[1].image


@dataclass(frozen=True)
class StereoRecording:
    """Pairs of panoramas taken with one rig. Sizes are in pixels."""

    folder: Path
    rig: StereoRig
    width: int
    height: int
    seed: int | None
    pairs: tuple[StereoPair, ...]


def read_stereo_recording(folder: str | Path) -> StereoRecording:
    """Read the recording in a folder. Images are read only when a pair is asked for them."""
    folder = Path(folder)
    path = folder / POSES_FILE
    content = read_json(path, "list of pairs", PanoramaError)
    try:
        if content["version"] != VERSION:
            raise PanoramaError(f"the version must be {VERSION}; got {content['version']!r}")
        size = json_number(content["width"], int), json_number(content["height"], int)
        View(*size)
        pairs = tuple(_pair(folder, entry, size) for entry in content["pairs"])
        heights = {json_number(entry["rig"]["upper_height"]) for entry in content["pairs"]}
        if len(heights) != 1:
            raise PanoramaError(f"one height of the upper camera is expected; got {sorted(heights)} m")
        rig = StereoRig(json_number(content["baseline"]), heights.pop())
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise PanoramaError(f"{path}: a field is missing, of the wrong kind or out of range ({error!r})") from None
    missing = [file.name for pair in pairs for file in (pair.upper_file, pair.lower_file) if not is_file(file)]
    if missing:
        raise PanoramaError(f"{folder} lacks {len(missing)} images that {POSES_FILE} names, {missing[0][:40]!r} first")
    return StereoRecording(folder, rig, *size, content.get("seed"), pairs)


def _pair(folder: Path, entry: dict, size: tuple[int, int]) -> StereoPair:
    upper, lower = entry["upper"], entry["lower"]
    return StereoPair(
        str(entry["name"]),
        np.array([json_number(entry["rig"][name]) for name in ("x", "y", "heading")]),
        folder / upper["file"],
        folder / lower["file"],
        tuple(map(true_object, upper["objects"])),
        tuple(map(true_object, lower["objects"])),
        size,
    )


def true_object(entry: dict) -> TrueObject:
    """Return one object from its entry in poses.json or boxes.json."""
    if not isinstance(entry["label"], str):
        raise TypeError(f"a label is expected, found {str(entry['label'])[:40]}")
    boxes = json_box(entry["visible_box"]), json_box(entry["unoccluded_box"])
    return TrueObject(json_number(entry["object"], int), entry["label"], *boxes, json_number(entry["visible_fraction"]))
