"""Make data/corridor from its seed: the true world, the surveyed map, the recorded runs.

Old data are replaced at the end, all at once: a run that is stopped leaves them as they were.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from course_lib.commands.arguments import require_output_folder, require_seed

SEED = 4  # the shipped data's
FOLDER = Path(__file__).resolve().parents[1] / "data" / "corridor"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds this command's options to its parser."""
    parser.add_argument("--seed", type=int, default=SEED, metavar="N", help=f"default {SEED}, the shipped data's")
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="where the data go; another seed needs it (default: data/corridor)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Makes the data and prints the measured numbers; returns the exit code."""
    require_seed(arguments.seed)
    if arguments.out is None and arguments.seed != SEED:
        raise ValueError(
            f"--seed {arguments.seed} makes other data than the shipped ones (seed {SEED}): "
            "give --out FOLDER, or data/corridor would be replaced"
        )
    out = arguments.out or FOLDER
    require_output_folder(out)
    from tqdm import tqdm

    from tools.corridor_data import make_corridor_data

    summary = make_corridor_data(
        out, arguments.seed, progress=lambda items, text: tqdm(items, desc=f"{text:28s}", ascii=True)
    )
    print(json.dumps(summary["measured"], indent=2))
    print(f"wrote {out}")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.make_corridor"))
