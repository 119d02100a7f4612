"""Make data/room from its seed: stereo panoramas at the paper's places, exact boxes and poses, the semantic map."""

from __future__ import annotations

import argparse
import sys

from tools.shipped_data import add_seed_and_out, output_folder

NAME, SEED = "room", 4  # the shipped data's: of the photographs


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this tool's options to its parser."""
    add_seed_and_out(parser, NAME, SEED)


def run(arguments: argparse.Namespace) -> int:
    """Make the data; return the exit code."""
    out = output_folder(arguments, NAME, SEED)
    from course_lib.commands.output import progress_bar
    from course_lib.simulation.room.data import make_room_data

    summary = make_room_data(out, arguments.seed, progress=progress_bar("photographs", "pair"))
    print(f"wrote {summary['pairs']} pairs of a room with {summary['objects']} objects to {out}")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.make_room"))
