"""Run paper 1's experiment on the simulated corridor: estimate x, y and yaw, print table 1, save figures 5 and 6.

Every seed makes a recording of its own: another day in the building of the map (doors, things in the way), another run
of the wagon, other noise; and a less kind one, with errors of calibration and mount, pushed by hand. The map and its
planar simplification are those of data/corridor. Fallon's scoring runs on the same recordings, with the same motion
noise and number of particles.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from course_lib.commands.arguments import add_backend_argument
from course_lib.commands.corridor_tables import table_1, table_of_kindnesses, table_over_recordings
from course_lib.files import run_folder, temporary_folder

if TYPE_CHECKING:  # imported where they are used, so that --help does not wait for VTK
    from matplotlib.figure import Figure

    from course_lib.depth_mcl.sequence import DepthSequence
    from course_lib.experiments.corridor_seeds import Maps, Row

KINDNESS_SEEDS = "10001-10003"
KINDNESS_SIZE = (44, 36)  # pixels: a quarter of the SR4000's each way, so that 21 runs take minutes


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo corridor`."""
    parser.add_argument(
        "--seed", type=int, default=0, metavar="N", help="seed of the recording and of the filter (default: 0)"
    )
    parser.add_argument(
        "--seeds",
        metavar="A-B",
        help="several seeds: median, least and greatest over their recordings; what is finished is kept under --out "
        "and used again. 1 to 99 are for reporting; tune on 10000 and above",
    )
    parser.add_argument(
        "--recording",
        choices=["own", "shipped"],
        default="own",
        help="made anew for the seed (default), or data/corridor/wagon, where a seed is the filter's alone",
    )
    parser.add_argument(
        "--kindnesses",
        action="store_true",
        help=f"measure instead what the simulator's kindnesses are worth, on small images (seeds {KINDNESS_SEEDS})",
    )
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
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/corridor"),
        metavar="FOLDER",
        help="where results, figures and a scene to be turned in a browser go (default: results/corridor)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs all rows of the table; 0 when every one reached the last frame."""
    from course_lib.commands.arguments import (
        MAX_PARTICLES,
        parse_seeds,
        require_count,
        require_output_folder,
        require_seed,
    )

    require_seed(arguments.seed)
    seeds = None if arguments.seeds is None else parse_seeds(arguments.seeds)
    require_count("--particles", arguments.particles, MAX_PARTICLES)  # before the recording, which takes a minute
    require_count("--frames", arguments.frames)
    require_output_folder(arguments.out)
    if arguments.dof == "6":
        return _run_by_hand(arguments, seeds or [arguments.seed])
    _require_methods(arguments)
    if arguments.kindnesses:
        return _run_kindnesses(arguments, seeds or parse_seeds(KINDNESS_SEEDS))
    return _run_seed(arguments) if seeds is None else _run_seeds(arguments, seeds)


def _require_methods(arguments: argparse.Namespace) -> None:
    from course_lib.experiments.corridor import METHODS
    from course_lib.experiments.corridor_seeds import METHODS_BY_HAND

    if arguments.methods is None:
        arguments.methods = list(METHODS)
        return
    if arguments.seeds is None:
        raise ValueError("--methods goes with --seeds: a single seed runs every row of the table")
    arguments.methods = arguments.methods.split(",")
    if not set(METHODS_BY_HAND) <= set(arguments.methods) <= set(METHODS):
        raise ValueError(
            f"--methods must name {' and '.join(METHODS_BY_HAND)}, and besides them only rows of "
            f"{', '.join(METHODS)}; got {','.join(arguments.methods)}"
        )


def _run_seed(arguments: argparse.Namespace) -> int:
    """One seed: table 1, figures, results."""
    with temporary_folder() as temporary:
        maps, sequence, rows = _rows_of(arguments, arguments.seed, temporary)
        summary = summarize(arguments, arguments.seed, rows)
        print(json.dumps(summary) if arguments.json else table_1(summary), flush=True)
        with run_folder(arguments.out, "demo corridor") as out:
            write(out / "corridor.json", summary, rows)
            figures = write_figures(out, sequence, rows, draw(maps, sequence, rows, arguments.backend))
            written = [*figures, "corridor.json", "corridor.csv", _write_scene(out, maps, sequence, rows)]
    if not arguments.json:
        print(f"\nWritten to {arguments.out}: " + ", ".join(written))
    return 0


