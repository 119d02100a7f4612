"""What the tools that make shipped data have in common: the seed and the folder.

Old data are replaced at the end, all at once: a run that is stopped leaves them as they were.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from course_lib.commands.arguments import require_output_folder, require_seed

DATA = Path(__file__).resolve().parents[1] / "data"


def add_seed_and_out(parser: argparse.ArgumentParser, name: str, seed: int) -> None:
    """Declare `--seed` and `--out` of the tool that makes data/NAME."""
    parser.add_argument("--seed", type=int, default=seed, metavar="N", help=f"default {seed}, the shipped data's")
    what = f"where the data go; another seed needs it (default: data/{name})"
    parser.add_argument("--out", type=Path, metavar="FOLDER", help=what)


def output_folder(arguments: argparse.Namespace, name: str, seed: int) -> Path:
    """Where the data go. Raises `ValueError` where they cannot, or would replace the shipped ones by others."""
    require_seed(arguments.seed)
    if arguments.out is None and arguments.seed != seed:
        raise ValueError(
            f"--seed {arguments.seed} makes other data than the shipped ones (seed {seed}): "
            f"give --out FOLDER, or data/{name} would be replaced"
        )
    out = arguments.out or DATA / name
    require_output_folder(out)
    return out
