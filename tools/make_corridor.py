"""Make data/corridor from its seed: the true world, the surveyed map, the recorded runs."""

from __future__ import annotations

import argparse
import json
import sys

from tools.shipped_data import add_seed_and_out, output_folder

NAME, SEED = "corridor", 4  # the shipped data's


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this tool's options to its parser."""
    add_seed_and_out(parser, NAME, SEED)


def run(arguments: argparse.Namespace) -> int:
    """Make the data and print the measured numbers; return the exit code."""
    out = output_folder(arguments, NAME, SEED)
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
