"""Folders of panoramas with the boxes of their objects (`tools.make_training_rooms`), decoded once, held in memory."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from course_lib.experiments.room_evaluation import counts_as_object
from course_lib.simulation.room.training_images import read_image_list
from course_lib.spherical_stereo.recording import true_object

# Width of a whole panorama in memory: a 1280 x 512 network input is one and a quarter panorama, 1.25 * 1024 columns.
STORED_WIDTH = 1024


class TrainingDataError(ValueError):
    """A folder of training images that cannot be used."""


@dataclass(frozen=True)
class LabelledPanorama:
    """One panorama and its objects."""

    image: np.ndarray  # (h, 2 h, 3) uint8, BGR
    labels: np.ndarray  # (n,) class numbers
    boxes: np.ndarray  # (n, 4) float32 u_min, v_min, u_max, v_max, edge coordinates; u_max may pass the width
    ignored: np.ndarray  # (n,) boolean: too much hidden or too small to count


def read_panoramas(
    folders: list[Path], names: list[str], width: int = STORED_WIDTH, part: tuple[int, int] = (0, 1)
) -> list[LabelledPanorama]:
    """Every panorama of folders, scaled to `width` columns. Raises `TrainingDataError` when there is no image.

    part: (k, n) reads every n-th image only, from the k-th on: each of n processes then holds its share.
    """
    found = []
    for folder in folders:
        for entry in read_image_list(folder)[part[0] :: part[1]]:
            image = cv2.imread(str(Path(folder) / entry["file"]), cv2.IMREAD_COLOR)
            if image is not None:  # the others are still being made
                found.append(labelled_panorama(entry, image, names, width))
    if not found:
        listed = ", ".join(map(str, folders))
        raise TrainingDataError(f"{listed}: boxes.json names no image that is there; make the images first")
    return found


def labelled_panorama(entry: dict, image: np.ndarray, names: list[str], width: int) -> LabelledPanorama:
    """One entry of boxes.json with its image, scaled to `width` columns; labels not in `names` are background."""
    recorded = image.shape[1]
    objects = [thing for thing in map(true_object, entry["objects"]) if thing.label in names]
    labels = np.array([names.index(thing.label) for thing in objects], dtype=np.int64)
    boxes = np.array([thing.visible_box for thing in objects], dtype=np.float32).reshape(-1, 4)
    ignored = np.array([not counts_as_object(thing, recorded) for thing in objects], dtype=bool)
    if recorded != width:
        image = cv2.resize(image, (width, width // 2), interpolation=cv2.INTER_AREA)
    return LabelledPanorama(image, labels, boxes * np.float32(width / recorded), ignored)