def _run_seeds(arguments: argparse.Namespace, seeds: list[int]) -> int:
    """Several seeds, each written when it is done: table 1 over their recordings."""
    import sys

    from course_lib.experiments.corridor_seeds import over_recordings
    from course_lib.experiments.results import write_results

    summaries = []
    for seed in seeds:
        path = arguments.out / f"seed_{seed}.json"
        summary = _finished(path, _settings(arguments, seed))
        if summary is None:
            with temporary_folder() as temporary:
                _, _, rows = _rows_of(arguments, seed, temporary)
            summary = summarize(arguments, seed, rows)
            write(path, summary, rows)
        else:
            print(f"seed {seed}: finished before, taken from {path}", file=sys.stderr)
        summaries.append(summary)
    result = {
        "seeds": seeds,
        **{key: summaries[0][key] for key in ("n_particles", "frames", "sigma_noise", "settings")},
        "over_recordings": over_recordings(summaries),
        "recordings": summaries,
    }
    print(json.dumps(result) if arguments.json else table_over_recordings(result), flush=True)
    write_results(arguments.out / "recordings.json", result)
    return 0


def _run_by_hand(arguments: argparse.Namespace, seeds: list[int]) -> int:
    """Recordings carried by hand, made anew from each seed, in six degrees of freedom."""
    from course_lib.commands.progress import progress_bar
    from course_lib.commands.six_degrees_table import NAMES, six_degrees_table
    from course_lib.experiments import sweep
    from course_lib.experiments.results import write_results
    from course_lib.experiments.six_degrees import METHODS, corridor_hand, pooled
    from course_lib.plots.covariance_figure import covariance_figure

    for option, usual in (("recording", "own"), ("kindnesses", False), ("particles", 200), ("backend", "raster")):
        if getattr(arguments, option) != usual:
            raise ValueError(f"--{option} does not go with --dof 6")
    methods = arguments.methods.split(",") if arguments.methods else list(METHODS)
    if not set(methods) <= set(METHODS):
        raise ValueError(f"--methods must name {', '.join(METHODS)}, with commas; got {arguments.methods}")
    common = {"data": str(_data(arguments).absolute()), "frames": arguments.frames, "methods": methods}
    points = [{**common, "seed": seed} for seed in seeds]
    bar = progress_bar("carried by hand", "seed")
    runs = [row["result"] for row in sweep(corridor_hand, points, results=arguments.out / "hand.jsonl", progress=bar)]
    by_row = {
        NAMES[method] + told: [run[part][method] for run in runs]
        for part, told in (("methods", ""), ("methods_less_kind", ", less kind"))
        for method in methods
    }
    rows = {name: pooled(own) for name, own in by_row.items()}
    each = {name: [pooled([run]) for run in own] for name, own in by_row.items()}
    print(json.dumps({"seeds": seeds, "rows": rows}) if arguments.json else six_degrees_table(rows), flush=True)
    with run_folder(arguments.out, "demo corridor --dof 6") as out:
        write_results(out / "hand.json", {"seeds": seeds, "rows": rows, "recordings": each})
        covariance_figure(by_row).savefig(out / "covariance.png", dpi=110)
    return 0


def _run_kindnesses(arguments: argparse.Namespace, seeds: list[int]) -> int:
    """The paper's method on recordings with no hardship, with each alone, and with all."""
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments.corridor_seeds import hardship_errors, spread
    from course_lib.experiments.results import write_results
    from course_lib.rendering.camera import DepthCamera
    from course_lib.simulation.corridor.seeded_recording import HARDSHIPS

    camera = DepthCamera.sr4000().resized(*KINDNESS_SIZE)
    options = run_options(arguments)
    result = {"seeds": seeds, "image": list(KINDNESS_SIZE), **options, "hardships": {}}
    for name, hardships in {"none": (), **{name: (name,) for name in HARDSHIPS}, "all": HARDSHIPS}.items():
        errors = [hardship_errors(_data(arguments), s, hardships, camera, bar=progress_bar, **options) for s in seeds]
        result["hardships"][name] = {key: spread([e[key] for e in errors]) for key in errors[0]}
        write_results(arguments.out / "kindnesses.json", result)
    print(json.dumps(result) if arguments.json else table_of_kindnesses(result))
    return 0


def run_options(arguments: argparse.Namespace) -> dict:
    """What every run of a method is told (`run_sequence`)."""
    return {"n_particles": arguments.particles} | {
        name: getattr(arguments, name) for name in ("backend", "exact", "frames")
    }


def _data(arguments: argparse.Namespace) -> Path:
    from course_lib.paths import data_path

    return arguments.data or data_path("corridor")


def _rows_of(arguments: argparse.Namespace, seed: int, temporary: Path) -> tuple[Maps, DepthSequence, dict[str, Row]]:
    """The maps, the even recording and all rows of a seed; a recording of its own is made in `temporary`."""
    from course_lib.commands.progress import progress_bar
    from course_lib.depth_mcl.sequence import read_sequence
    from course_lib.experiments.corridor_seeds import Maps, own_recordings, run_rows

    data = _data(arguments)
    maps = Maps.load(data)
    if arguments.recording == "shipped":
        even, by_hand = read_sequence(data / "wagon"), None
    else:
        try:
            even, by_hand = own_recordings(data, temporary, seed, arguments.frames, progress_bar)
        except ImportError as error:
            raise ImportError(f"{error}; --recording shipped makes none") from error
    options = run_options(arguments)
    return maps, even, run_rows(maps, even, by_hand, arguments.methods, progress_bar, seed=seed, **options)


