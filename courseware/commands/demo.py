"""Run an experiment of either paper and print its table."""

import argparse
import hashlib
import importlib
import json
from pathlib import Path

from course_lib.files import temporary_folder
from courseware.commands import arguments as options
from courseware.commands.output import progress_bar
from courseware.paths import REPOSITORY, data_path
from courseware.run_folder import run_folder

NETWORK_FILES = (".cfg", ".weights", ".names", ".json")  # what makes a detector what it is
BEARING_ONLY = "also fit each pose to the directions of the objects alone, without their distances"
OTHERS = {"experiment", "out", "json", "debug"}  # arguments that are no parameters of the experiment


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of the demo that the parser is for."""
    name = parser.prog.split()[-1]
    add_options, parser.description = DEMOS[name]
    parser.set_defaults(experiment=name)
    add_options(parser)
    told = "where results and figures go, and finished seeds are looked for (default: a folder of this run in "
    options.add_results(parser, f"{told}results/demo_{name}, which holds the finished seeds of all runs)")


def _choice(parser: argparse.ArgumentParser, option: str, told: str, choices: tuple, default=None) -> None:
    parser.add_argument(option, choices=choices, default=default, type=type(choices[0]), help=told)


def _seeds(parser: argparse.ArgumentParser, told: str, default: str | None = None) -> None:
    usual = f" (default: {default})" if default else ""
    told += f"{usual}, such as 4, 1-20 or 1-5,8. 1 to 99 are for reporting; tune on 10000 and above"
    options.add_text(parser, "--seeds", "A-B", told, default)


def _corridor(parser: argparse.ArgumentParser) -> None:
    options.add_number(parser, "--seed", "seed of the recording and of the filter (default: 0)", 0)
    _seeds(parser, "several seeds instead: median, least and greatest over their recordings")
    told = "made anew for the seed (default), or data/corridor/wagon, where a seed is the filter's alone"
    _choice(parser, "--recording", told, ("own", "shipped"), "own")
    told = "measure instead what the simulator's idealizations are worth, on small images (seeds 10001-10003)"
    options.add_flag(parser, "--idealizations", told)
    told = "the paper's experiment on a wagon (default); 6: cameras carried by hand, the annealed filter beside "
    _choice(parser, "--dof", f"xyyaw: {told}the paper's and the floor", ("xyyaw", "6"), "xyyaw")
    told = "with --seeds: rows of the table by name, with commas, among them proposed and fallon (default: all)"
    options.add_text(parser, "--methods", "NAMES", told)
    options.add_number(parser, "--particles", "number of particles (default: 200)", 200)
    options.add_number(parser, "--frames", "only the first N frames (default: all)")
    options.add_folder(parser, "--data", "corridor data (default: data/corridor)")
    options.add_backend_argument(parser)


def _room(parser: argparse.ArgumentParser) -> None:
    options.add_number(
        parser, "--seed", "of the photographs; another than 4 takes them anew (default: 4, the shipped ones)"
    )
    options.add_number(parser, "--poses", "only the first N poses of each experiment (default: all)")
    options.add_folder(parser, "--data", "made by tools.make_data room (default: data/room)")
    options.add_detector_arguments(parser)
    told = "how objects are matched to the map: greedy (the paper's), hungarian, consistent (default: greedy)"
    options.add_text(parser, "--association", "NAME", told, "greedy")
    told = "also localize from the images rolled by K columns, and print how far the pose moves (default: not)"
    parser.add_argument("--roll", type=int, nargs="+", metavar="K", default=[], help=told)
    options.add_flag(parser, "--bearing-only", BEARING_ONLY)


def _rooms(parser: argparse.ArgumentParser) -> None:
    _seeds(parser, "of the rooms", "1-20")
    options.add_number(parser, "--poses", "poses in each room at each height (default: the paper's 20)", 20)
    told = "also run the same rooms with the lower camera tilted by DEG degrees, such as 0 0.1 0.3 1 (default: not)"
    parser.add_argument("--tilts", type=float, nargs="+", default=[], metavar="DEG", help=told)
    names = ["greedy", "hungarian", "consistent"]
    told = "matchers whose answers are counted: greedy (the paper's), hungarian, consistent (default: all)"
    parser.add_argument("--association", choices=names, nargs="+", default=names, metavar="NAME", help=told)
    told = "also take N - 1 further views a few steps on, and follow them with and without odometry (default: 1)"
    options.add_number(parser, "--views", told, 1)
    told = "from how many poses of a room further views are taken, at the two heights by turns (default: --poses)"
    options.add_number(parser, "--view-poses", told)
    told = "also switch off each part of the consistent matcher's evidence, on the right map and on a wrong one"
    options.add_flag(parser, "--ablation", told)
    options.add_flag(parser, "--bearing-only", BEARING_ONLY)
    options.add_detector_arguments(parser)
    options.add_number(parser, "--processes", "rooms made at a time (default: one for each core)")


def _walk(parser: argparse.ArgumentParser) -> None:
    options.add_number(parser, "--seed", "seed of room and walk (default: 1)", 1)
    _seeds(parser, "several rooms instead, told together")
    options.add_text(parser, "--every", "NUMBERS", "thin the recordings: 1,2,4 runs each (default: 1,2,4)", "1,2,4")
    told = "with commas: annealed, recovering (it searches when lost), paper, floor, others as in compare"
    options.add_text(parser, "--methods", "NAMES", f"{told} (default: annealed,floor)", "annealed,floor")


def _lost(parser: argparse.ArgumentParser) -> None:
    _seeds(parser, "a trial each: recording, kidnapping, start", "1-3")
    told = "instead of the corridor, a recording of this folder with its truth and, in map.ply, its map"
    options.add_folder(parser, "--recording", told)
    options.add_flag(parser, "--rooms", "instead of the corridor, a generated room for each seed")
    options.add_folder(parser, "--data", "corridor data (default: data/corridor)")


def _trouble(parser: argparse.ArgumentParser) -> None:
    _seeds(parser, "a recording, or a room and a walk, each", "1-5")
    options.add_text(parser, "--share", "PERCENT", "of the frames that are troubled (default: 1,5,20)", "1,5,20")
    told = "paper 1's filter on depth images, or paper 2's on panoramas (default: both)"
    _choice(parser, "--method", told, ("depth", "stereo"))
    told = "of the depth camera: the paper's filter on a wagon (default), or the annealed one, carried by hand"
    _choice(parser, "--dof", told, ("xyyaw", "6"), "xyyaw")
    told = "of each depth recording and each walk (default: 100 depth images, 24 pairs of panoramas)"
    options.add_number(parser, "--frames", told)
    options.add_number(parser, "--processes", "seeds run at a time (default: one for each core)")
    options.add_folder(parser, "--data", "corridor data (default: data/corridor)")
    options.add_folder(parser, "--detector", "the network (default: data/detector)")


def _finale(parser: argparse.ArgumentParser) -> None:
    options.add_number(parser, "--seed", "seed of the room (default: 1)", 1)
    _seeds(parser, "several rooms instead")
    options.add_number(parser, "--places", "random places in each room (default: 4)", 4)
    options.add_folder(parser, "--detector", "the network (default: data/detector)")


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
    options.check_options(arguments)
    processes = parameters.pop("processes", None)
    options.require_processes("--processes", processes)
    if parameters.get("seeds") is not None:
        parameters["seeds"] = options.parse_seeds(parameters["seeds"])
    for option in {"every", "share"} & set(parameters):
        parameters[option] = options.parse_numbers(f"--{option}", parameters[option])
    if "input_size" in parameters:
        detector = options.chosen_detector(arguments)  # what is wrong with it is told now, not after the first room
        own = {key: parameters.pop(key) for key in ("detector", "input_size", "score_threshold")}
        parameters |= {"detector": detector} if name == "room" else {"network": _network(**own)}

    from courseware.commands.demo_figures import FIGURES
    from courseware.experiments.results import write_results
    from courseware.experiments.runner import Runner

    experiment = importlib.import_module(f"courseware.experiments.{name}")
    frames = parameters.get("frames")
    command = f"demo {name} frames {frames}" if frames else f"demo {name}"
    kept = arguments.out or REPOSITORY / "results" / command.replace(" ", "_")
    with temporary_folder() as temporary:
        outcome = experiment.run(Runner(kept, temporary, processes, progress_bar), **parameters)
        print(json.dumps(outcome.summary) if arguments.json else outcome.text, flush=True)
        with run_folder(arguments.out, command) as out:
            written = []
            for file, (numbers, rows) in outcome.files.items():
                write_results(out / file, numbers, rows)
                written += [file, Path(file).with_suffix(".csv").name] if rows else [file]
            if outcome.figures:
                written += FIGURES[outcome.figures](out, outcome.drawn)
    if not arguments.json:
        print(f"\nWritten: {', '.join(written)}")
    return 0


def _network(detector: Path | None, input_size: list[int] | None, score_threshold: float | None) -> list:
    """The detector as finished rooms know it (`observed_rooms.loaded`): with a checksum of the network's files."""
    folder = (detector or data_path("detector")).absolute()
    digest = hashlib.sha256()
    for path in sorted(folder.iterdir()):
        if path.suffix in NETWORK_FILES and path.name != "scores.json":
            digest.update(path.name.encode() + path.read_bytes())
    return [str(folder), digest.hexdigest()[:16], input_size, score_threshold]
