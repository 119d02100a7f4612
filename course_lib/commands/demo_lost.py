"""Lost and found: kidnap the camera, start it anywhere, leave it in peace, and count who finds itself.

In the corridor every seed makes a recording of its own, carried by hand. A recording of your own needs its truth, to be
judged by. Every trial is written to the results file when it is done; called again, the command runs what is missing.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from course_lib.commands.arguments import parse_seeds, require_output_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo lost`."""
    parser.add_argument(
        "--seeds", default="1-3", metavar="A-B", help="a trial each: recording, kidnapping, start (default: 1-3)"
    )
    parser.add_argument(
        "--recording",
        type=Path,
        metavar="FOLDER",
        help="instead of the corridor, a recording of this folder with its truth and, in map.ply, its map",
    )
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="corridor data (default: data/corridor)")
    parser.add_argument(
        "--out", type=Path, default=Path("results/lost"), metavar="FOLDER", help="for lost.jsonl and lost.json"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs the trials that are missing, then tells what all of them gave."""
    from course_lib.commands.progress import progress_bar
    from course_lib.depth_mcl.sequence import read_sequence
    from course_lib.experiments import sweep
    from course_lib.experiments.lost_and_found import corridor_trial, summarize, trial
    from course_lib.experiments.results import write_results
    from course_lib.paths import data_path

    seeds = parse_seeds(arguments.seeds)
    require_output_folder(arguments.out)
    if arguments.recording:
        recording = read_sequence(arguments.recording)
        recording.require_poses()  # told now, not after the first run
        folder = arguments.recording.absolute()
        function, common = trial, {"map_file": str(folder / "map.ply"), "sequence": str(folder)}
    else:
        data = (arguments.data or data_path("corridor")).absolute()
        function, common = corridor_trial, {"data": str(data)}
    points = [{**common, "seed": seed} for seed in seeds]
    bar = progress_bar("lost and found", "trial")
    rows = sweep(function, points, results=arguments.out / "lost.jsonl", progress=bar)
    result = {"seeds": seeds, **summarize([row["result"] for row in rows])}
    print(json.dumps(result) if arguments.json else lost_table(result), flush=True)
    write_results(arguments.out / "lost.json", result)
    return 0


def lost_table(s: dict) -> str:
    """What `demo lost` prints."""
    of = f"of {s['trials']}"
    median = "-" if s["frames_to_recover"] is None else f"{s['frames_to_recover']:.0f}"
    return "\n".join(
        [
            f"kidnapped           {s['kidnapped_recovered']} {of} recovered within 30 frames (median {median})",
            f"started anywhere    {s['started_right']} {of} in the right place within 20 frames, "
            f"{s['started_wrong']} in a wrong one, {s['started_several']} said: several",
            f"                    median {s['frames_to_start']:.0f} frames, {s['particles_to_start']:,.0f} particles, "
            f"{s['seconds_to_start']:.0f} s",
            f"left in peace       {s['false_alarms']} false alarms in {s['undisturbed_frames']} frames",
        ]
    )
