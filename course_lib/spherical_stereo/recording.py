"""Files that come with stereo panoramas: the truth of a folder of pairs, and boxes drawn by hand on one pair.

poses.json (version 1): seed, width, height, baseline, and for every pair its rig (where it really stood) and, for the
upper and the lower image, the file and the exact boxes of the objects that can be seen. Boxes drawn by hand:

    {"version": 1, "width": 1024, "height": 512,
     "upper": [{"label": "chair", "box": [u_min, v_min, u_max, v_max], "name": "chair by the window"}, ...],
     "lower": [...]}

Boxes are in edge coordinates of images of that size. u_max passes the width if a box crosses the seam. `name` is what
tables call the object, and may be left out.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.files import is_file, read_json
from course_lib.spherical_stereo.detection import detected_object
from course_lib.spherical_stereo.detection.colour import Box, coloured
from course_lib.spherical_stereo.detection.detected_object import DetectionError
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, View, open_pair, read_panorama

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
        size = _number(content["width"], int), _number(content["height"], int)
        View(*size)
        pairs = tuple(_pair(folder, entry, size) for entry in content["pairs"])
        heights = {_number(entry["rig"]["upper_height"]) for entry in content["pairs"]}
        if len(heights) != 1:
            raise PanoramaError(f"one height of the upper camera is expected; got {sorted(heights)} m")
        rig = StereoRig(_number(content["baseline"]), heights.pop())
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
        np.array([_number(entry["rig"][name]) for name in ("x", "y", "heading")]),
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
    boxes = _box(entry["visible_box"]), _box(entry["unoccluded_box"])
    return TrueObject(_number(entry["object"], int), entry["label"], *boxes, _number(entry["visible_fraction"]))


def _box(value: object) -> Box:
    u_min, v_min, u_max, v_max = map(_number, value)
    return u_min, v_min, u_max, v_max


def _number(value: object, kind: type = float):
    """Return a number of JSON as float or int. Raises TypeError for True, "3", and 3.5 where an int is expected."""
    if isinstance(value, bool) or not isinstance(value, (int, kind)):
        raise TypeError(f"a number of kind {kind.__name__} is expected, found {str(value)[:40]}")
    return kind(value)


class LabelledBox(NamedTuple):
    """One box of the file. Its label is canonical, and 0 <= u_min < width."""

    label: str
    box: Box
    name: str | None


@dataclass(frozen=True)
class StereoBoxes:
    """The boxes of both images: anything with `label` and `box`."""

    size: tuple[int, int]  # (width, height) in pixels of the images that they were drawn on
    upper: Sequence[LabelledBox]
    lower: Sequence[LabelledBox]

    def on(self, upper_image: np.ndarray | View, lower_image: np.ndarray | View) -> tuple[View, View]:
        """Return both panoramas with the boxes as detections of score 1. Hue and saturation come from the images."""
        upper, lower = open_pair(upper_image, lower_image)
        if upper.size != self.size:
            raise DetectionError(
                f"the boxes were drawn on images of {self.size} pixels, these have {upper.size}: scale the images, or "
                "draw the boxes again"
            )
        return coloured(upper.replace(detections=self.upper)), coloured(lower.replace(detections=self.lower))


def read_stereo_boxes(path: str | Path) -> StereoBoxes:
    """Read a file of boxes drawn by hand (format: see the module)."""
    content = read_json(Path(path), "boxes file", DetectionError)
    where, sides = "the file", {}
    try:
        if content["version"] != VERSION:
            raise DetectionError(f"the version must be {VERSION}; got {content['version']!r}")
        size = View(content["width"], content["height"]).size
        for side in ("upper", "lower"):
            where, sides[side] = side, []
            for number, item in enumerate(content[side]):
                where = f"{side}[{number}]"
                box, name = detected_object.wrapped_box(_box(item["box"]), size[0]), item.get("name")
                if box[1] < 0 or box[3] > size[1]:
                    raise DetectionError(f"the box leaves the image at the top or bottom; got {item['box']}")
                if name is not None and not (isinstance(name, str) and name.strip()):
                    raise DetectionError(f"the name must be a text that is not empty; got {name!r}")
                sides[side].append(
                    LabelledBox(detected_object.canonical_label(item["label"]), tuple(box.tolist()), name)
                )
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        raise DetectionError(f"{path}: {where} does not have the format of a boxes file: {error!r}") from None
    return StereoBoxes(size, **sides)