def _settings(arguments: argparse.Namespace, seed: int) -> dict:
    """What decides a seed's result."""
    names = ("particles", "frames", "recording", "backend", "exact", "methods")
    return {"seed": seed, "data": str(_data(arguments)), **{name: getattr(arguments, name) for name in names}}


def _finished(path: Path, settings: dict) -> dict | None:
    """The stored summary of a seed, if there is one and it was made with these settings."""
    if not path.is_file():
        return None
    summary = json.loads(path.read_text(encoding="utf-8"))
    return summary if summary.get("settings") == settings else None


def summarize(arguments: argparse.Namespace, seed: int, rows: dict[str, Row]) -> dict:
    """The numbers of table 1: the paper's experiment at the top level, every method below `methods`, those on the less
    kind recording below `methods_by_hand`."""
    from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
    from course_lib.experiments.corridor_seeds import rows_by_part

    parts = rows_by_part(rows)
    even = parts["methods"]
    copied = ("median_m", "sigma_m", "within_3sigma_percent", "median_timed_m", "ms_per_frame")
    return {
        "seed": seed,
        "n_particles": arguments.particles,
        "frames": len(rows["proposed"].run.frames),
        "sigma_noise": [float(s) for s in SIGMA_XY_YAW],
        "settings": _settings(arguments, seed),
        **{name: even["proposed"][name] for name in copied},
        "fallon_median_m": even["fallon"]["median_m"],
        **parts,
    }


def draw(maps: Maps, sequence: DepthSequence, rows: dict[str, Row], backend: str) -> dict[str, Figure]:
    """Figures 5 and 6 and the overview, by file name."""
    import numpy as np

    from course_lib.plots.corridor_figures import figure_5, figure_6, floor_plan
    from course_lib.plots.overview_figure import overview_figure

    ours = rows["proposed"]
    shown = {"ours": rows["proposed"], "Fallon-style, 20 x 15": rows["fallon"]}
    walls = floor_plan(maps.detailed.vertices, height=sequence.camera_to_world[0, 2, 3])
    positions = {name: row.run.states[:, :2] for name, row in shown.items()}
    lines = {f"{name}, nearest path": row.nearest.errors for name, row in shown.items()}
    lines["ours, timed"] = ours.timed.errors
    return {
        "figure_5.png": figure_5(sequence.path_on_floor, positions, walls),
        "figure_6.png": figure_6(np.asarray(ours.run.frames), lines),
        "overview.png": overview_figure(maps.detailed, sequence, ours.run, backend),
    }


def _write_scene(out: Path, maps: Maps, sequence: DepthSequence, rows: dict[str, Row]) -> str:
    """Writes the run in three dimensions; what was written, in words."""
    from course_lib.commands.scene_output import write_scene
    from course_lib.depth_mcl.sequence import FAR, NEAR
    from course_lib.plots.track_scene import track_scene

    def make():
        return track_scene(maps.detailed, rows["proposed"].run, sequence, "z", NEAR, FAR)

    return write_scene(out / "corridor.html", "The paper's filter in the corridor", make)


def write(path: Path, summary: dict, rows: dict[str, Row]) -> None:
    """Writes numbers: `path` (JSON) and beside it a CSV with a line a frame."""
    from course_lib.experiments.results import write_results

    lines = [
        {
            "frame": frame,
            **{f"{key}_nearest_m": round(float(row.nearest.errors[i]), 5) for key, row in rows.items()},
            **{f"{key}_timed_m": round(float(row.timed.errors[i]), 5) for key, row in rows.items()},
            **{
                f"{key}_{axis}_m": round(float(row.run.camera_to_world[i, j, 3]), 4)
                for key, row in rows.items()
                for j, axis in enumerate("xy")
            },
            **{f"{key}_score": round(float(row.run.scores[i]), 5) for key, row in rows.items()},
        }
        for i, frame in enumerate(rows["proposed"].run.frames)
    ]
    write_results(path, summary, lines)


def write_figures(out: Path, sequence: DepthSequence, rows: dict[str, Row], figures: dict[str, Figure]) -> list[str]:
    """Writes the figures and the trajectory (TUM); the names of the files."""
    import numpy as np

    from course_lib.depth_mcl.poses import write_tum

    ours = rows["proposed"].run
    times = np.asarray(ours.frames, float) if sequence.times is None else sequence.times[: len(ours.frames)]
    write_tum(out / "trajectory.txt", times, ours.camera_to_world)
    for name, figure in figures.items():
        figure.savefig(out / name, dpi=130)
    return [*figures, "trajectory.txt (TUM)"]
