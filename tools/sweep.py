"""Run table 1 of paper 1 for many seeds on every processor, and tell its numbers with confidence intervals.

Each seed makes a recording of its own and one that is pushed by hand; called again, the command runs what is missing.
"""

import argparse
import contextlib
import json
import re
import sys
from pathlib import Path

from courseware.commands.arguments import MAX_PARTICLES, parse_seeds, require_count, require_output_folder

CONNECT_S = 30
MAX_SEEDS = 10_000  # by their number alone; who wants more, or meant one seed, says so: A-B


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `sweep`."""
    parser.add_argument("experiment", choices=["corridor"], help="corridor: table 1 of paper 1")
    told = "N: seeds 1 to N; A-B: these (default: 20, an hour or two)"
    parser.add_argument("--seeds", default="20", metavar="N|A-B", help=told)
    parser.add_argument("--particles", type=int, default=200, metavar="N", help="number of particles (default: 200)")
    parser.add_argument("--frames", type=int, metavar="N", help="only the first N frames (default: all)")
    told = "run on the workers of Dask's scheduler there, each with this repository (default: on this machine)"
    parser.add_argument("--dask", metavar="ADDRESS", help=told)
    told = "for corridor.jsonl and corridor.json"
    parser.add_argument("--out", type=Path, default=Path("results/sweep"), metavar="FOLDER", help=told)
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs what is missing, then tells what all seeds gave."""
    from courseware.commands.output import progress_bar
    from courseware.experiments.corridor import over_recordings, table_over_recordings
    from courseware.experiments.intervals import INTERVAL_PERCENT, median_interval
    from courseware.experiments.results import write_results
    from courseware.experiments.runner import kept_rows

    seeds = seeds_of(arguments.seeds)
    require_count("--particles", arguments.particles, MAX_PARTICLES)
    require_count("--frames", arguments.frames)
    require_output_folder(arguments.out)
    points = [{"seed": seed, "frames": arguments.frames, "n_particles": arguments.particles} for seed in seeds]
    with dask(arguments.dask) if arguments.dask else contextlib.nullcontext():
        rows = kept_rows(corridor, points, arguments.out / "corridor.jsonl", progress=progress_bar("sweep", "seed"))
    result = {
        "seeds": seeds,
        "n_particles": arguments.particles,
        "frames": rows[0]["frames"],
        "interval_percent": INTERVAL_PERCENT,
        "over_recordings": over_recordings(rows, median_interval),
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


def dask(address: str) -> contextlib.AbstractContextManager:
    """Let joblib run on Dask's workers. Raises `ValueError` where nobody answers."""
    import joblib
    from dask.distributed import Client

    try:
        return joblib.parallel_config("dask", client=Client(address, timeout=CONNECT_S))
    except (OSError, ValueError) as error:
        raise ValueError(f"--dask {address}: no scheduler answers there ({error}): dask scheduler") from error


def corridor(seed: int, frames: int | None, n_particles: int) -> dict:
    """Table 1 of one seed, in any process: two recordings made, the paper's method and Fallon's run on each."""
    from courseware.experiments.corridor import METHODS_BY_HAND, table_1_of_seed
    from courseware.paths import data_path

    settings = {"recording": "own", "backend": "raster", "exact": False, "methods": METHODS_BY_HAND}
    data = str(data_path("corridor"))
    summary = table_1_of_seed(seed, data=data, particles=n_particles, frames=frames, **settings)["summary"]
    return {key: summary[key] for key in ("seed", "frames", "methods", "methods_by_hand")}


if __name__ == "__main__":
    from courseware.cli import tool

    sys.exit(tool("tools.sweep"))
