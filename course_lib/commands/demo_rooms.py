"""Run paper 2's room experiment in rooms of look-alikes that nobody shaped, made on the fly; print rates and errors.

A room takes two minutes of one core. What is finished is kept under --out, and used again when the same rooms are
asked for.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from dataclasses import replace
from functools import partial
from pathlib import Path

from course_lib.commands.arguments import parse_seeds, require_count, require_output_folder, require_processes
from course_lib.commands.detector_options import add_detector_arguments, chosen_detector
from course_lib.files import run_folder
from course_lib.processors import processors

SEEDS = "1-20"
NETWORK_FILES = (".cfg", ".weights", ".names", ".json")  # what makes a detector what it is
MATCHERS = ("greedy", "hungarian", "consistent")
GREATEST_TILT_DEG = 10.0  # of the lower camera: beyond it no pair of images matches


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo rooms`."""
    parser.add_argument(
        "--seeds",
        default=SEEDS,
        metavar="A-B",
        help=f"of the rooms: a number, a range, or several with commas (default: {SEEDS}). 1 to 99 are for reporting; "
        "tune on 10000 and above",
    )
    parser.add_argument(
        "--poses", type=int, default=20, metavar="N", help="poses in each room at each height (default: the paper's 20)"
    )
    parser.add_argument(
        "--tilts",
        type=float,
        nargs="+",
        default=[],
        metavar="DEG",
        help="also run the same rooms with the lower camera tilted by exactly DEG degrees against the upper one, and "
        "print the errors (default: not at all), for example 0 0.1 0.3 1",
    )
    parser.add_argument(
        "--association",
        choices=MATCHERS,
        nargs="+",
        default=list(MATCHERS),
        metavar="NAME",
        help="matchers whose answers within 0.5 m and 10 degrees are counted: greedy (the paper's), hungarian, "
        "consistent (default: all three)",
    )
    parser.add_argument(
        "--views",
        type=int,
        default=1,
        metavar="N",
        help="also take N - 1 further views, a few steps on from the first poses, and follow them with and without "
        "odometry (default: 1, one view)",
    )
    parser.add_argument(
        "--view-poses",
        type=int,
        metavar="N",
        help="from how many poses of a room further views are taken, at the two heights by turns (default: --poses)",
    )
    parser.add_argument(
        "--ablation",
        action="store_true",
        help="also switch off each part of the consistent matcher's evidence, on the right map and on a wrong one",
    )
    add_detector_arguments(parser)
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/rooms"),
        metavar="FOLDER",
        help="where results go, and finished rooms are looked for (default: results/rooms)",
    )
    parser.add_argument("--processes", type=int, metavar="N", help="rooms made at a time (default: one for each core)")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the tables")


def run(arguments: argparse.Namespace) -> int:
    """Runs the experiment; returns the exit code."""
    seeds = parse_seeds(arguments.seeds)
    require_count("--poses", arguments.poses)
    require_processes("--processes", arguments.processes)
    for tilt in arguments.tilts:
        if not 0 <= tilt <= GREATEST_TILT_DEG:
            raise ValueError(f"--tilts must be between 0 and {GREATEST_TILT_DEG:g} degrees; got {tilt:g}")
    view_poses = arguments.poses if arguments.view_poses is None else arguments.view_poses
    if arguments.views < 1 or not 1 <= view_poses <= arguments.poses:
        raise ValueError(
            f"--views must be at least 1, and --view-poses between 1 and --poses ({arguments.poses}); got "
            f"{arguments.views} and {view_poses}"
        )
    if "consistent" not in arguments.association and (arguments.views > 1 or arguments.ablation):
        raise ValueError("--views above 1 and --ablation are of the consistent matcher: name it with --association")
    require_output_folder(arguments.out)
    chosen_detector(arguments)  # What is wrong with it is told now, not after the first room.

    from course_lib.commands.look_alike_tables import answer_tables
    from course_lib.commands.progress import progress_bar
    from course_lib.commands.rooms_tables import tables, tilt_table
    from course_lib.experiments.look_alikes import answers_summary
    from course_lib.experiments.results import write_results
    from course_lib.experiments.room_views import ViewsOptions, observe_views
    from course_lib.experiments.rooms import RoomsOptions, observe_rooms
    from course_lib.experiments.rooms_summary import judge_rooms, pose_rows, rooms_summary
    from course_lib.plots.look_alike_figures import risk_coverage_figure
    from course_lib.simulation.room.look_alike_recording import RecordingModels

    options = RoomsOptions(arguments.poses, RecordingModels(), detector_identity(arguments))
    processes = arguments.processes or processors()
    load = partial(chosen_detector, arguments)
    rooms = observe_rooms(seeds, options, load, arguments.out / "rooms", processes, progress_bar("rooms", "room"))
    judged = judge_rooms(rooms)
    summary = rooms_summary(rooms, judged)
    views = None
    if arguments.views > 1:
        walked = ViewsOptions(replace(options, poses=view_poses), arguments.views)
        bar = progress_bar("further views", "room")
        folder = arguments.out / f"views_{arguments.views}"
        views = observe_rooms(seeds, walked, load, folder, processes, bar, observe_views)
    summary["answers"] = answers_summary(
        rooms, arguments.association, views, arguments.ablation, progress_bar("matching", "room")
    )
    for tilt in arguments.tilts:
        tilted = replace(options, models=replace(options.models, tilt_deg=tilt))
        bar = progress_bar(f"rooms, tilt {tilt:g} degrees", "room")
        rooms = observe_rooms(seeds, tilted, load, arguments.out / f"rooms_tilt_{tilt:g}", processes, bar)
        both = rooms_summary(rooms, judge_rooms(rooms))["both"]
        summary.setdefault("tilts", {})[f"{tilt:g}"] = both
    text = f"{tables(summary)}\n\n{answer_tables(summary['answers'])}"
    text += "\n\n" + tilt_table(summary["tilts"]) if arguments.tilts else ""
    print(json.dumps(summary) if arguments.json else text, flush=True)
    with run_folder(arguments.out, "demo rooms") as out:
        write_results(out / "rooms.json", summary, pose_rows(judged))
        if "risk_coverage" in summary["answers"]:
            figure = risk_coverage_figure({"consistent, one view": summary["answers"]["risk_coverage"]})
            figure.savefig(out / "risk_coverage.png", dpi=110)
    if not arguments.json:
        print(
            f"\nWritten to {arguments.out}: rooms.json, rooms.csv; the rooms' observations in {arguments.out / 'rooms'}"
        )
    return 0


def detector_identity(arguments: argparse.Namespace) -> str:
    """Words by which a stored room knows its detector: a checksum of the network's files, and the options."""
    from course_lib.paths import data_path

    folder = arguments.detector or data_path("detector")
    digest = hashlib.sha256()
    for path in sorted(folder.iterdir()):
        if path.suffix in NETWORK_FILES and path.name != "scores.json":
            digest.update(path.name.encode() + path.read_bytes())
    return f"{digest.hexdigest()[:16]}, input {arguments.input_size}, threshold {arguments.score_threshold}"
