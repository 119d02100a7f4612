"""Measure precision and recall of a detector, at IoU 0.5, on the experiment's room and on unseen rooms.

The unseen rooms are photographed first, which takes some minutes.
"""

import argparse
import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np

from course_lib.files import temporary_folder
from course_lib.spherical_stereo.panorama import read_panorama
from courseware.commands.arguments import add_detector_arguments, chosen_detector
from courseware.commands.output import progress_bar
from courseware.experiments.room_evaluation import match_detections
from courseware.paths import data_path
from courseware.simulation.room.furnishing import make_room
from courseware.simulation.room.scene import free_places
from courseware.simulation.room.stereo_photographs import box_entries
from courseware.simulation.room.stereo_recording import StereoRecording, TrueObject, read_stereo_recording, true_object
from courseware.simulation.sensors import panorama_rig
from courseware.simulation.sensors.panorama_renderer import PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import NEARLY_PERFECT_RIG, PanoramaCameraModel

FIRST_TEST_ROOM, N_TEST_ROOMS = 200, 20  # the training had rooms from 1000 up, its threshold rooms 100 to 119
IMAGES_PER_ROOM = 3
WIDTH = 1280  # pixels
CAMERA_HEIGHTS = (0.9, 1.6)  # m above the floor, lowest and highest; chosen around the paper's 1.02 to 1.44

# Wider ranges than the experiment's camera has. The detector was trained on photographs of this camera.
CAMERA = PanoramaCameraModel(
    exposure_stops=0.4, white_balance=0.06, shot_noise=0.35, read_noise=1.5, jpeg_quality=(86, 93)
)

Labelled = Iterable[tuple[np.ndarray, Sequence[TrueObject]]]
"""Panoramas `(H, W, 3)` BGR, each with everything that can be seen on it."""


class DetectionScoreError(ValueError):
    """Panoramas on which a detector cannot be scored."""


class DetectorScore(NamedTuple):
    """How well a detector did, at IoU 0.5."""

    images: int
    objects: int  # to be found: half visible, 30 pixels high at a width of 1280
    found: int
    false_alarms: int

    @property
    def precision(self) -> float:
        """Return the share of right detections among those that count; nan without any."""
        return self.found / (self.found + self.false_alarms) if self.found + self.false_alarms else float("nan")

    @property
    def recall(self) -> float:
        """Return the share of the objects that were found."""
        return self.found / self.objects


def score_detector(detector, labelled: Labelled) -> DetectorScore:
    """Run a detector over panoramas and count; objects that do not count are neither hit nor false alarm.

    Raises `DetectionScoreError` when there is no object to find. Source: paper 2, section 2.2.
    """
    matchings = [match_detections(detector.detect(image), things, image.shape[1]) for image, things in labelled]
    n_objects, found = sum(one.n_objects for one in matchings), sum(int(one.correct.sum()) for one in matchings)
    if n_objects == 0:
        raise DetectionScoreError("there is no object to be found in these panoramas, so recall is not defined")
    return DetectorScore(len(matchings), n_objects, found, sum(len(one.correct) for one in matchings) - found)


def labelled_panoramas(recording: StereoRecording) -> Labelled:
    """Yield every image of a recording with its objects."""
    for pair in recording.pairs:
        upper, lower = pair.images()
        yield upper, pair.upper_objects
        yield lower, pair.lower_objects


def photographs(seed: int) -> Iterator[tuple[np.ndarray, list[TrueObject]]]:
    """Yield the photographs of the generated room `seed`, each with everything that can be seen on it."""
    room_rng, rng = np.random.default_rng(seed).spawn(2)
    room = make_room(room_rng)
    with temporary_folder() as folder, PanoramaRenderer(room, WIDTH, number_scale=1) as renderer:
        for x, y in free_places(room, IMAGES_PER_ROOM, rng):
            pose = x, y, rng.uniform(-np.pi, np.pi)
            rig = panorama_rig.stand_up(pose, rng.uniform(*CAMERA_HEIGHTS), 0.3, NEARLY_PERFECT_RIG, rng)
            state, _ = rig.camera_states()
            path = folder / "photograph.jpg"
            panorama_rig.write_photograph(path, renderer.render(state), CAMERA, rng)
            yield read_panorama(path).image, [true_object(entry) for entry in box_entries(renderer, state)]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `score_detector`."""
    add_detector_arguments(parser)
    add = parser.add_argument
    what = f"how many unseen rooms to photograph (default: {N_TEST_ROOMS})"
    add("--rooms", type=int, default=N_TEST_ROOMS, metavar="N", help=what)
    add("--data", type=Path, metavar="FOLDER", help="the experiment's room (default: data/room)")
    add("--json", action="store_true", help="print one JSON object instead of lines")


def run(arguments: argparse.Namespace) -> int:
    """Score the detector; return the exit code."""
    if arguments.rooms < 1:
        raise ValueError(f"--rooms must be at least 1; got {arguments.rooms}")
    detector = chosen_detector(arguments)
    folder = arguments.data or data_path("room")
    recordings = [read_stereo_recording(folder / f"experiment_{number}") for number in (1, 2)]
    shipped = progress_bar("the experiment's room", "image")(chain.from_iterable(map(labelled_panoramas, recordings)))
    rooms = progress_bar("unseen rooms", "room")(range(FIRST_TEST_ROOM, FIRST_TEST_ROOM + arguments.rooms))
    scores = {
        "experiment_room": score_detector(detector, shipped),
        "unseen_rooms": score_detector(detector, chain.from_iterable(map(photographs, rooms))),
    }
    if arguments.json:
        results = {k: one._asdict() | {"precision": one.precision, "recall": one.recall} for k, one in scores.items()}
        print(json.dumps(results | {"score_threshold": detector.score_threshold}))
        return 0
    for name, score in scores.items():
        print(
            f"{name.replace('_', ' ')}: precision {score.precision:.3f}, recall {score.recall:.3f} "
            f"({score.images} images, {score.objects} objects, score at least {detector.score_threshold:.3f})"
        )
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.score_detector"))
