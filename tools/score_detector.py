"""Precision and recall of a detector on the experiment's room and on rooms that it was never trained on.

Without --images the unseen rooms are photographed first, which takes some minutes.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from course_lib.commands.arguments import add_detector_arguments, chosen_detector
from course_lib.files import temporary_folder
from tools.make_training_rooms import (
    FIRST_TEST_ROOM,
    FIRST_VALIDATION_ROOM,
    IMAGES_PER_ROOM,
    N_TEST_ROOMS,
    N_VALIDATION_ROOMS,
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `score-detector`."""
    add_detector_arguments(parser)
    parser.add_argument(
        "--images",
        type=Path,
        metavar="FOLDER",
        help="panoramas with boxes.json, of unseen rooms (default: photograph --rooms of them)",
    )
    parser.add_argument(
        "--rooms",
        type=int,
        default=N_TEST_ROOMS,
        metavar="N",
        help=f"how many unseen rooms to photograph (default: {N_TEST_ROOMS})",
    )
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="the experiment's room (default: data/room)")
    parser.add_argument(
        "--voting",
        action="store_true",
        help="instead compare choices of the constants by which boxes vote, on the validation rooms (or on --images)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of lines")


def run(arguments: argparse.Namespace) -> int:
    """Scores the detector; returns the exit code."""
    from itertools import chain

    from course_lib.commands.progress import progress_bar
    from course_lib.files import require_file
    from course_lib.paths import data_path
    from course_lib.simulation.room.training_images import labelled_images, make_room_images, read_image_list
    from course_lib.spherical_stereo.recording import read_stereo_recording
    from tools.detector_evaluation import labelled_panoramas, score_detector

    if arguments.rooms < 1:
        raise ValueError(f"--rooms must be at least 1; got {arguments.rooms}")
    detector = chosen_detector(arguments)
    if arguments.voting:
        return _compare_voting(arguments, detector)
    if arguments.images is not None:  # what is wrong with it is told before minutes of scoring
        for image in read_image_list(arguments.images):
            require_file(arguments.images / image["file"], "image", ValueError)
    folder = arguments.data or data_path("room")
    recordings = [read_stereo_recording(folder / f"experiment_{number}") for number in (1, 2)]
    scores = {
        "experiment_room": score_detector(
            detector,
            progress_bar("the experiment's room", "image")(chain.from_iterable(map(labelled_panoramas, recordings))),
        )
    }
    with temporary_folder() as temporary:
        images = arguments.images
        if images is None:
            images = temporary
            make_room_images(
                images, FIRST_TEST_ROOM, arguments.rooms, IMAGES_PER_ROOM, progress_bar("photographs", "room")
            )
        scores["unseen_rooms"] = score_detector(
            detector, progress_bar("unseen rooms", "image")(labelled_images(images))
        )
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


def _compare_voting(arguments: argparse.Namespace, detector) -> int:
    """Prints what each choice of the voters' constants gives; returns the exit code."""
    from course_lib.commands.progress import progress_bar
    from course_lib.simulation.room.training_images import labelled_images, make_room_images
    from course_lib.spherical_stereo.detection.suppression import VOTE_IOU, VOTE_SCORE
    from tools.detector_evaluation import NO_VOTES, compare_voting

    with temporary_folder() as temporary:
        images = arguments.images or temporary
        if arguments.images is None:
            bar = progress_bar("photographs", "room")
            make_room_images(images, FIRST_VALIDATION_ROOM, N_VALIDATION_ROOMS, IMAGES_PER_ROOM, bar)
        found = compare_voting(detector, labelled_images(images))
    if arguments.json:
        rows = [one._asdict() | {"score": one.score._asdict()} for one in found]
        print(json.dumps({"voting": rows, "used": {"vote_iou": VOTE_IOU, "vote_score": VOTE_SCORE}}))
        return 0
    print("least IoU, least score: root mean square by which box centres miss exact ones [pixels]; precision, recall")
    for one in found:
        choice = (one.vote_iou, one.vote_score)
        name = "no votes" if choice == NO_VOTES else f"{one.vote_iou:.2f}, {one.vote_score:.2f}"
        used = "  (used)" if choice == (VOTE_IOU, VOTE_SCORE) else ""
        print(
            f"  {name:12} u {one.jitter_u:.2f}, v {one.jitter_v:.2f}; {one.score.precision:.3f}, "
            f"{one.score.recall:.3f}{used}"
        )
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.score_detector"))
