"""Run paper 1's experiment on the simulated corridor: estimate x, y and yaw, print table 1, save figures 5 and 6.

The recorded run, the map of the laser survey and its planar simplification are those of data/corridor. Fallon's scoring
runs on the same recording, with the same motion noise and number of particles.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # imported where they are used, so that --help does not wait for VTK
    from matplotlib.figure import Figure

    from course_lib.depth_mcl.scene_map import SceneMap
    from course_lib.depth_mcl.sequence import DepthSequence


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `demo corridor`."""
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="seed of the random numbers (default: 0)")
    parser.add_argument("--particles", type=int, default=200, metavar="N", help="number of particles (default: 200)")
    parser.add_argument("--frames", type=int, metavar="N", help="only the first N frames (default: all)")
    parser.add_argument("--data", type=Path, metavar="FOLDER", help="corridor data (default: data/corridor)")
    parser.add_argument("--backend", choices=["vtk", "ray"], default="vtk", help="z-buffer (default) or ray casting")
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("results/corridor"),
        metavar="FOLDER",
        help="where results and figures go (default: results/corridor)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs all rows of the table; 0 when every one reached the last frame."""
    from course_lib.commands.arguments import require_output_folder, require_seed
    from course_lib.commands.progress import progress_bar
    from course_lib.depth_mcl.scene_map import SceneMap
    from course_lib.depth_mcl.sequence import read_sequence
    from course_lib.experiments.corridor import METHODS, path_errors, run_method
    from course_lib.paths import data_path

    require_seed(arguments.seed)
    require_output_folder(arguments.out)
    folder = arguments.data or data_path("corridor")
    sequence = read_sequence(folder / "wagon")
    scene_map, planar_map = SceneMap.load(folder / "map.ply"), SceneMap.load(folder / "planar_map.ply")
    runs, errors = {}, {}
    for key, method in METHODS.items():
        runs[key] = run_method(
            method,
            scene_map,
            planar_map,
            sequence,
            n_particles=arguments.particles,
            seed=arguments.seed,
            frames=arguments.frames,
            backend=arguments.backend,
            progress=progress_bar(method.name),
        )
        errors[key] = path_errors(runs[key], sequence)
    summary = summarize(arguments.seed, arguments.particles, runs, errors)
    figures = draw(scene_map, sequence, runs, errors, arguments.backend)
    written = write(arguments.out, summary, sequence, runs, errors, figures)
    if arguments.json:
        print(json.dumps(summary))
    else:
        print(table_1(summary))
        print(f"\nWritten to {arguments.out}: " + ", ".join(written))
    return 0


def summarize(seed: int, n_particles: int, runs: dict, errors: dict) -> dict:
    """The numbers of table 1: the paper's experiment at the top level, every method below `methods`."""
    import numpy as np

    from course_lib.depth_mcl.localizer import SIGMA_XY_YAW
    from course_lib.experiments.corridor import METHODS

    rows = {}
    for key, run in runs.items():
        nearest, timed = errors[key]
        rows[key] = {
            "name": METHODS[key].name,
            "median_m": nearest.median,
            "sigma_m": nearest.sigma,
            "within_3sigma_percent": 100 * nearest.within_3sigma,
            "median_timed_m": timed.median,
            "median_effective_sample_size": float(np.median(run.ess)),
            "ms_per_frame": run.ms_per_frame,
        }
    ours = rows["proposed"]
    copied = ("median_m", "sigma_m", "within_3sigma_percent", "median_timed_m", "ms_per_frame")
    return {
        "seed": seed,
        "n_particles": n_particles,
        "frames": len(runs["proposed"].frames),
        "sigma_noise": [float(s) for s in SIGMA_XY_YAW],
        **{name: ours[name] for name in copied},
        "fallon_median_m": rows["fallon"]["median_m"],
        "methods": rows,
    }


