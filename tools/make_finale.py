"""Make data/finale from its seed: the semantic map and the mesh map of the room in which both methods meet.

Old data are replaced at the end, all at once: a run that is stopped leaves them as they were.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from course_lib.commands.arguments import require_output_folder, require_seed

SEED = 10_001  # the shipped data's
FOLDER = Path(__file__).resolve().parents[1] / "data" / "finale"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds this command's options to its parser."""
    parser.add_argument(
        "--seed", type=int, default=SEED, metavar="N", help=f"of the room (default: {SEED}, the shipped data's)"
    )
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="where the data go; another seed needs it (default: data/finale)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Makes the data; returns the exit code."""
    require_seed(arguments.seed)
    if arguments.out is None and arguments.seed != SEED:
        raise ValueError(
            f"--seed {arguments.seed} makes other data than the shipped ones (seed {SEED}): "
            "give --out FOLDER, or data/finale would be replaced"
        )
    out = arguments.out or FOLDER
    require_output_folder(out)
    from course_lib.simulation.room.finale_data import make_finale_data

    summary = make_finale_data(out, arguments.seed)
    print(f"wrote the maps of a room with {summary['objects']} objects, {summary['triangles']} triangles, to {out}")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.make_finale"))
