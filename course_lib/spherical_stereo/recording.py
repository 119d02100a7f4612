"""A folder of stereo panoramas with the truth beside them: what the room experiment runs on.

poses.json (version 1): seed, width, height, baseline, and for every pair its rig (where it really stood) and, for the
upper and the lower image, the file and the exact boxes of the objects that can be seen.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from course_lib.files import read_json
from course_lib.spherical_stereo.panorama import PanoramaError, StereoRig, read_panorama

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
    """One pair of panoramas and where it was taken.

    pose: `(3,)` [x, y, heading] of the upper camera, metres and radians, heading in [-pi, pi].
    upper_objects, lower_objects: what can be seen on each image.
    """

    name: str
    pose: np.ndarray
    upper_file: Path
    lower_file: Path
    upper_objects: tuple[TrueObject, ...]
    lower_objects: tuple[TrueObject, ...]
    size: tuple[int, int]
    """(width, height) of both panoramas, pixels."""

    def images(self) -> tuple[np.ndarray, np.ndarray]:
        """The upper and the lower panorama, `(H, W, 3)` uint8 BGR. Raises `PanoramaError` when one cannot be used."""
        return self._image(self.upper_file), self._image(self.lower_file)

    def _image(self, file: Path) -> np.ndarray:
        image = read_panorama(file)
        height, width = image.shape[:2]
        if (width, height) != self.size:
            told = f"{self.size[0]} x {self.size[1]}"
            raise PanoramaError(f"{file} has {width} x {height} pixels; {file.parent / POSES_FILE} says {told}")
        return image


@dataclass(frozen=True)
class StereoRecording:
    """Pairs of panoramas taken with one rig. width, height: of every panorama, pixels. seed: of the data."""

    folder: Path
    rig: StereoRig
    width: int
    height: int
    seed: int | None
    pairs: tuple[StereoPair, ...]


def read_stereo_recording(folder: str | Path) -> StereoRecording:
    """The recording of a folder; images are read only when a pair is asked for them.

    Raises `PanoramaError` when poses.json or an image it names is missing, or a field is missing or of another
    kind than expected.
    """
    folder = Path(folder)
    path = folder / POSES_FILE
    content = read_json(path, "list of pairs", PanoramaError)
    version = content.get("version") if isinstance(content, dict) else None
    if version != VERSION:
        raise PanoramaError(f"{path} has version {version!r}; this program reads version {VERSION}")
    try:
        width, height = _pixels(content["width"]), _pixels(content["height"])
        pairs = tuple(_pair(folder, entry, (width, height)) for entry in content["pairs"])
        heights = {_number(entry["rig"]["upper_height"]) for entry in content["pairs"]}
        rig = StereoRig(_number(content["baseline"]), float(min(heights, default=np.nan)))
    except PanoramaError as error:
        raise PanoramaError(f"{path}: {error}") from None
    except (KeyError, TypeError, IndexError, ValueError, OverflowError) as error:
        raise PanoramaError(f"{path}: a field is missing or of the wrong kind ({error!r})") from None
    if len(heights) != 1:
        raise PanoramaError(f"{path}: pairs with upper cameras at {sorted(heights)} m; expected one height")
    missing = [file.name for pair in pairs for file in (pair.upper_file, pair.lower_file) if not file.is_file()]
    if missing:
        raise PanoramaError(f"{folder} lacks {len(missing)} images that {POSES_FILE} names, {missing[0]} first")
    return StereoRecording(folder, rig, width, height, content.get("seed"), pairs)


def _pair(folder: Path, entry: dict, size: tuple[int, int]) -> StereoPair:
    rig = entry["rig"]
    return StereoPair(
        _text(entry["name"]),
        np.array([_number(rig[name]) for name in ("x", "y", "heading")]),
        folder / _file_name(entry["upper"]["file"]),
        folder / _file_name(entry["lower"]["file"]),
        tuple(map(true_object, entry["upper"]["objects"])),
        tuple(map(true_object, entry["lower"]["objects"])),
        size,
    )


def true_object(entry: dict) -> TrueObject:
    """One object from its entry in poses.json or boxes.json. Raises `KeyError`, `TypeError` for another entry."""
    return TrueObject(
        _whole(entry["object"]),
        _text(entry["label"]),
        _box(entry["visible_box"]),
        _box(entry["unoccluded_box"]),
        _number(entry["visible_fraction"]),
    )


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"a text is expected, found {str(value)[:40]}")
    return value


def _file_name(value: object) -> str:
    """A name that a system can look up: longer ones, and ones with a zero byte, are errors of its own."""
    if not 0 < len(_text(value)) <= 255 or "\0" in value:
        raise TypeError(f"the name of a file is expected, found {value[:40]!r}")
    return value


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise TypeError(f"a number is expected, found {str(value)[:40]}")
    return float(value)


def _whole(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise TypeError(f"a whole number is expected, found {str(value)[:40]}")
    return value


def _pixels(value: object) -> int:
    if _whole(value) < 1:
        raise TypeError(f"a number of pixels is expected, found {value}")
    return value


def _box(value: object) -> tuple[float, float, float, float]:
    if not isinstance(value, list) or len(value) != 4:
        raise TypeError(f"a box of four numbers is expected, found {str(value)[:40]}")
    return tuple(map(_number, value))
