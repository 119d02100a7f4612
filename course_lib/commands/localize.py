"""Localize a recorded depth-camera sequence in a mesh map, and say of every frame whether the filter seems lost.

The recording is a folder with depth/*.png (16-bit) and intrinsics.txt, as in 7-Scenes. With poses.txt, the truth,
errors are printed too; without it the start must be given.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from functools import partial
from pathlib import Path

import numpy as np

from course_lib.commands.arguments import add_backend_argument
from course_lib.commands.localize_report import believed, localize_table, write_localized
from course_lib.commands.localize_start import found_start, given_start, join_words
from course_lib.files import run_folder

__all__ = ["add_arguments", "join_words", "run"]

EPILOG = """\
the folder of the recording:
  depth/*.png      16-bit depth along the optical axis, 0 = no measurement; the first number in the name is the frame
  intrinsics.txt   3 x 3 matrix K in pixels, for images of this size
  poses.txt        optional, the truth: frame, row-major 4 x 4 camera-to-world matrix (x right, y down, z forward)
  up.txt           optional: which axis of map and poses points up (x, -x, y, -y, z, -z)

examples:
  own recording, no truth; the camera starts 1.2 m up at x = 2, y = -0.5 and looks along +y:
    localize --map home.ply --sequence walk --start 2 -0.5 1.2 0 0 90 --up z --out results/walk
  nobody knows where it starts; z is up (gravity.txt tells which way is down, else the camera is held upright):
    localize --map home.ply --sequence walk --start unknown --up z --recover
  depth as TUM RGB-D files have it (5000 units a metre), start from a file with a 4 x 4 matrix:
    localize --map desk.ply --sequence desk --depth-scale 5000 --far 5 --start first_pose.txt
  a wagon on a level floor, with truth:
    localize --map data/corridor/map.ply --sequence data/corridor/wagon --dof xyyaw --seed 1
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declares the options of `localize`."""
    from course_lib.depth_mcl.sequence import FAR, NEAR
    from course_lib.depth_mcl.sequence_files import UNITS_PER_METRE

    parser.formatter_class = argparse.RawDescriptionHelpFormatter  # keeps the lines of the examples
    parser.epilog = EPILOG
    parser.add_argument("--map", required=True, type=Path, metavar="MESH", help="mesh in metres (PLY, OBJ, STL, GLB)")
    parser.add_argument("--sequence", required=True, type=Path, metavar="FOLDER", help="folder of the recording")
    parser.add_argument(
        "--start",
        metavar="POSE",
        help="pose of the camera's body (x forward, y left, z up) in the first frame: six numbers, X Y Z in metres in "
        "the map's own axes, then ROLL PITCH YAW in degrees (all 0: level and towards x in a world whose z is up, into "
        "which --up turns another one); or a file with a 4 x 4 camera-to-world matrix, or whose first row is one of "
        "poses.txt; or unknown: it is searched for in the whole map, which needs --up (default: that of the recording)",
    )
    parser.add_argument(
        "--depth-scale",
        type=float,
        default=UNITS_PER_METRE,
        metavar="N",
        help="units of the depth images in a metre (default: 1000, millimetres; TUM RGB-D files: 5000)",
    )
    parser.add_argument(
        "--near", type=float, default=NEAR, metavar="M", help=f"what is nearer is not seen, metres (default: {NEAR:g})"
    )
    parser.add_argument(
        "--far", type=float, default=FAR, metavar="M", help=f"what is farther is not seen, metres (default: {FAR:g})"
    )
    parser.add_argument("--dof", choices=["xyyaw", "6"], default="6", help="what to estimate (default: 6)")
    parser.add_argument(
        "--up",
        choices=["x", "-x", "y", "-y", "z", "-z", "unknown"],
        help="the axis of map and poses that points up (default: what up.txt in the folder says, else unknown)",
    )
    parser.add_argument(
        "--method",
        choices=["annealed", "paper"],
        help="the filter: annealed and refined, which adapts to the camera's motion (default with --dof 6, six degrees "
        "of freedom only), or the paper's (default with --dof xyyaw), whose particles and noise are set by hand",
    )
    parser.add_argument(
        "--recover",
        action="store_true",
        help="search the whole map when the annealed filter is lost: seconds a frame until it is found again",
    )
    parser.add_argument("--particles", type=int, default=200, metavar="N", help="number of particles (default: 200)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="seed of the random numbers (default: 0)")
    parser.add_argument("--frames", type=int, metavar="N", help="only the first N frames")
    parser.add_argument(
        "--sigma-position",
        type=float,
        metavar="M",
        help="system noise a frame of the paper's, metres (default: 0.05; xyyaw: 0.15)",
    )
    parser.add_argument(
        "--sigma-rotation", type=float, metavar="DEG", help="the same, in degrees (default: 2; xyyaw: 1.5)"
    )
    parser.add_argument(
        "--drop-far", action="store_true", help="leave out triangles more than 5 km from the middle of the map"
    )
    add_backend_argument(parser)
    parser.add_argument(
        "--out",
        type=Path,
        metavar="FOLDER",
        help="write results, trajectory, figure and scene here (track.html: map, path and the worst frames' points, to "
        "be turned in a browser)",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")


def run(arguments: argparse.Namespace) -> int:
    """Runs the filter; 0 when it reached the last frame, whatever it believes of the track."""
    from course_lib.commands.arguments import (
        MOST_PARTICLES,
        require_count,
        require_output_folder,
        require_positive,
        require_seed,
        warn_of_fewer,
    )
    from course_lib.commands.progress import progress_bar
    from course_lib.depth_mcl.sequence import read_sequence
    from course_lib.experiments.recordings import (
        pose_error_summary,
        run_annealed,
        run_recovering,
        run_sequence,
        system_noise,
    )
    from course_lib.rendering.scene_map import SceneMap

    method = _method(arguments)
    require_seed(arguments.seed)
    require_count("--particles", arguments.particles, MOST_PARTICLES)
    require_count("--frames", arguments.frames)
    require_positive("--depth-scale", arguments.depth_scale, "units in a metre (1000 for millimetres)")
    require_positive("--near", arguments.near, "metres")
    require_positive("--far", arguments.far, "metres")
    if arguments.near >= arguments.far:
        raise ValueError(f"--near must be below --far; got {arguments.near:g} and {arguments.far:g} m")
    if arguments.out:
        require_output_folder(arguments.out)
    sequence = read_sequence(arguments.sequence, arguments.depth_scale)
    warn_of_fewer("--frames", arguments.frames, len(sequence.frames), f"{arguments.sequence} has")
    up = arguments.up or sequence.up or "unknown"
    if arguments.dof == "xyyaw" and up == "unknown":
        raise ValueError(
            "--dof xyyaw moves the camera on a horizontal plane, and which way is up in this world is unknown; give "
            "--up AXIS (x, -x, y, -y, z, -z) if you know it, else use --dof 6"
        )
    scene_map = SceneMap.load(arguments.map, drop_far=arguments.drop_far)
    searched = {}
    if arguments.start == "unknown":
        sequence, start, searched = found_start(arguments, scene_map, sequence, up)
    else:
        start = given_start(arguments.start, sequence, "z" if up == "unknown" else up)
    if method == "paper":
        noise = system_noise(arguments.dof, *_sigma(arguments))
        localized = partial(run_sequence, **noise)
    else:
        localized = run_recovering if arguments.recover else run_annealed
    result = localized(
        scene_map,
        sequence,
        n_particles=arguments.particles,
        seed=arguments.seed,
        up="z" if up == "unknown" else up,
        start=start,
        frames=arguments.frames,
        backend=arguments.backend,
        exact=arguments.exact,
        near=arguments.near,
        far=arguments.far,
        watched=True,
        progress=progress_bar("localizing"),
    )
    summary = {
        **_options(arguments, up),
        **searched,
        "frames": len(result.frames),
        "frames_without_measurement": result.frames_without_measurement,
        "frames_at_fault": dict(Counter(fault for fault in result.faults if fault not in (None, "no return"))),
        **{f"frames_{status}": result.statuses.count(status) for status in ("tracked", "doubtful", "lost")},
        "believes": believed(result.frames, result.statuses),
        **(pose_error_summary(result, sequence) if sequence.has_poses else {}),
        "renders_per_frame": float(np.mean(result.renders)),
        "most_renders": int(result.renders.max()),
        "ms_per_frame": result.ms_per_frame,
    }
    print(json.dumps(summary) if arguments.json else localize_table(summary), flush=True)
    if arguments.out:
        with run_folder(arguments.out, "localize") as out:
            written = write_localized(out, summary, result, sequence, scene_map)
        if not arguments.json:
            print(f"Written to {arguments.out}: " + ", ".join(written))
    if not arguments.json:
        print(summary["believes"])
    return 0


def _method(arguments: argparse.Namespace) -> str:
    """The filter to use; `ValueError` for options that it does not have."""
    method = arguments.method or ("annealed" if arguments.dof == "6" else "paper")
    if arguments.recover and method == "paper":
        raise ValueError("--recover goes with the annealed filter: --dof 6, and not --method paper")
    if method == "paper":
        return method
    if arguments.dof != "6":
        raise ValueError("--method annealed estimates six degrees of freedom: leave out --dof xyyaw, or --method")
    for option in ("sigma_position", "sigma_rotation"):
        if getattr(arguments, option) is not None:
            raise ValueError(
                f"--{option.replace('_', '-')} goes with --method paper: the annealed filter takes its noise from how "
                "far the camera has been moving"
            )
    return method


def _sigma(arguments: argparse.Namespace) -> tuple[float, float]:
    """System noise a frame: metres, degrees."""
    from course_lib.experiments.recordings import SIGMA

    position, rotation_deg = SIGMA[arguments.dof]
    position = position if arguments.sigma_position is None else arguments.sigma_position
    rotation_deg = rotation_deg if arguments.sigma_rotation is None else arguments.sigma_rotation
    for name, value, most, unit in (("position", position, 10, "m"), ("rotation", rotation_deg, 180, "degrees")):
        if not 0 <= value <= most:
            raise ValueError(f"--sigma-{name} must be between 0 and {most} {unit} a frame; got {value:g}")
    return position, rotation_deg


def _options(arguments: argparse.Namespace, up: str) -> dict:
    """What was asked for, as the results keep it."""
    method = _method(arguments)
    own = {"method": method}
    if method == "paper":
        position, rotation_deg = _sigma(arguments)
        own |= {"sigma_position_m": position, "sigma_rotation_deg": rotation_deg}
    return {
        **own,
        "recover": arguments.recover,
        "n_particles": arguments.particles,
        "map": str(arguments.map),
        "sequence": str(arguments.sequence),
        "start": arguments.start or "first row of poses.txt",
        "dof": arguments.dof,
        "up": up,
        "seed": arguments.seed,
        "depth_units_per_metre": arguments.depth_scale,
        "near_m": arguments.near,
        "far_m": arguments.far,
        "backend": arguments.backend,
        "exact": arguments.exact,
    }