def draw(scene_map: SceneMap, sequence: DepthSequence, runs: dict, errors: dict, backend: str) -> dict[str, Figure]:
    """Figures 5 and 6 and the overview, by file name."""
    import numpy as np

    from course_lib.plots.corridor_figures import figure_5, figure_6, floor_plan
    from course_lib.plots.overview_figure import overview_figure

    ours = runs["proposed"]
    shown = {"ours": "proposed", "Fallon-style, 20 x 15": "fallon"}
    walls = floor_plan(scene_map.vertices, height=sequence.camera_to_world[0, 2, 3])
    positions = {name: runs[key].states[:, :2] for name, key in shown.items()}
    lines = {f"{name}, nearest path": errors[key][0].errors for name, key in shown.items()}
    lines["ours, timed"] = errors["proposed"][1].errors
    return {
        "figure_5.png": figure_5(sequence.path_on_floor, positions, walls),
        "figure_6.png": figure_6(np.asarray(ours.frames), lines),
        "overview.png": overview_figure(scene_map, sequence, ours, backend),
    }


def write(
    out: Path, summary: dict, sequence: DepthSequence, runs: dict, errors: dict, figures: dict[str, Figure]
) -> list[str]:
    """Writes numbers (JSON, CSV a row a frame), trajectory (TUM) and figures; the names of the files."""
    import numpy as np

    from course_lib.depth_mcl.sequence import write_tum
    from course_lib.experiments.results import write_results

    ours = runs["proposed"]
    rows = [
        {
            "frame": frame,
            **{f"{key}_nearest_m": round(float(nearest.errors[i]), 5) for key, (nearest, _) in errors.items()},
            **{f"{key}_timed_m": round(float(timed.errors[i]), 5) for key, (_, timed) in errors.items()},
            **{
                f"{key}_{axis}_m": round(float(run.camera_to_world[i, j, 3]), 4)
                for key, run in runs.items()
                for j, axis in enumerate("xy")
            },
            **{f"{key}_score": round(float(run.scores[i]), 5) for key, run in runs.items()},
        }
        for i, frame in enumerate(ours.frames)
    ]
    write_results(out / "corridor.json", summary, rows)
    times = np.asarray(ours.frames, float) if sequence.times is None else sequence.times[: len(ours.frames)]
    write_tum(out / "trajectory.txt", times, ours.camera_to_world)
    for name, figure in figures.items():
        figure.savefig(out / name, dpi=130)
    return [*figures, "corridor.json", "corridor.csv", "trajectory.txt (TUM)"]


def table_1(summary: dict) -> str:
    """The paper's table 1 with its two rows and ours, the timed error beside the nearest-path error."""
    from course_lib.depth_mcl.evaluation import PAPER_TABLE_1

    lines = [
        f"Table 1, {summary['frames']} frames, {summary['n_particles']} particles, seed {summary['seed']}",
        "",
        f"{'':36} {'nearest point of the path':^33}  {'same frame':>10}  {'particles':>9}",
        f"{'':36} {'median [m]':>10} {'sigma [m]':>10} {'<= 0.30 m':>11}  {'median [m]':>10}  {'effective':>9}",
    ]
    for name, (median, sigma, within) in PAPER_TABLE_1.items():
        sigma_text = "n/a" if sigma is None else f"{sigma:.2f}"
        lines.append(f"{'paper: ' + name:36} {median:>10.2f} {sigma_text:>10} {within:>9.0f} %  {'-':>10}  {'-':>9}")
    for row in summary["methods"].values():
        lines.append(
            f"{row['name']:36} {row['median_m']:>10.3f} {row['sigma_m']:>10.3f} {row['within_3sigma_percent']:>9.1f} %"
            f"  {row['median_timed_m']:>10.3f}  {row['median_effective_sample_size']:>9.1f}"
        )
    lines += [
        "",
        "sigma is the root mean square about zero. Fallon-style rows use a planar simplification of the map. At full",
        "size their sum over 25,344 pixels collapses onto few particles, at 20 x 15 it hardly tells them apart (last",
        "column: median effective sample size). Their published system also had visual odometry; here no row has any.",
        f"{summary['ms_per_frame']:.0f} ms a frame (paper: 125 ms, on a graphics card)",
    ]
    return "\n".join(lines)
