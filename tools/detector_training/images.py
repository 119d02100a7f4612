"""Folders of panoramas with the boxes of their objects, decoded once and held in memory.

A folder holds `boxes.json` and the images that it names:

    {"version": 1, "images": [{"file": "000001.jpg", "room_seed": 12, "width": 1280, "height": 640, "objects":
      [{"label": "sofa", "visible_box": [u0, v0, u1, v1], "visible_fraction": 0.83, ...}, ...]}, ...]}

Boxes are in edge coordinates of the stored image; u1 may pass its width at the seam. An object is to be found when at
least half of it is visible and its box is at least 30 px high in an image 1280 px wide; the others are ignored.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from course_lib.experiments.room import LEAST_HEIGHT, LEAST_VISIBLE
from course_lib.files import read_json

# Width of a whole panorama in memory: a 1280 x 512 network input is one and a quarter panorama, 1.25 * 1024 columns.
STORED_WIDTH = 1024


class TrainingDataError(ValueError):
    """A folder of training images that cannot be used."""


@dataclass(frozen=True)
class LabelledPanorama:
    """One panorama and its objects."""

    file: str
    image: np.ndarray
    """(h, 2 h, 3) uint8, BGR."""
    labels: np.ndarray
    """(n,) class numbers."""
    boxes: np.ndarray
    """(n, 4) float32 u_min, v_min, u_max, v_max, edge coordinates of `image`; u_max may pass the width."""
    ignored: np.ndarray
    """(n,) boolean: too much hidden or too small to count."""


class PanoramaFolders:
    """The panoramas of folders in memory; `refresh` reads those that were added since."""

    def __init__(
        self, folders: list[Path], names: list[str], width: int = STORED_WIDTH, part: tuple[int, int] = (0, 1)
    ):
        """Reads the folders, scaled to `width` columns.

        part: (k, n) reads every n-th image only, from the k-th on: each of n processes then holds its share.
        Raises `TrainingDataError` when one has no usable boxes.json, or there is no image.
        """
        self.folders = [Path(folder) for folder in folders]
        self.names = list(names)
        self.width = width
        self.part = part
        self.panoramas: list[LabelledPanorama] = []
        self._seen: set[Path] = set()
        self.refresh()
        if not self.panoramas:
            listed = ", ".join(str(folder) for folder in self.folders)
            raise TrainingDataError(f"{listed}: boxes.json names no image that is there; make the images first")

    def __len__(self) -> int:
        return len(self.panoramas)

    def __getitem__(self, index: int) -> LabelledPanorama:
        return self.panoramas[index]

    def refresh(self) -> int:
        """Reads the images that the folders' boxes.json have gained since the last call; returns how many."""
        before = len(self.panoramas)
        for folder in self.folders:
            for entry in read_boxes(folder)[self.part[0] :: self.part[1]]:
                path = folder / entry["file"]
                if path in self._seen or not path.exists():
                    continue
                image = cv2.imread(str(path), cv2.IMREAD_COLOR)
                if image is None:
                    continue  # still being written: the next call finds it
                self._seen.add(path)
                self.panoramas.append(labelled_panorama(entry, image, self.names, self.width))
        return len(self.panoramas) - before


def read_boxes(folder: str | Path) -> list[dict]:
    """The entries of a folder's boxes.json. Raises `TrainingDataError`: missing, no JSON, or another version."""
    path = Path(folder) / "boxes.json"
    if not path.is_file():
        raise TrainingDataError(f"{path} is missing: give a folder made by `tools.make_training_rooms`")
    content = read_json(path, "list of images", TrainingDataError)
    if not isinstance(content, dict) or content.get("version") != 1 or not isinstance(content.get("images"), list):
        raise TrainingDataError(f'{path}: expected {{"version": 1, "images": [...]}}: make the folder again')
    for number, entry in enumerate(content["images"]):
        if not (isinstance(entry, dict) and isinstance(entry.get("file"), str)):
            raise TrainingDataError(f"{path}, image {number} has no file: make the folder again")
    return content["images"]


def labelled_panorama(entry: dict, image: np.ndarray, names: list[str], width: int) -> LabelledPanorama:
    """One entry of boxes.json with its image, scaled to `width` columns (and half as many rows).

    Objects whose label is not among `names` are left out: they are background. Raises `TrainingDataError` when the
    image has another size than the entry says, or a field is missing or malformed.
    """
    try:
        return _labelled_panorama(entry, image, names, width)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        if isinstance(error, TrainingDataError):
            raise
        raise TrainingDataError(
            f"{entry['file']}: a field of boxes.json is missing or of the wrong kind ({error!r}): make the folder again"
        ) from None


def _labelled_panorama(entry: dict, image: np.ndarray, names: list[str], width: int) -> LabelledPanorama:
    if image.shape[:2] != (entry["height"], entry["width"]):
        raise TrainingDataError(
            f"{entry['file']} is {image.shape[1]} x {image.shape[0]}, boxes.json says {entry['width']} x "
            f"{entry['height']}: make the folder again"
        )
    scale = width / entry["width"]
    objects = [item for item in entry["objects"] if item["label"] in names and item["visible_box"] is not None]
    boxes = np.array([item["visible_box"] for item in objects], dtype=np.float32).reshape(-1, 4)
    if not np.isfinite(boxes).all() or (boxes[:, 2:] <= boxes[:, :2]).any():
        raise TrainingDataError(f"{entry['file']} has a box that is none: expected u0 < u1 and v0 < v1, all finite")
    fraction = np.array([item["visible_fraction"] for item in objects], dtype=np.float32)
    height_at_1280 = (boxes[:, 3] - boxes[:, 1]) * (1280.0 / entry["width"])
    ignored = (fraction < LEAST_VISIBLE) | (height_at_1280 < LEAST_HEIGHT)
    if image.shape[1] != width:
        image = cv2.resize(image, (width, width // 2), interpolation=cv2.INTER_AREA)
    labels = np.array([names.index(item["label"]) for item in objects], dtype=np.int64)
    return LabelledPanorama(entry["file"], image, labels, boxes * np.float32(scale), ignored)
