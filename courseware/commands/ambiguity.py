"""Show where in a semantic map a stereo rig would confuse which of its objects, before any run.

At every place of a grid the command draws what the rig would see there, and a matcher says where it believes it is.
"""

import argparse
from pathlib import Path

from courseware.commands import arguments as options
from courseware.commands.output import print_and_write, progress_bar

OUT = Path("results/ambiguity")
OUT_HELP = f"write ambiguity.json and a picture for each matcher here (default: {OUT.as_posix()})"
MIN_SHARE = 0.001  # of the belief, below which a pair is not listed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    options.add_semantic_map(parser)
    told = "the matchers to ask, with commas (default: greedy,consistent)"
    options.add_text(parser, "--association", "NAMES", told, "greedy,consistent")
    told = "distance between places (default: 0.5)"
    parser.add_argument("--step", type=float, default=0.5, metavar="METRES", help=told)
    options.add_number(parser, "--draws", "views drawn at each place (default: 4)", 4)
    options.add_number(parser, "--seed", "seed of the views (default: 1)", 1)
    options.add_results(parser, OUT_HELP, OUT)


def run(arguments: argparse.Namespace) -> int:
    """Draw the views, print the table, and make a picture for each matcher."""
    import numpy as np

    from course_lib.beyond.look_alikes.matchers import matcher
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap
    from courseware.experiments.ambiguity import ambiguity_map
    from courseware.experiments.results import write_results
    from courseware.plots.room_figures import ambiguity_figure

    names, step = arguments.association.split(","), arguments.step
    for name in names:
        matcher(name)  # raises an error for a name that does not exist
    options.require_positive("--step", step, "metres")
    options.check_options(arguments)
    semantic_map = SemanticMap.load(arguments.map)
    results, figures = {}, {}
    for name in names:
        rng, bar = np.random.default_rng(arguments.seed), progress_bar(name, "place")
        found = ambiguity_map(semantic_map, rng, step, arguments.draws, association=name, progress=bar)
        if not len(found.places):
            raise ValueError(f"no place of {arguments.map} is free at steps of {step:g} m: give a smaller --step")
        results[name] = ambiguity_numbers(found, semantic_map)
        figures[name] = ambiguity_figure(semantic_map, found, f"{arguments.map.name}, matched by {name}")
    summary = {"map": str(arguments.map), "step_m": step, "draws": arguments.draws, "seed": arguments.seed}
    summary["matchers"] = results

    def write(out: Path) -> list[str]:
        write_results(out / "ambiguity.json", summary)
        for name, figure in figures.items():
            figure.savefig(out / f"ambiguity_{name}.png", dpi=110)
        return []

    text = "\n\n".join(ambiguity_text(name, numbers) for name, numbers in results.items())
    print_and_write(arguments, "ambiguity", summary, text, write, "\nPictures: {out}/ambiguity_*.png")
    return 0


def ambiguity_numbers(found, semantic_map) -> dict:
    """Return an ambiguity map in numbers, for JSON. Landmarks are numbered from 0, in the map's order."""
    from course_lib.beyond.look_alikes.confidence import MIN_CONFIDENCE

    return {
        "places": len(found.places),
        "mean_confidence": float(found.confidence.mean()),
        "sure_percent": float(100.0 * (found.confidence >= MIN_CONFIDENCE).mean()),
        "confused": [
            {
                "landmarks": [i, j],
                "labels": [semantic_map.landmarks[k].label for k in (i, j)],
                "places_m": semantic_map.positions[[i, j]].tolist(),
                "share": share,
            }
            for i, j, share in found.most_confused()
            if share >= MIN_SHARE
        ],
    }


def ambiguity_text(name: str, numbers: dict) -> str:
    """Return the same in words."""
    from course_lib.beyond.look_alikes.confidence import MIN_CONFIDENCE

    sure = f"{numbers['sure_percent']:.0f} % are sure (confidence {MIN_CONFIDENCE:g} or more)"
    mean = f"mean confidence of the right pose {numbers['mean_confidence']:.2f}"
    lines = [f"{name}: of {numbers['places']} free places {sure}; {mean}"]
    if not numbers["confused"]:
        lines.append(f"  no two objects are confused in more than {100 * MIN_SHARE:g} %")
    for one in numbers["confused"]:
        (a, b), ((ax, ay), (bx, by)) = one["labels"], one["places_m"]
        lines.append(
            f"  {a} at ({ax:.2f}, {ay:.2f}) and {b} at ({bx:.2f}, {by:.2f}): confused in {100 * one['share']:.1f} %"
        )
    return "\n".join(lines)
