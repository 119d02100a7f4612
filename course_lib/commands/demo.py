"""Run an experiment of either paper and print its table."""

from __future__ import annotations

import argparse
import hashlib
import importlib
import json
from pathlib import Path

from course_lib.commands.arguments import (
    MOST_PARTICLES,
    add_backend_argument,
    parse_numbers,
    parse_seeds,
    require_count,
    require_output_folder,
    require_processes,
    require_seed,
)
from course_lib.commands.detector_options import add_detector_arguments, chosen_detector
from course_lib.commands.progress import progress_bar
from course_lib.files import run_folder, temporary_folder
from course_lib.paths import REPOSITORY, data_path

REPORTING = "1 to 99 are for reporting; tune on 10000 and above"
NETWORK_FILES = (".cfg", ".weights", ".names", ".json")  # what makes a detector what it is
OTHERS = {"experiment", "out", "json", "debug"}  # arguments that are no parameters of the experiment


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of the demo that the parser is for."""
    name = parser.prog.split()[-1]
    add_options, parser.description = DEMOS[name]
    parser.set_defaults(experiment=name)
    add_options(parser)
    parser.add_argument(
        "--out",
        type=Path,
        metavar="FOLDER",
        help="where results and figures go, and finished seeds are looked for (default: a folder of this run in "
        f"results/demo_{name}, which holds the finished seeds of all runs)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def _seeds(parser: argparse.ArgumentParser, of: str, default: str | None = None) -> None:
    told = "several seeds instead: " if default is None else ""
    usual = "" if default is None else f" (default: {default})"
    parser.add_argument(
        "--seeds", default=default, metavar="A-B", help=f"{told}{of}, such as 4, 1-20 or 1-5,8{usual}. {REPORTING}"
    )


def _corridor(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--seed", type=int, default=0, metavar="N", help="seed of the recording and of the filter (default: 0)"
    )
    _seeds(parser, "median, least and greatest over their recordings")
    parser.add_argument(
        "--recording",
        choices=["own", "shipped"],
        default="own",
        help="made anew for the seed (default), or data/corridor/wagon, where a seed is the filter's alone",
    )
    parser.add_argument(
        "--idealizations",
        action="store_true",
        help="measure instead what the simulator's idealizations are worth, on small images (seeds 10001-10003)",
    )
    parser.add_argument("--kindnesses", action="store_true", dest="idealizations", help=argparse.SUPPRESS)
    parser.add_argument(
        "--dof",
        choices=["xyyaw", "6"],
        default="xyyaw",
        help="xyyaw: the paper's experiment on a wagon (default); 6: cameras carried by hand, the annealed filter "
        "beside the paper's and the floor",
    )
    parser.add_argument(
        "--methods",
        metavar="NAMES",
        help="with --seeds: rows of the table by name, with commas, among them proposed and fallon (default: all)",
    )
    parser.add_argument("--particles", type=int, default=200, metavar="N", help="number of particles (default: 200)")
    parser.add_argument("--frames", type=int, metavar="N", help="only the first N frames (default: all)")
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="corridor data (default: data/corridor)")
    add_backend_argument(parser)


def _room(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--seed",
        type=int,
        metavar="N",
        help="of the photographs; another than 4 takes them anew (default: 4, the shipped ones)",
    )
    parser.add_argument(
        "--poses", type=int, metavar="N", help="only the first N poses of each experiment (default: all)"
    )
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="made by tools.make_room (default: data/room)")
    add_detector_arguments(parser)
    parser.add_argument(
        "--association",
        default="greedy",
        metavar="NAME",
        help="how objects are matched to the map: greedy (the paper's), hungarian, consistent (default: greedy)",
    )
    parser.add_argument(
        "--views",
        type=int,
        default=1,
        choices=(1, 2),
        help="2: with --association consistent, also follow the two views of every place as the rig turns there, with "
        "and without odometry (default: 1)",
    )
    parser.add_argument(
        "--roll",
        type=int,
        nargs="+",
        metavar="K",
        default=[],
        help="also localize from the images rolled by K columns, as if the rig had turned, and print how far the pose "
        "moves (default: not)",
    )


def _rooms(parser: argparse.ArgumentParser) -> None:
    _seeds(parser, "of the rooms", "1-20")
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
    matchers = ("greedy", "hungarian", "consistent")
    parser.add_argument(
        "--association",
        choices=matchers,
        nargs="+",
        default=list(matchers),
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
    parser.add_argument("--processes", type=int, metavar="N", help="rooms made at a time (default: one for each core)")


def _walk(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of room and walk (default: 1)")
    _seeds(parser, "told together")
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


def _lost(parser: argparse.ArgumentParser) -> None:
    _seeds(parser, "a trial each: recording, kidnapping, start", "1-3")
    parser.add_argument(
        "--recording",
        type=Path,
        metavar="FOLDER",
        help="instead of the corridor, a recording of this folder with its truth and, in map.ply, its map",
    )
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="corridor data (default: data/corridor)")


def _trouble(parser: argparse.ArgumentParser) -> None:
    _seeds(parser, "a recording, or a room and a walk, each", "1-5")
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
        help="of each depth recording and each walk (default: 100 depth images, 24 pairs of panoramas)",
    )
    parser.add_argument("--processes", type=int, metavar="N", help="seeds run at a time (default: one for each core)")
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="corridor data (default: data/corridor)")
    parser.add_argument("--detector", type=Path, metavar="FOLDER", help="the network (default: data/detector)")


def _finale(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the room (default: 1)")
    _seeds(parser, "several rooms")
    parser.add_argument("--places", type=int, default=4, metavar="N", help="random places in each room (default: 4)")
    parser.add_argument("--detector", type=Path, metavar="FOLDER", help="the network (default: data/detector)")


DEMOS = {
    "corridor": (_corridor, "Run paper 1's experiment on the simulated corridor: table 1, figures 5 and 6."),
    "room": (_room, "Run paper 2's room experiment, 20 poses at each of two heights: tables 1 to 5."),
    "rooms": (_rooms, "Run paper 2's room experiment in generated rooms of look-alikes: rates with intervals."),
    "walk": (_walk, "Carry a depth camera through generated rooms: errors in six degrees of freedom."),
    "lost": (_lost, "Kidnap the camera, start it anywhere, leave it in peace, and count how often it finds itself."),
    "trouble": (_trouble, "Trouble the sensors of both methods, and tell what becomes of every frame."),
    "finale": (_finale, "Both papers in one world: panoramas find the robot, the depth camera makes it exact."),
}


def run(arguments: argparse.Namespace) -> int:
    """Runs what is missing, prints the table, writes results and figures; returns the exit code."""
    name = arguments.experiment
    parameters = {key: value for key, value in vars(arguments).items() if key not in OTHERS}
    if arguments.out:
        require_output_folder(arguments.out)
    processes = parameters.pop("processes", None)
    require_processes("--processes", processes)
    _check(parameters)
    if "input_size" in parameters:
        detector = chosen_detector(arguments)  # what is wrong with it is told now, not after the first room
        options = {key: parameters.pop(key) for key in ("detector", "input_size", "score_threshold")}
        if name == "room":
            parameters["detector"] = detector
        else:
            parameters["network"] = _network(**options)

    from course_lib.commands.demo_figures import FIGURES
    from course_lib.experiments.runner import Runner

    experiment = importlib.import_module(f"course_lib.experiments.{name}")
    kept = arguments.out or REPOSITORY / "results" / f"demo_{name}"
    with temporary_folder() as temporary:
        outcome = experiment.run(Runner(kept, temporary, processes, progress_bar), **parameters)
        print(json.dumps(outcome.summary) if arguments.json else outcome.text, flush=True)
        with run_folder(arguments.out, f"demo {name}") as out:
            written = _write(out, outcome.files)
            if outcome.figures:
                written += FIGURES[outcome.figures](out, outcome.drawn)
    if not arguments.json:
        print(f"\nWritten: {', '.join(written)}")
    return 0


def _check(parameters: dict) -> None:
    """Check options that several demos have, and read lists of numbers."""
    if parameters.get("seed") is not None:
        require_seed(parameters["seed"])
    if parameters.get("seeds") is not None:
        parameters["seeds"] = parse_seeds(parameters["seeds"])
    for option in ("every", "share"):
        if option in parameters:
            parameters[option] = parse_numbers(f"--{option}", parameters[option])
    for option in ("frames", "poses", "places"):
        require_count(f"--{option}", parameters.get(option))
    require_count("--particles", parameters.get("particles"), MOST_PARTICLES)


def _network(detector: Path | None, input_size: list[int] | None, score_threshold: float | None):
    """The detector as finished rooms know it: with a checksum of the network's files."""
    from course_lib.experiments.observed_rooms import Network

    folder = (detector or data_path("detector")).absolute()
    digest = hashlib.sha256()
    for path in sorted(folder.iterdir()):
        if path.suffix in NETWORK_FILES and path.name != "scores.json":
            digest.update(path.name.encode() + path.read_bytes())
    return Network(str(folder), digest.hexdigest()[:16], input_size, score_threshold)


def _write(out: Path, files: dict) -> list[str]:
    from course_lib.experiments.results import write_results

    names = []
    for name, (numbers, rows) in files.items():
        write_results(out / name, numbers, rows)
        names += [name, Path(name).with_suffix(".csv").name] if rows else [name]
    return names
