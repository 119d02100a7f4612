"""Run a seeded experiment for many seeds on every processor, and tell its numbers with confidence intervals.

`sweep corridor` is table 1 of paper 1: each seed makes a recording of its own and one that is less kind, and the
methods run on both. Every seed is written to the results file when it is done; called again, the command runs what is
missing.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from contextlib import ExitStack
from pathlib import Path

from course_lib.commands.arguments import MAX_PARTICLES, parse_seeds, require_count, require_output_folder
from course_lib.files import temporary_folder

EXPERIMENTS = ("corridor",)
CONNECT_S = 30
MAX_SEEDS = 10_000  # by their number alone; who wants more, or meant one seed, says so: A-B


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `sweep`."""
    parser.add_argument("experiment", choices=EXPERIMENTS, help="corridor: table 1 of paper 1")
    parser.add_argument(
        "--seeds",
        default="20",
        metavar="N|A-B",
        help="N: seeds 1 to N; A-B: these (default: 20, an hour or two)",
    )
    parser.add_argument("--particles", type=int, default=200, metavar="N", help="number of particles (default: 200)")
    parser.add_argument("--frames", type=int, metavar="N", help="only the first N frames (default: all)")
    parser.add_argument(
        "--dask",
        metavar="ADDRESS",
        help="run on the workers of Dask's scheduler at this address (each with this repository); default: a process "
        "of this machine for each processor",
    )
    parser.add_argument(
        "--out", type=Path, default=Path("results/sweep"), metavar="FOLDER", help="for corridor.jsonl and corridor.json"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs what is missing, then tells what all seeds gave."""
    from course_lib.commands.corridor_tables import table_over_recordings
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments import sweep
    from course_lib.experiments.corridor_seeds import INTERVAL_PERCENT, median_interval, over_recordings
    from course_lib.experiments.results import write_results

    seeds = seeds_of(arguments.seeds)
    require_count("--particles", arguments.particles, MAX_PARTICLES)
    require_count("--frames", arguments.frames)
    require_output_folder(arguments.out)
    points = [{"seed": seed, "frames": arguments.frames, "n_particles": arguments.particles} for seed in seeds]
    path = arguments.out / "corridor.jsonl"
    with ExitStack() as stack:
        executor = stack.enter_context(dask_executor(arguments.dask)) if arguments.dask else None
        rows = sweep(corridor, points, executor, results=path, progress=progress_bar("sweep", "seed"))
    result = {
        "seeds": seeds,
        "n_particles": arguments.particles,
        "frames": rows[0]["result"]["frames"],
        "interval_percent": INTERVAL_PERCENT,
        "over_recordings": over_recordings([row["result"] for row in rows], median_interval),
    }
    told = f"{INTERVAL_PERCENT} % interval of the median"
    print(json.dumps(result) if arguments.json else table_over_recordings(result, told), flush=True)
    write_results(arguments.out / "corridor.json", result)
    return 0


def seeds_of(text: str) -> list[int]:
    """The seeds that `--seeds` names: a number alone is how many, from 1 on; else ranges, as everywhere."""
    if not re.fullmatch(r"\s*\d+\s*", text):
        return parse_seeds(text)
    if not 1 <= int(text) <= MAX_SEEDS:
        raise ValueError(f"--seeds {text} asks for so many seeds (1 to {MAX_SEEDS}); for one alone: {text}-{text}")
    return list(range(1, int(text) + 1))


def dask_executor(address: str):
    """An executor of Dask's workers. Raises `ValueError` where Dask is not installed or nobody answers."""
    try:
        from dask.distributed import Client
    except ImportError as error:
        raise ValueError("--dask needs Dask's scheduler: pip install distributed") from error
    try:
        return Client(address, timeout=CONNECT_S).get_executor()
    except (OSError, ValueError) as error:
        raise ValueError(
            f"--dask {address}: no scheduler answers there ({error}); start one: dask scheduler"
        ) from error


def corridor(seed: int, frames: int | None, n_particles: int) -> dict:
    """Table 1 of one seed, in any process: two recordings made, both methods run on each."""
    from course_lib.experiments.corridor_seeds import METHODS_BY_HAND, Maps, own_recordings, rows_by_part, run_rows
    from course_lib.paths import data_path

    data = data_path("corridor")
    with temporary_folder() as temporary:
        even, by_hand = own_recordings(data, temporary, seed, frames)
        options = {"seed": seed, "frames": frames, "n_particles": n_particles}
        rows = run_rows(Maps.load(data), even, by_hand, METHODS_BY_HAND, **options)
    return {"seed": seed, "frames": len(rows["proposed"].run.frames), **rows_by_part(rows)}


if __name__ == "__main__":
    from course_lib.cli import tool

    sys.exit(tool("tools.sweep"))
