"""A depth camera carried by hand through generated rooms: errors in six degrees of freedom, and being lost said.

Each seed makes a room, its laser-scanned map and a walk. Every `--every`-th frame, from every offset, is as if the
camera had been moved so much faster. A seed takes a minute or two; what is finished is kept under --out.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from course_lib.commands.arguments import parse_numbers, parse_seeds, require_output_folder
from course_lib.files import run_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo walk`."""
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of room and walk (default: 1)")
    parser.add_argument("--seeds", metavar="A-B", help="several rooms instead, told together")
    parser.add_argument(
        "--every", default="1,2,4", metavar="NUMBERS", help="thin the recordings: 1,2,4 runs each (default: 1,2,4)"
    )
    parser.add_argument(
        "--methods",
        default="annealed,floor",
        metavar="NAMES",
        help="with commas: annealed, paper, floor, or the annealed filter with one idea switched off, as in compare "
        "(default: annealed,floor)",
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/walk"),
        metavar="FOLDER",
        help="for walk.jsonl, walk.json, covariance.png",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs the rooms that are missing, then tells what all of them gave."""
    from course_lib.commands.progress import progress_bar
    from course_lib.commands.six_degrees_table import row_name, six_degrees_table
    from course_lib.experiments import sweep
    from course_lib.experiments.results import write_results
    from course_lib.experiments.six_degrees import pooled, require_methods
    from course_lib.experiments.walks import room_walk
    from course_lib.plots.covariance_figure import covariance_figure

    seeds = parse_seeds(arguments.seeds if arguments.seeds is not None else str(arguments.seed))
    everies = parse_numbers("--every", arguments.every)
    methods = require_methods(arguments.methods)
    require_output_folder(arguments.out)
    points = [{"seed": seed, "methods": methods, "everies": everies} for seed in seeds]
    runs: dict[str, list[dict]] = {}
    for row in sweep(room_walk, points, results=arguments.out / "walk.jsonl", progress=progress_bar("walking", "room")):
        for one in row["result"]:
            thinned = "" if one["method"] == "floor" else f", every {one['every']}"
            runs.setdefault(row_name(one["method"]) + thinned, []).append(one["run"])
    rows = {name: pooled(own) for name, own in runs.items()}
    print(json.dumps({"seeds": seeds, "rows": rows}) if arguments.json else six_degrees_table(rows), flush=True)
    with run_folder(arguments.out, "demo walk") as out:
        write_results(out / "walk.json", {"seeds": seeds, "rows": rows})
        covariance_figure(runs).savefig(out / "covariance.png", dpi=110)
    return 0
