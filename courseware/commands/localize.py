"""Localize a recorded depth-camera sequence in a mesh map, and say of every frame whether the filter seems lost.

The recording is a folder with depth/*.png (16-bit) and intrinsics.txt, as in 7-Scenes. With poses.txt, the truth,
errors are printed too; without it the start must be given.
"""

import argparse
import math
from functools import partial

import numpy as np

from courseware.commands import arguments as options
from courseware.commands.output import print_and_write, progress_bar

START = (
    "pose of the camera's body (x forward, y left, z up) in the first frame: six numbers, X Y Z in metres in the map's "
    "own axes, then ROLL PITCH YAW in degrees (all 0: level and towards x in a world whose z is up, into which --up "
    "turns another one); or a file with a 4 x 4 camera-to-world matrix, or whose first row is one of poses.txt; or "
    "unknown: it is searched for in the whole map, which needs --up (default: that of the recording)"
)
EPILOG = """\
the folder of the recording:
  depth/*.png      16-bit depth along the optical axis, 0 = no measurement; the first number in the name is the frame
  intrinsics.txt   3 x 3 matrix K in pixels, for images of this size
  (the paper's filter takes 0.8 s a frame at 640 x 480: for it, make the images smaller, and intrinsics.txt with them)
  poses.txt        optional, the truth: frame, row-major 4 x 4 camera-to-world matrix (x right, y down, z forward)
  up.txt           optional: which axis of map and poses points up (x, -x, y, -y, z, -z)
  gravity.txt      optional: frame, then down along the camera's axes x y z; or accelerometer.txt as TUM RGB-D has it

examples:
  own recording, no truth; the camera starts 1.2 m up at x = 2, y = -0.5 and looks along +y:
    localize --map home.ply --sequence walk --start 2 -0.5 1.2 0 0 90 --up z --out results/walk
  nobody knows where it starts; z is up (gravity.txt or accelerometer.txt tells which way is down, else the images do):
    localize --map home.ply --sequence walk --start unknown --up z
  depth as TUM RGB-D files have it (5000 units a metre), start from a file with a 4 x 4 matrix:
    localize --map desk.ply --sequence desk --depth-scale 5000 --far 5 --start first_pose.txt
  a wagon on a level floor, with truth:
    localize --map data/corridor/map.ply --sequence data/corridor/wagon --dof xyyaw --seed 1
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    from course_lib.depth_mcl.sequence import FAR, NEAR
    from course_lib.depth_mcl.sequence_files import UNITS_PER_METRE

    parser.formatter_class = argparse.RawDescriptionHelpFormatter  # keeps the lines of the examples
    parser.epilog = EPILOG
    add = parser.add_argument
    options.add_mesh_recording(parser, "folder of the recording")
    options.add_text(parser, "--start", "POSE", START)
    told = "units of the depth images in a metre (default: 1000, millimetres; TUM RGB-D files: 5000)"
    add("--depth-scale", type=float, default=UNITS_PER_METRE, metavar="N", help=told)
    add("--near", type=float, default=NEAR, metavar="M", help=f"nothing nearer is seen, metres (default: {NEAR:g})")
    add("--far", type=float, default=FAR, metavar="M", help=f"nothing farther is seen, metres (default: {FAR:g})")
    add("--dof", choices=["xyyaw", "6"], default="6", help="what to estimate (default: 6)")
    told = "the axis of map and poses that points up (default: what up.txt in the folder says, else unknown)"
    add("--up", choices=["x", "-x", "y", "-y", "z", "-z", "unknown"], help=told)
    told = "the filter: annealed and refined, which adapts to the camera's motion (default with --dof 6, six degrees "
    told += "of freedom only), or the paper's (default with --dof xyyaw), whose particles and noise are set by hand"
    add("--method", choices=["annealed", "paper"], help=told)
    told = "search the whole map when the annealed filter is lost, about a second a frame until it is found again "
    told += "(default: where up is known and the map has free space to search)"
    add("--recover", action=argparse.BooleanOptionalAction, help=told)
    options.add_number(parser, "--particles", "number of particles (default: 200)", 200)
    options.add_number(parser, "--seed", "seed of the random numbers (default: 0)", 0)
    options.add_number(parser, "--frames", "only the first N frames")
    told = "system noise a frame of the paper's filter, metres (default: 0.05; xyyaw: 0.15)"
    add("--sigma-position", type=float, metavar="M", help=told)
    add("--sigma-rotation", type=float, metavar="DEG", help="the same, in degrees (default: 2; xyyaw: 1.5)")
    options.add_flag(parser, "--drop-far", "leave out triangles more than 5 km from the middle of the map")
    options.add_backend_argument(parser)
    told = "write results, trajectory, figure and scene here (track.html: map, path and the worst frames' points, to "
    options.add_results(parser, told + "be turned in a browser)")


def run(arguments: argparse.Namespace) -> int:
    """Run the filter. 0 when it reached the last frame, whatever it believes of the track."""
    from course_lib.depth_mcl.sequence import read_sequence
    from course_lib.recordings import can_search, run_sequence, system_noise
    from course_lib.rendering.scene_map import SceneMap
    from courseware.commands.localize_report import localize_table, results, write_localized

    method, sigma = _checked(arguments)
    sequence = read_sequence(arguments.sequence, arguments.depth_scale)
    options.warn_of_fewer("--frames", arguments.frames, len(sequence.frames), f"{arguments.sequence} has")
    up = arguments.up or sequence.up or "unknown"
    if arguments.dof == "xyyaw" and up == "unknown":
        raise ValueError("--dof xyyaw: which way is up in this world is unknown; give --up AXIS, or use --dof 6")
    scene_map, searched = SceneMap.load(arguments.map, drop_far=arguments.drop_far), {}
    if arguments.start == "unknown":
        sequence, start = _found_start(arguments, scene_map, sequence, up)
        searched = {"found_in_frame": sequence.frames[0]}
    else:
        start = _given_start(arguments.start, sequence, "z" if up == "unknown" else up)
    recover = arguments.recover
    if recover is None:
        recover = method == "annealed" and up != "unknown" and can_search(scene_map)
    noise = {"sigma_position_m": sigma[0], "sigma_rotation_deg": sigma[1]} if method == "paper" else {}
    found = run_sequence(
        scene_map,
        sequence,
        "recovering" if recover else method,
        up="z" if up == "unknown" else up,
        start=start,
        n_particles=arguments.particles,
        watched=True,
        progress=progress_bar("localizing"),
        **{name: getattr(arguments, name) for name in ("seed", "frames", "near", "far", "backend", "exact")},
        **(system_noise(arguments.dof, *sigma) if noise else {}),
    )
    summary = {
        "method": method,
        **noise,
        "recover": recover,
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
        **searched,
        **results(found, sequence, sequence.camera(arguments.near, arguments.far)),
    }
    write = partial(write_localized, summary=summary, result=found, sequence=sequence, scene_map=scene_map)
    print_and_write(arguments, "localize", summary, localize_table(summary), write, "Written to {out}: {files}")
    if not arguments.json:
        print(summary["believes"])
    return 0


def _checked(arguments: argparse.Namespace) -> tuple[str, tuple[float, float]]:
    """Return the filter to use and its system noise a frame (metres, degrees); `ValueError` for what does not fit."""
    from course_lib.recordings import SIGMA

    method = arguments.method or ("annealed" if arguments.dof == "6" else "paper")
    if arguments.recover and method == "paper":
        raise ValueError("--recover goes with the annealed filter: --dof 6, and not --method paper")
    if method == "annealed" and arguments.dof != "6":
        raise ValueError("--method annealed estimates six degrees of freedom: leave out --dof xyyaw, or --method")
    sigma = dict(zip(("position", "rotation"), SIGMA[arguments.dof], strict=True))
    for name, limit in (("position", "10 m"), ("rotation", "180 degrees")):
        given = getattr(arguments, f"sigma_{name}")
        if given is not None and method == "annealed":
            raise ValueError(f"--sigma-{name} goes with --method paper: the annealed filter finds its noise itself")
        if given is not None and not 0 <= given <= float(limit.split()[0]):
            raise ValueError(f"--sigma-{name} must be between 0 and {limit} a frame; got {given:g}")
        sigma[name] = sigma[name] if given is None else given
    options.check_options(arguments)
    options.require_positive("--depth-scale", arguments.depth_scale, "units in a metre (1000 for millimetres)")
    options.require_positive("--near", arguments.near, "metres")
    options.require_positive("--far", arguments.far, "metres")
    if arguments.near >= arguments.far:
        raise ValueError(f"--near must be below --far; got {arguments.near:g} and {arguments.far:g} m")
    return method, tuple(sigma.values())


def join_words(words: list[str]) -> list[str]:
    """Make `--up -y` and `--start 2 -0.5 1e-3 ...` one word each: argparse would take -y for an option."""
    joined = list(words)
    for index in range(len(words) - 2, -1, -1):
        if words[index] == "--up" and words[index + 1] in ("-x", "-y", "-z"):
            joined[index : index + 2] = [f"--up={words[index + 1]}"]
        if words[index] == "--start":
            end = index + 1
            while end < len(words) and _numbers(words[end]):
                end += 1
            if end > index + 1:
                joined[index:end] = ["--start=" + " ".join(words[index + 1 : end])]
    return joined


def _numbers(text: str) -> list[float]:
    """Return the numbers that a word, or a quoted list of words, is made of; none where anything else is among them."""
    try:
        return [float(word) for word in text.replace(",", " ").split()]
    except ValueError:
        return []


def _found_start(arguments, scene_map, sequence, up: str) -> tuple:
    """Return the recording from the frame in which its place was found, and the pose there."""
    from course_lib.recordings import find_start

    if up == "unknown":
        raise ValueError("--start unknown needs --up AXIS: only with gravity known can the whole map be searched")
    seen = {"near": arguments.near, "far": arguments.far, "progress": progress_bar("searching")}
    index, candidates, start = find_start(scene_map, sequence, seed=arguments.seed, up=up, **seen)
    if candidates.status != "found":
        where = "; ".join(
            f"({x:.2f}, {y:.2f}, {z:.2f}) m, heading {np.rad2deg(yaw):.0f} degrees (evidence {place.evidence:.2f})"
            for place in candidates.poses
            for x, y, z, yaw in [(*place.state[:3], place.state[5])]
        )
        told = f"it may be at {where}; in a world whose z is up" if where else "no place agrees with the images"
        told += ". Give --start, or a recording that begins where the building looks like no other place"
        raise ValueError(f"the start was not found in {index + 1} frames: {told}")
    return sequence.thinned(1, index), start


def _given_start(given: str | None, sequence, up: str) -> np.ndarray:
    """Return the camera-to-world matrix `(4, 4)` of the first frame in the map's own world, optical convention."""
    from course_lib.depth_mcl.sequence_files import read_pose
    from course_lib.geometry import optical_pose, rotation_to_z_up

    if given is None:
        if not sequence.has_poses:
            told = (
                f"where does the camera start? {sequence.folder} holds no poses.txt; give --start X Y Z ROLL PITCH YAW "
            )
            raise ValueError(told + "(metres, degrees) or --start FILE with a 4 x 4 camera-to-world matrix")
        return sequence.camera_to_world[0]
    numbers = _numbers(given)
    if not numbers:
        return read_pose(given)
    if len(numbers) != 6 or not all(map(math.isfinite, numbers)):
        told = "--start needs six finite numbers, X Y Z in metres and ROLL PITCH YAW in degrees, or a file"
        raise ValueError(f"{told}; got {given!r}")
    state = np.concatenate([np.zeros(3), np.deg2rad(numbers[3:])])
    start = np.linalg.inv(rotation_to_z_up(up)) @ optical_pose(state)
    start[:3, 3] = numbers[:3]
    return start
