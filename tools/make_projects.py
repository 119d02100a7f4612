"""Make data/projects from its seeds: what two spherical cameras saw in the rooms of projects P2 and P3.

It takes half an hour on two cores. A run that is stopped goes on where it was when the same command is given again.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from course_lib.commands.arguments import require_output_folder, require_processes
from course_lib.files import staging_dir
from course_lib.paths import data_path

FOLDER = Path(__file__).resolve().parents[1] / "data" / "projects"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds this command's options to its parser."""
    add, work = parser.add_argument, Path("results/project_rooms")
    add("--out", type=Path, metavar="FOLDER", help="where the data go (default: data/projects)")
    what = f"where finished rooms are kept, and looked for (default: {work})"
    add("--work", type=Path, default=work, metavar="FOLDER", help=what)
    add("--processes", type=int, metavar="N", help="rooms made at a time (default: one for each core)")


def run(arguments: argparse.Namespace) -> int:
    """Makes the data; returns the exit code."""
    out = arguments.out or FOLDER
    require_processes("--processes", arguments.processes)
    require_output_folder(out)
    require_output_folder(arguments.work, "--work")
    from course_lib.commands.output import progress_bar
    from course_lib.lessons.project_2.rooms import make_project_rooms
    from course_lib.simulation.data_folder import checksums

    with staging_dir(out) as new:
        bar = progress_bar("rooms", "room")
        counts = make_project_rooms(new, data_path("detector"), arguments.work, arguments.processes, bar)
        (new / "SHA256SUMS").write_text(checksums(new, [f"rooms_{name}.json" for name in counts]))
    print(f"wrote {' and '.join(f'{n} views ({name})' for name, n in counts.items())} to {out}")
    return 0


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.make_projects"))
