"""A folder of stereo panoramas with the truth beside them: what the room experiment runs on.

poses.json (version 1): seed, width, height, baseline, and for every pair its rig (where it really stood) and, for the
upper and the lower image, the file and the exact boxes of the objects that can be seen.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.files import is_file, read_json
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, View, read_panorama

VERSION = 1
POSES_FILE = "poses.json"


@dataclass(frozen=True)
class TrueObject:
    """One object on one image, as it really is. Boxes in edge coordinates; visible_fraction of its pixels, 0 to 1."""

    number: int
    label: str
    visible_box: tuple[float, float, float, float]
    unoccluded_box: tuple[float, float, float, float]
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
        return self._image(self.upper_file), self._image(self.lower_file)

    def _image(self, file: Path) -> np.ndarray:
        image = read_panorama(file)
        height, width = image.shape[:2]
        if (width, height) != self.size:
            raise PanoramaError(
                f"{file} has {width} x {height} pixels; {file.parent / POSES_FILE} says {self.size[0]} x {self.size[1]}"
            )
        return image


@dataclass(frozen=True)
class StereoRecording:
    """Pairs of panoramas taken with one rig; sizes in pixels, and the seed of the data."""

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
    version = content.get("version") if isinstance(content, dict) else None
    if version != VERSION:
        raise PanoramaError(f"{path} has version {version!r}; this program reads version {VERSION}")
    try:
        size = _of_kind(content["width"], int), _of_kind(content["height"], int)
        View.of_detections([], size)
        pairs = tuple(_pair(folder, entry, size) for entry in content["pairs"])
        heights = {_of_kind(entry["rig"]["upper_height"], float) for entry in content["pairs"]}
        rig = StereoRig(_of_kind(content["baseline"], float), min(heights, default=np.nan))
    except PanoramaError as error:
        raise PanoramaError(f"{path}: {error}") from None
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise PanoramaError(f"{path}: a field is missing or of the wrong kind ({error!r})") from None
    if len(heights) != 1:
        raise PanoramaError(f"{path}: pairs with upper cameras at {sorted(heights)} m; expected one height")
    missing = [file.name for pair in pairs for file in (pair.upper_file, pair.lower_file) if not is_file(file)]
    if missing:
        raise PanoramaError(f"{folder} lacks {len(missing)} images that {POSES_FILE} names, {missing[0][:40]!r} first")
    return StereoRecording(folder, rig, *size, content.get("seed"), pairs)


def _pair(folder: Path, entry: dict, size: tuple[int, int]) -> StereoPair:
    upper, lower = entry["upper"], entry["lower"]
    return StereoPair(
        _of_kind(entry["name"], str),
        np.array([_of_kind(entry["rig"][name], float) for name in ("x", "y", "heading")]),
        folder / _of_kind(upper["file"], str),
        folder / _of_kind(lower["file"], str),
        tuple(map(true_object, upper["objects"])),
        tuple(map(true_object, lower["objects"])),
        size,
    )


def true_object(entry: dict) -> TrueObject:
    """Return one object from its entry in poses.json or boxes.json."""
    return TrueObject(
        _of_kind(entry["object"], int),
        _of_kind(entry["label"], str),
        _box(entry["visible_box"]),
        _box(entry["unoccluded_box"]),
        _of_kind(entry["visible_fraction"], float),
    )


def _box(value: object) -> tuple[float, float, float, float]:
    if not isinstance(value, list) or len(value) != 4:
        raise TypeError(f"a box of four numbers is expected, found {str(value)[:40]}")
    return tuple(_of_kind(number, float) for number in value)


def _of_kind(value: object, kind: type):
    """Return a value of JSON as text, whole number or number. True and "3" are no numbers here."""
    if isinstance(value, bool) or not isinstance(value, (int, float) if kind is float else kind):
        raise TypeError(f"a value of kind {kind.__name__} is expected, found {str(value)[:40]}")
    return kind(value)
