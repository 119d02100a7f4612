"""Photograph generated rooms, with the exact boxes of their objects: a detector's training and test pictures.

A run that is stopped goes on where it was when the same command is given again.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from course_lib.commands.progress import progress_bar

FIRST_TRAINING_ROOM, N_TRAINING_ROOMS = 1000, 500  # the shipped network's
FIRST_VALIDATION_ROOM, N_VALIDATION_ROOMS = 100, 20
FIRST_TEST_ROOM, N_TEST_ROOMS = 200, 20


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds this command's options to its parser."""
    parser.add_argument("--output", type=Path, required=True, metavar="FOLDER", help="where they go")
    parser.add_argument(
        "--first-room", type=int, default=FIRST_TRAINING_ROOM, metavar="N", help="seed of the first room"
    )
    parser.add_argument("--rooms", type=int, default=N_TRAINING_ROOMS, metavar="N", help="how many rooms")
    parser.add_argument(
        "--images-per-room", type=int, default=4, metavar="N", help="pictures from each room, default 4"
    )


def run(arguments: argparse.Namespace) -> int:
    """Makes the pictures; returns the exit code."""
    from course_lib.worlds.room_images import make_room_images

    images = make_room_images(
        arguments.output,
        arguments.first_room,
        arguments.rooms,
        arguments.images_per_room,
        progress_bar("rooms", "room"),
    )
    print(f"{arguments.output}: {len(images)} pictures of {len({image['room_seed'] for image in images})} rooms")
    return 0
