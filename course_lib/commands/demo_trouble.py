"""Trouble the sensors of both methods, and tell what becomes of every frame: named, recovered, never confidently wrong.

Frames are dropped, repeated, black, frozen, half covered, saturated, out of order, badly exposed; panoramas dark,
exchanged, of different moments; at shares of the frames that --share names. What is finished is kept under --out.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from course_lib.commands.arguments import (
    parse_numbers,
    parse_seeds,
    require_count,
    require_output_folder,
    require_processes,
)

FRAMES = 100  # of a depth recording
PAIRS = 24  # of a walk with panoramas
GREATEST_SHARE = 20  # percent: with more there are hardly good frames to recover in


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo trouble`."""
    parser.add_argument(
        "--seeds",
        default="1-5",
        metavar="A-B",
        help="a recording, or a room and a walk, each (default: 1-5); tune on 10000 and above",
    )
    parser.add_argument(
        "--share", default="1,5,20", metavar="PERCENT", help="of the frames that are troubled (default: 1,5,20)"
    )
    parser.add_argument(
        "--method",
        choices=["depth", "stereo"],
        help="paper 1's filter on depth images, or paper 2's on panoramas (default: both)",
    )
    parser.add_argument(
        "--dof",
        choices=["xyyaw", "6"],
        default="xyyaw",
        help="of the depth camera: the paper's filter on a wagon (default), or the annealed one, carried by hand",
    )
    parser.add_argument(
        "--frames",
        type=int,
        metavar="N",
        help=f"of each depth recording and each walk (default: {FRAMES} depth images, {PAIRS} pairs of panoramas)",
    )
    parser.add_argument("--processes", type=int, metavar="N", help="seeds run at a time (default: one for each core)")
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="corridor data (default: data/corridor)")
    parser.add_argument("--detector", type=Path, metavar="FOLDER", help="the network (default: data/detector)")
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/trouble"),
        metavar="FOLDER",
        help="for a .jsonl and a .json each method, and trouble.png (default: results/trouble)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs the seeds that are missing, then tells what all of them gave."""
    seeds = parse_seeds(arguments.seeds)
    percents = parse_numbers("--share", arguments.share)
    if max(percents) > GREATEST_SHARE:
        raise ValueError(f"--share must be at most {GREATEST_SHARE} percent; got {max(percents)}")
    require_count("--frames", arguments.frames)
    require_processes("--processes", arguments.processes)
    require_output_folder(arguments.out)

    from course_lib.commands.trouble_table import trouble_table
    from course_lib.experiments.results import write_results
    from course_lib.files import run_folder
    from course_lib.plots.trouble_figure import trouble_figure

    methods = [arguments.method] if arguments.method else ["depth", "stereo"]
    results = {}
    for method in methods:
        name = {"depth": f"depth_{arguments.dof}", "stereo": "stereo"}[method]
        results[name] = _result(arguments, name, seeds, percents)
    print(
        json.dumps(results) if arguments.json else "\n\n".join(trouble_table(one) for one in results.values()),
        flush=True,
    )
    with run_folder(arguments.out, "demo trouble") as out:
        for name, result in results.items():
            write_results(out / f"{name}.json", result)
        trouble_figure(results).savefig(out / "trouble.png", dpi=110)
    return 0


def _result(arguments: argparse.Namespace, name: str, seeds: list[int], percents: list[int]) -> dict:
    """All seeds of one method; those that --out holds are not run again."""
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments import sweep
    from course_lib.experiments.sensor_trouble import depth_run, stereo_run
    from course_lib.experiments.sensor_trouble.depth_frames import LONGEST_RUN
    from course_lib.experiments.sensor_trouble.placing import require_fits
    from course_lib.experiments.sensor_trouble.score import summary
    from course_lib.paths import data_path
    from course_lib.processors import processors
    from course_lib.spherical_stereo.detection.detector import YoloDetector
    from course_lib.worker_pool import worker_pool

    common = {"shares": [percent / 100 for percent in percents]}
    if name == "stereo":
        detector = (arguments.detector or data_path("detector")).absolute()
        function, gate = stereo_run.room_trouble, stereo_run.GATE
        common |= {"detector": str(detector), "frames": arguments.frames or PAIRS}
        YoloDetector.load(detector)  # what is wrong with it is told now, not after the first room
    else:
        function, gate = depth_run.corridor_trouble, depth_run.GATE
        data = (arguments.data or data_path("corridor")).absolute()
        common |= {"data": str(data), "frames": arguments.frames or FRAMES, "dof": arguments.dof}
    require_fits(common["frames"], common["shares"], [1] if name == "stereo" else [1, LONGEST_RUN])
    points = [{**common, "seed": seed} for seed in seeds]
    bar = progress_bar(name, "seed")
    workers = min(arguments.processes or processors(), len(points))
    with worker_pool(workers) as pool:
        rows = sweep(function, points, pool, results=arguments.out / f"{name}.jsonl", progress=bar)
    told = summary([row["result"] for row in rows], gate)
    return {"method": name, "seeds": seeds, "frames": common["frames"], **told}
