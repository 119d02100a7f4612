"""Show where in a semantic map a stereo rig would confuse which of its objects, before any run.

At every place of a grid the command draws what the rig would see there, and a matcher says where it believes it is.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from course_lib.commands.arguments import require_count, require_output_folder, require_positive, require_seed
from course_lib.files import run_folder

if TYPE_CHECKING:  # imported where they are used, so that --help does not wait for OpenCV
    from course_lib.experiments.ambiguity import AmbiguityMap
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

SURE = 0.8  # the lowest confidence of an answer, as in `SemanticLocalizer`
MIN_SHARE = 0.001  # of the belief, below which a pair is not listed


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--map", required=True, type=Path, metavar="MAP", help="semantic map, .json or .csv")
    add(
        "--association",
        default="greedy,consistent",
        metavar="NAMES",
        help="the matchers to ask, with commas (default: greedy,consistent)",
    )
    add("--step", type=float, default=0.5, metavar="METRES", help="distance between places (default: 0.5)")
    add("--draws", type=int, default=4, metavar="N", help="views drawn at each place (default: 4)")
    add("--seed", type=int, default=1, metavar="N", help="seed of the views (default: 1)")
    add("--out", type=Path, default=Path("results/ambiguity"), metavar="FOLDER", help="for the pictures and numbers")
    add("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Draw the views, print the table, and make a picture for each matcher."""
    import numpy as np

    from course_lib.beyond.look_alikes.matchers import matcher
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments.ambiguity import ambiguity_map
    from course_lib.experiments.results import write_results
    from course_lib.plots.room_figures import ambiguity_figure
    from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

    names = arguments.association.split(",")
    for name in names:
        matcher(name)  # raises an error for a name that does not exist
    require_positive("--step", arguments.step, "metres")
    require_count("--draws", arguments.draws)
    require_seed(arguments.seed)
    require_output_folder(arguments.out)
    semantic_map = SemanticMap.load(arguments.map)
    results, figures = {}, {}
    for name in names:
        found = ambiguity_map(
            semantic_map,
            np.random.default_rng(arguments.seed),
            arguments.step,
            arguments.draws,
            association=name,
            progress=progress_bar(name, "place"),
        )
        if not len(found.places):
            raise ValueError(
                f"no place of {arguments.map} is free at steps of {arguments.step:g} m: give a smaller --step"
            )
        results[name] = ambiguity_numbers(found, semantic_map)
        figures[name] = ambiguity_figure(semantic_map, found, f"{arguments.map.name}, matched by {name}")
    summary = {"map": str(arguments.map), "step_m": arguments.step, "draws": arguments.draws, "seed": arguments.seed}
    text = "\n\n".join(ambiguity_text(name, numbers) for name, numbers in results.items())
    print(json.dumps(summary | {"matchers": results}) if arguments.json else text, flush=True)
    with run_folder(arguments.out, "ambiguity") as out:
        write_results(out / "ambiguity.json", summary | {"matchers": results})
        for name, figure in figures.items():
            figure.savefig(out / f"ambiguity_{name}.png", dpi=110)
    if not arguments.json:
        print(f"\nPictures: {arguments.out}/ambiguity_*.png")
    return 0


def ambiguity_numbers(found: AmbiguityMap, semantic_map: SemanticMap) -> dict:
    """An ambiguity map in numbers, for JSON. Landmarks are numbered from 0, in the map's order."""
    return {
        "places": len(found.places),
        "mean_confidence": float(found.confidence.mean()),
        "sure_percent": float(100.0 * (found.confidence >= SURE).mean()),
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
    """The same in words."""
    lines = [
        f"{name}: of {numbers['places']} free places {numbers['sure_percent']:.0f} % are sure (confidence {SURE:g} or "
        f"more); mean confidence of the right pose {numbers['mean_confidence']:.2f}"
    ]
    if not numbers["confused"]:
        lines.append(f"  no two objects are confused in more than {100 * MIN_SHARE:g} %")
    for one in numbers["confused"]:
        (a, b), ((ax, ay), (bx, by)) = one["labels"], one["places_m"]
        lines.append(
            f"  {a} at ({ax:.2f}, {ay:.2f}) and {b} at ({bx:.2f}, {by:.2f}): confused in {100 * one['share']:.1f} %"
        )
    return "\n".join(lines)
