"""Both papers in one world: panoramas find the robot in a furnished room, the depth camera makes it exact.

Every seed makes a room of look-alike furniture, its semantic map and its laser-scanned mesh map; the robot stands at
random places. A room takes some minutes; what is finished is kept under --out.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from course_lib.commands.arguments import parse_seeds, require_output_folder


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo finale`."""
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the room (default: 1)")
    parser.add_argument("--seeds", metavar="A-B", help="several rooms instead")
    parser.add_argument("--places", type=int, default=4, metavar="N", help="random places in each room (default: 4)")
    parser.add_argument("--detector", type=Path, metavar="FOLDER", help="the network (default: data/detector)")
    parser.add_argument(
        "--out", type=Path, default=Path("results/finale"), metavar="FOLDER", help="for finale.jsonl and finale.json"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs the rooms that are missing, then tells what all places gave."""
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments import sweep
    from course_lib.experiments.finale import finale_room, summarize
    from course_lib.experiments.results import write_results
    from course_lib.paths import data_path
    from course_lib.spherical_stereo.detection.detector import YoloDetector

    seeds = parse_seeds(arguments.seeds if arguments.seeds is not None else str(arguments.seed))
    if arguments.places < 1:
        raise ValueError(f"--places must be at least 1; got {arguments.places}")
    require_output_folder(arguments.out)
    detector = (arguments.detector or data_path("detector")).absolute()
    YoloDetector.load(detector)  # what is wrong with it is told now, not after the first room
    points = [{"seed": seed, "places": arguments.places, "detector": str(detector)} for seed in seeds]
    bar = progress_bar("finale", "room")
    rows = sweep(finale_room, points, results=arguments.out / "finale.jsonl", progress=bar)
    places = [place for row in rows for place in row["result"]]
    result = {"seeds": seeds, **summarize(places)}
    print(json.dumps(result) if arguments.json else finale_text(result), flush=True)
    write_results(arguments.out / "finale.json", result)
    return 0


def finale_text(result: dict) -> str:
    """The numbers of `experiments.finale.summarize` in words."""
    from course_lib.experiments.finale import REACHED

    def told(value: float | None, digits: int) -> str:
        return "-" if value is None else f"{value:.{digits}f}"

    return (
        f"{result['reached']} of {result['places']} places reached within {REACHED[0]:g} m and {REACHED[1]:g} degree\n"
        f"panoramas: {result['semantic_ok']} answered, median {told(result['median_semantic_m'], 3)} m; "
        f"{result['started_from_several']} left several poses to the depth camera\n"
        f"then the depth camera: median {told(result['median_position_m'], 4)} m, "
        f"{told(result['median_rotation_deg'], 2)} degrees; at {result['looked_again']} places only after the robot "
        "had turned and looked again\n"
        f"not reached: {result['wrong_called_tracked']} called tracked, {result['left_open']} left open"
    )
