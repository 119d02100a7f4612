"""Photograph generated rooms, with the exact boxes of their objects: a detector's training and test pictures.

A run that is stopped goes on where it was when the same command is given again.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from course_lib.commands.arguments import require_output_folder
from course_lib.commands.output import progress_bar

FIRST_TRAINING_ROOM, N_TRAINING_ROOMS = 1000, 400  # chosen; rooms 100 to 119 choose the threshold
IMAGES_PER_ROOM = 3
FIRST_TEST_ROOM, N_TEST_ROOMS = 200, 20


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this tool's options to its parser."""
    add, number = parser.add_argument, {"type": int, "metavar": "N"}
    add("--out", type=Path, required=True, metavar="FOLDER", help="where pictures and boxes.json go (no default)")
    what = f"seed of the first room, the others count up from it (default: {FIRST_TRAINING_ROOM})"
    add("--first-room", **number, default=FIRST_TRAINING_ROOM, help=what)
    add("--rooms", **number, default=N_TRAINING_ROOMS, help=f"how many (default: {N_TRAINING_ROOMS})")
    what = f"pictures of each; other numbers are other pictures of the same rooms (default: {IMAGES_PER_ROOM})"
    add("--images-per-room", **number, default=IMAGES_PER_ROOM, help=what)


def run(arguments: argparse.Namespace) -> int:
    """Makes the pictures; returns the exit code."""
    for option, value, least in (
        ("--first-room", arguments.first_room, 0),
        ("--rooms", arguments.rooms, 1),
        ("--images-per-room", arguments.images_per_room, 1),
    ):
        if value < least:
            raise ValueError(f"{option} must be at least {least}; got {value}")
    require_output_folder(arguments.out)
    from course_lib.simulation.room.training_images import make_room_images

    asked = arguments.first_room, arguments.rooms, arguments.images_per_room
    images = make_room_images(arguments.out, *asked, progress_bar("rooms", "room"))
    print(f"{arguments.out}: {len(images)} pictures of {len({image['room_seed'] for image in images})} rooms")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.make_training_rooms"))
