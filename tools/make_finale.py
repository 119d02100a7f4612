"""Make data/finale from its seed: the semantic map and the mesh map of the room in which both methods meet."""

from __future__ import annotations

import argparse
import sys

from tools.shipped_data import add_seed_and_out, output_folder

NAME, SEED = "finale", 10_001  # the shipped data's: of the room


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add this tool's options to its parser."""
    add_seed_and_out(parser, NAME, SEED)


def run(arguments: argparse.Namespace) -> int:
    """Make the data; return the exit code."""
    out = output_folder(arguments, NAME, SEED)
    from course_lib.simulation.room.finale_data import make_finale_data

    summary = make_finale_data(out, arguments.seed)
    print(f"wrote the maps of a room with {summary['objects']} objects, {summary['triangles']} triangles, to {out}")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.make_finale"))
