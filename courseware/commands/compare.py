"""Compare filters in six degrees of freedom on a recording with its truth: errors, thinned frames, being lost said.

Every `--every`-th frame, from every offset, is as if the camera had been moved so much faster. Called again, the
command runs what is missing.
"""

import argparse
from pathlib import Path

from courseware.commands import arguments as options
from courseware.commands.output import print_and_write, progress_bar


def add_arguments(parser: argparse.ArgumentParser) -> None:
    options.add_mesh_recording(parser, "folder of the recording, with its poses.txt")
    told = "with commas: annealed, paper (its filter, six degrees of freedom), floor (what refinement makes of the "
    told += "truth, every frame, once); all: the annealed filter with one idea switched off, too (default: "
    options.add_text(parser, "--methods", "NAMES", told + "annealed,paper,floor)", "annealed,paper,floor")
    options.add_text(parser, "--every", "NUMBERS", "thin the recording: 1,2,4,8 runs each (default: 1)", "1")
    options.add_text(parser, "--seeds", "A-B", "seeds of the filters (default: 1)", "1")
    options.add_folder(parser, "--out", "for compare.jsonl, compare.json, covariance.png", Path("results/compare"))
    options.add_flag(parser, "--json", "print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Run what is missing, then print the pooled result of each method and frame rate."""
    from course_lib.depth_mcl.sequence import read_sequence
    from course_lib.rendering.scene_map import SceneMap
    from courseware.experiments import six_degrees
    from courseware.experiments.results import write_results
    from courseware.experiments.runner import kept_rows
    from courseware.plots.experiment_figures import covariance_figure

    seeds, everies = options.parse_seeds(arguments.seeds), options.parse_numbers("--every", arguments.every)
    methods = six_degrees.require_methods(arguments.methods)
    options.check_options(arguments)
    SceneMap.load(arguments.map)
    recording = read_sequence(arguments.sequence)
    recording.require_poses()  # refused now, not after the first run
    recording.thinned(max(everies), max(everies) - 1)
    files = {"map_file": str(arguments.map.absolute()), "sequence": str(arguments.sequence.absolute())}
    points = [
        {**files, "method": method, "every": every, "offset": offset, "seed": seed}
        for method, every, offset in six_degrees.thinnings(methods, everies)
        for seed in (seeds[:1] if method == "floor" else seeds)
    ]
    bar = progress_bar("comparing", "run")
    runs = kept_rows(six_degrees.thinned_run, points, arguments.out / "compare.jsonl", progress=bar)
    grouped: dict[str, list[dict]] = {}
    for point, own in zip(points, runs, strict=True):
        thinned = "" if point["method"] == "floor" or everies == [1] else f", every {point['every']}"
        name = six_degrees.NAMES.get(point["method"], point["method"]) + thinned
        grouped.setdefault(name, []).append(own)
    rows = {name: six_degrees.pooled(results) for name, results in grouped.items()}
    result = {"map": str(arguments.map), "sequence": str(arguments.sequence), "seeds": seeds, "rows": rows}

    def write(out: Path) -> list[str]:
        write_results(out / "compare.json", result)
        covariance_figure(grouped).savefig(out / "covariance.png", dpi=110)
        return []

    print_and_write(arguments, "compare", result, six_degrees.six_degrees_table(rows), write, told="")
    return 0
