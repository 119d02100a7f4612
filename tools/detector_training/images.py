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


def read_panoramas(
    folders: list[Path], names: list[str], width: int = STORED_WIDTH, part: tuple[int, int] = (0, 1)
) -> list[LabelledPanorama]:
    """Every panorama of folders, scaled to `width` columns.

    part: (k, n) reads every n-th image only, from the k-th on: each of n processes then holds its share.
    Raises `TrainingDataError` when a folder has no usable boxes.json, or there is no image.
    """
    found = []
    for folder in folders:
        for entry in read_boxes(folder)[part[0] :: part[1]]:
            image = cv2.imread(str(Path(folder) / entry["file"]), cv2.IMREAD_COLOR)
            if image is not None:  # the others are still being made
                found.append(labelled_panorama(entry, image, names, width))
    if not found:
        listed = ", ".join(map(str, folders))
        raise TrainingDataError(f"{listed}: boxes.json names no image that is there; make the images first")
    return found


def read_boxes(folder: str | Path) -> list[dict]:
    """The entries of a folder's boxes.json. Raises `TrainingDataError`: missing, no JSON, or another version."""
    path = Path(folder) / "boxes.json"
    content = read_json(path, "list of images, as `tools.make_training_rooms` writes it,", TrainingDataError)
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
        size = entry["width"], entry["height"]
        objects = [item for item in entry["objects"] if item["label"] in names and item["visible_box"] is not None]
        labels = np.array([names.index(item["label"]) for item in objects], dtype=np.int64)
        boxes = np.array([item["visible_box"] for item in objects], dtype=np.float32).reshape(-1, 4)
        fraction = np.array([item["visible_fraction"] for item in objects], dtype=np.float32)
        height_at_1280 = (boxes[:, 3] - boxes[:, 1]) * (1280.0 / image.shape[1])
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise TrainingDataError(
            f"{entry['file']}: a field of boxes.json is missing or of the wrong kind ({error!r}): make the folder again"
        ) from None
    if (image.shape[1], image.shape[0]) != size:
        raise TrainingDataError(
            f"{entry['file']} is {image.shape[1]} x {image.shape[0]}, boxes.json says {size[0]} x {size[1]}: make the "
            "folder again"
        )
    if not np.isfinite(boxes).all() or (boxes[:, 2:] <= boxes[:, :2]).any():
        raise TrainingDataError(f"{entry['file']} has a box that is none: expected u0 < u1 and v0 < v1, all finite")
    ignored = (fraction < LEAST_VISIBLE) | (height_at_1280 < LEAST_HEIGHT)
    if image.shape[1] != width:
        image = cv2.resize(image, (width, width // 2), interpolation=cv2.INTER_AREA)
    return LabelledPanorama(entry["file"], image, labels, boxes * np.float32(width / size[0]), ignored)
