"""Localize a recorded depth-camera sequence in a mesh map, starting at its first pose, and print the pose errors.

The sequence is a folder with depth/*.png (16-bit, millimetres), intrinsics.txt and poses.txt, as in 7-Scenes.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import numpy as np

# Standard deviations of the system noise a frame, metres and degrees (chosen: for six degrees of freedom about the
# steps of a camera carried by hand, median 0.04 m and 2 degrees in the kitchen recording; for x, y, yaw one and a half
# of a wagon's longest steps, 0.1 m).
SIGMA = {"6": (0.05, 2.0), "xyyaw": (0.15, 1.5)}


def join_words(words: list[str]) -> list[str]:
    """`--up -y` as one word, `--up=-y`: argparse would take `-y` for an option."""
    joined = list(words)
    for index in range(len(words) - 2, -1, -1):
        if words[index] == "--up" and words[index + 1] in ("-x", "-y", "-z"):
            joined[index : index + 2] = [f"--up={words[index + 1]}"]
    return joined


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `localize`."""
    parser.add_argument("--map", required=True, type=Path, metavar="MESH", help="mesh file (PLY, OBJ, STL, GLB)")
    parser.add_argument("--sequence", required=True, type=Path, metavar="FOLDER", help="folder of the recording")
    parser.add_argument("--dof", choices=["xyyaw", "6"], default="6", help="what to estimate (default: 6)")
    parser.add_argument(
        "--up",
        choices=["x", "-x", "y", "-y", "z", "-z", "unknown"],
        help="the axis of map and poses that points up (default: what up.txt in the folder says, else unknown).",
    )
    parser.add_argument("--particles", type=int, default=200, metavar="N", help="number of particles (default: 200)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="seed of the random numbers (default: 0)")
    parser.add_argument("--frames", type=int, metavar="N", help="only the first N frames")
    parser.add_argument(
        "--sigma-position", type=float, metavar="M", help="system noise a frame (default: 0.05; xyyaw 0.15)"
    )
    parser.add_argument("--sigma-rotation", type=float, metavar="DEG", help="the same, in degrees (2; xyyaw 1.5)")
    parser.add_argument("--backend", choices=["vtk", "ray"], default="vtk", help="z-buffer (default) or ray casting")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="write results, trajectory, figure here")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs the filter; 0 when it reached the last frame."""
    from course_lib.commands.arguments import require_output_folder, require_seed
    from course_lib.commands.progress import progress_bar
    from course_lib.depth_mcl.scene_map import SceneMap
    from course_lib.depth_mcl.sequence import read_sequence
    from course_lib.experiments.recordings import pose_error_summary, run_sequence

    require_seed(arguments.seed)
    if arguments.out:
        require_output_folder(arguments.out)
    sequence = read_sequence(arguments.sequence)
    up = arguments.up or sequence.up or "unknown"
    if arguments.dof == "xyyaw" and up == "unknown":
        raise ValueError(
            "--dof xyyaw moves the camera on a horizontal plane, and which way is up in this world is unknown; give "
            "--up AXIS (x, -x, y, -y, z, -z) if you know it, else use --dof 6"
        )
    scene_map = SceneMap.load(arguments.map)
    position, rotation_deg = SIGMA[arguments.dof]
    position = position if arguments.sigma_position is None else arguments.sigma_position
    rotation = np.deg2rad(rotation_deg if arguments.sigma_rotation is None else arguments.sigma_rotation)
    full = arguments.dof == "6"
    sigma = [position] * 3 + [rotation] * 3 if full else [position, position, 0.0, 0.0, 0.0, rotation]
    result = run_sequence(
        scene_map,
        sequence,
        sigma=sigma,
        n_particles=arguments.particles,
        seed=arguments.seed,
        noise="tangent" if full else "euler",
        up="z" if up == "unknown" else up,
        frames=arguments.frames,
        backend=arguments.backend,
        progress=progress_bar("localizing"),
    )
    summary = {
        "map": str(arguments.map),
        "sequence": str(arguments.sequence),
        "dof": arguments.dof,
        "up": up,
        "seed": arguments.seed,
        "n_particles": arguments.particles,
        "sigma_position_m": float(position),
        "sigma_rotation_deg": float(np.rad2deg(rotation)),
        "frames": len(result.frames),
        "frames_without_measurement": result.frames_without_measurement,
        **pose_error_summary(result, sequence),
        "renders_per_frame": arguments.particles,
        "ms_per_frame": result.ms_per_frame,
    }
    if arguments.out:
        _write(arguments.out, summary, result, sequence)
    print(json.dumps(summary) if arguments.json else _table(summary))
    if arguments.out and not arguments.json:
        print(f"Written to {arguments.out}: localize.json, localize.csv, trajectory.txt (TUM), errors.png")
    if result.frames_without_measurement:
        print(f"{result.frames_without_measurement} frames held no measurement; particles were kept", file=sys.stderr)
    return 0


def _table(s: dict) -> str:
    estimated = "all six degrees of freedom" if s["dof"] == "6" else "x, y and yaw"
    lines = [
        f"{s['frames']} frames, {estimated} estimated with {s['renders_per_frame']} particles",
        "",
        "                      median   90th percentile",
        f"position error [m]    {s['median_position_m']:6.3f}   {s['p90_position_m']:6.3f}",
        f"rotation error [deg]  {s['median_rotation_deg']:6.2f}   {s['p90_rotation_deg']:6.2f}",
        "",
        f"within 5 cm and 5 degrees: {s['within_5cm_5deg_percent']:.1f} %",
        f"{s['renders_per_frame']} renders and {s['ms_per_frame']:.0f} ms a frame",
    ]
    return "\n".join(lines)


def _write(folder: Path, summary: dict, result: object, sequence: object) -> None:
    from course_lib.depth_mcl.evaluation import pose_errors
    from course_lib.depth_mcl.sequence import write_tum
    from course_lib.experiments.results import write_results
    from course_lib.plots.corridor_figures import figure_6

    true = sequence.camera_to_world[: len(result.frames)]
    position, rotation = pose_errors(result.camera_to_world, true)
    rows = [
        {"frame": frame, "position_error_m": round(p, 5), "rotation_error_deg": round(r, 4), "score": round(score, 5)}
        for frame, p, r, score in zip(result.frames, position, np.rad2deg(rotation), result.scores, strict=True)
    ]
    write_results(folder / "localize.json", summary, rows)
    times = np.asarray(result.frames, float) if sequence.times is None else sequence.times[: len(result.frames)]
    write_tum(folder / "trajectory.txt", times, result.camera_to_world)
    figure = figure_6(np.asarray(result.frames), {"position error": position}, "Position error of every frame")
    figure.savefig(folder / "errors.png", dpi=130)
