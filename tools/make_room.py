"""Make data/room from its seed: stereo panoramas at the paper's places, exact boxes and poses, the semantic map.

Old data are replaced at the end, all at once: a run that is stopped leaves them as they were.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from course_lib.commands.arguments import require_output_folder, require_seed

SEED = 4  # the shipped data's
FOLDER = Path(__file__).resolve().parents[1] / "data" / "room"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds this command's options to its parser."""
    parser.add_argument(
        "--seed", type=int, default=SEED, metavar="N", help=f"of the photographs (default: {SEED}, the shipped data's)"
    )
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="where the data go; another seed needs it (default: data/room)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Makes the data; returns the exit code."""
    require_seed(arguments.seed)
    if arguments.out is None and arguments.seed != SEED:
        raise ValueError(
            f"--seed {arguments.seed} makes other data than the shipped ones (seed {SEED}): "
            "give --out FOLDER, or data/room would be replaced"
        )
    out = arguments.out or FOLDER
    require_output_folder(out)
    from course_lib.commands.progress import progress_bar
    from course_lib.simulation.room.data import make_room_data

    summary = make_room_data(out, arguments.seed, progress=progress_bar("photographs", "pair"))
    print(f"wrote {summary['pairs']} pairs of a room with {summary['objects']} objects to {out}")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.make_room"))
