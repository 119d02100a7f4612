"""Precision and recall of a detector on the experiment's room and on rooms that it was never trained on.

Without --images the unseen rooms are photographed first, which takes some minutes.
"""

import argparse
import json
import sys
from pathlib import Path

from course_lib.files import temporary_folder
from courseware.commands.arguments import add_detector_arguments, chosen_detector
from tools.make_data import FIRST_TEST_ROOM, IMAGES_PER_ROOM, N_TEST_ROOMS


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `score_detector`."""
    add_detector_arguments(parser)
    add = parser.add_argument
    what = "panoramas with boxes.json, of unseen rooms (default: photograph --rooms of them)"
    add("--images", type=Path, metavar="FOLDER", help=what)
    what = f"how many unseen rooms to photograph (default: {N_TEST_ROOMS})"
    add("--rooms", type=int, default=N_TEST_ROOMS, metavar="N", help=what)
    add("--data", type=Path, metavar="FOLDER", help="the experiment's room (default: data/room)")
    add("--json", action="store_true", help="print one JSON object instead of lines")


def run(arguments: argparse.Namespace) -> int:
    """Score the detector; return the exit code."""
    from itertools import chain

    from course_lib.files import require_file
    from courseware.commands.output import progress_bar
    from courseware.paths import data_path
    from courseware.simulation.room.stereo_recording import read_stereo_recording
    from tools.detector_evaluation import labelled_panoramas, score_detector
    from tools.training_images import labelled_images, make_room_images, read_image_list

    if arguments.rooms < 1:
        raise ValueError(f"--rooms must be at least 1; got {arguments.rooms}")
    detector = chosen_detector(arguments)
    if arguments.images is not None:  # what is wrong with it is told before minutes of scoring
        for image in read_image_list(arguments.images):
            require_file(arguments.images / image["file"], "image", ValueError)
    folder, scores = arguments.data or data_path("room"), {}
    recordings = [read_stereo_recording(folder / f"experiment_{number}") for number in (1, 2)]
    labelled = progress_bar("the experiment's room", "image")(chain.from_iterable(map(labelled_panoramas, recordings)))
    scores["experiment_room"] = score_detector(detector, labelled)
    with temporary_folder() as temporary:
        images = arguments.images or temporary
        if arguments.images is None:
            bar = progress_bar("photographs", "room")
            make_room_images(images, FIRST_TEST_ROOM, arguments.rooms, IMAGES_PER_ROOM, bar)
        labelled = progress_bar("unseen rooms", "image")(labelled_images(images))
        scores["unseen_rooms"] = score_detector(detector, labelled)
    results = {
        name: {**score._asdict(), "precision": score.precision, "recall": score.recall}
        for name, score in scores.items()
    }
    results["score_threshold"] = detector.score_threshold
    if arguments.json:
        print(json.dumps(results))
    else:
        for name, score in scores.items():
            print(
                f"{name.replace('_', ' ')}: precision {score.precision:.3f}, recall {score.recall:.3f} "
                f"({score.images} images, {score.objects} objects, score at least {detector.score_threshold:.3f})"
            )
    return 0


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.score_detector"))
