"""Photographs of many rooms (`make_room`) with their boxes: what a detector is trained and tested on."""

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np

from course_lib.files import atomic_write, read_json
from course_lib.spherical_stereo.panorama import read_panorama
from courseware.simulation.room.furnishing import make_room
from courseware.simulation.room.scene import free_places
from courseware.simulation.room.stereo_photographs import box_entries
from courseware.simulation.room.stereo_recording import TrueObject, true_object
from courseware.simulation.sensors import panorama_rig
from courseware.simulation.sensors.panorama_renderer import PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import NEARLY_PERFECT_RIG, PanoramaCameraModel

VERSION = 1
BOXES_FILE = "boxes.json"
WIDTH = 1280  # pixels
CAMERA_HEIGHTS = (0.9, 1.6)  # m above the floor, lowest and highest; chosen around the paper's 1.02 to 1.44

# Wider ranges than the experiment's camera has, so that what is learned holds for other cameras too; chosen.
TRAINING_CAMERA = PanoramaCameraModel(
    exposure_stops=0.4, white_balance=0.06, shot_noise=0.35, read_noise=1.5, jpeg_quality=(86, 93)
)

Progress = Callable[[Iterable], Iterable]


def make_room_images(
    folder: str | Path, first_seed: int, n_rooms: int, images_per_room: int = 4, progress: Progress = iter
) -> list[dict]:
    """Photograph `n_rooms` rooms from `first_seed` on; go on where an earlier run in the folder stopped.

    Writes NNNNNN_K.jpg (room, photograph) and boxes.json, complete after every room; returns the list in it.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    images = read_image_list(folder) if (folder / BOXES_FILE).exists() else []
    done = Counter(image["room_seed"] for image in images)
    if set(done.values()) - {images_per_room}:  # the places of a room's images are drawn first
        raise ValueError(f"{folder} was begun with another number of images of a room: give another folder")
    for seed in progress(range(first_seed, first_seed + n_rooms)):
        if seed not in done:
            images += _photograph_room(folder, seed, images_per_room)
            atomic_write(folder / BOXES_FILE, json.dumps({"version": VERSION, "images": images}))
    return images


def read_image_list(folder: str | Path) -> list[dict]:
    """The images of a folder with their objects, from its boxes.json. Raises `FileNotFoundError`, `ValueError`."""
    path = Path(folder) / BOXES_FILE
    content = read_json(path, "list of images", ValueError, missing=FileNotFoundError)
    if content.get("version") != VERSION:
        raise ValueError(f"{path}: version {content.get('version')!r}; this program reads version {VERSION}")
    return content["images"]


def labelled_images(folder: str | Path) -> Iterator[tuple[np.ndarray, list[TrueObject]]]:
    """Every image `(H, W, 3)` BGR of a folder with everything that can be seen on it."""
    for image in read_image_list(folder):
        things = [true_object(entry) for entry in image["objects"]]
        yield read_panorama(Path(folder) / image["file"]).image, things


def _photograph_room(folder: Path, seed: int, count: int) -> list[dict]:
    room_rng, rng = np.random.default_rng(seed).spawn(2)
    room = make_room(room_rng)
    images = []
    with PanoramaRenderer(room, WIDTH, number_scale=1) as renderer:
        for index, (x, y) in enumerate(free_places(room, count, rng)):
            pose = x, y, rng.uniform(-np.pi, np.pi)
            rig = panorama_rig.stand_up(pose, rng.uniform(*CAMERA_HEIGHTS), 0.3, NEARLY_PERFECT_RIG, rng)
            state, _ = rig.camera_states()
            name = f"{seed:06d}_{index}.jpg"
            panorama_rig.write_photograph(folder / name, renderer.render(state), TRAINING_CAMERA, rng)
            size = {"width": WIDTH, "height": WIDTH // 2}
            images.append({"file": name, "room_seed": seed, **size, "objects": box_entries(renderer, state)})
    return images
