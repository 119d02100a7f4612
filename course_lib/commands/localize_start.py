"""Where a recording starts: `--start` as six numbers, as a file, as the recording's own truth, or searched for."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # imported where they are used, so that --help does not wait for VTK
    from course_lib.depth_mcl.sequence import DepthSequence
    from course_lib.rendering.scene_map import SceneMap


def join_words(words: list[str]) -> list[str]:
    """`--up -y` and `--start 2 -0.5 1e-3 ...` as one word each: argparse would take -y for an option."""
    joined = list(words)
    for index in range(len(words) - 2, -1, -1):
        if words[index] == "--up" and words[index + 1] in ("-x", "-y", "-z"):
            joined[index : index + 2] = [f"--up={words[index + 1]}"]
        if words[index] == "--start":
            end = index + 1
            while end < len(words) and _are_numbers(words[end]):
                end += 1
            if end > index + 1:
                joined[index:end] = ["--start=" + " ".join(words[index + 1 : end])]
    return joined


def _are_numbers(text: str) -> bool:
    """Whether a word, or a quoted list of words, is made of numbers."""
    try:
        return bool([float(word) for word in text.replace(",", " ").split()])
    except ValueError:
        return False


def found_start(
    arguments: argparse.Namespace, scene_map: SceneMap, sequence: DepthSequence, up: str
) -> tuple[DepthSequence, np.ndarray, dict]:
    """The recording from the frame in which its place was found, the pose there, and what the results tell of it.

    Raises `ValueError` where no place was found, or several that nobody can tell apart.
    """
    from course_lib.commands.progress import progress_bar
    from course_lib.experiments.recordings import find_start

    if up == "unknown":
        raise ValueError("--start unknown needs --up AXIS: only with gravity known can the whole map be searched")
    bar = progress_bar("searching")
    options = {"seed": arguments.seed, "up": up, "near": arguments.near, "far": arguments.far, "progress": bar}
    index, candidates, start = find_start(scene_map, sequence, **options)
    if candidates.status != "found":
        where = "; ".join(
            f"({x:.2f}, {y:.2f}, {z:.2f}) m, heading {np.rad2deg(yaw):.0f} degrees (evidence {one.evidence:.2f})"
            for one in candidates.poses
            for x, y, z, yaw in [(*one.state[:3], one.state[5])]
        )
        raise ValueError(
            f"the start was not found in {index + 1} frames: "
            + (f"it may be at {where}; in a world whose z is up" if where else "no place agrees with the images")
            + ". Give --start, or a recording that begins where the building looks like no other place"
        )
    return sequence.thinned(1, index), start, {"found_in_frame": sequence.frames[index]}


def given_start(given: str | None, sequence: DepthSequence, up: str) -> np.ndarray:
    """Camera-to-world matrix `(4, 4)` of the first frame in the map's own world, optical convention."""
    from course_lib.depth_mcl.sequence_files import read_pose
    from course_lib.geometry import optical_pose, rotation_to_z_up

    if given is None and not sequence.has_poses:
        raise ValueError(
            f"where does the camera start? {sequence.folder} holds no poses.txt; give --start X Y Z ROLL PITCH YAW "
            "(metres, degrees) or --start FILE with a 4 x 4 camera-to-world matrix"
        )
    if given is None:
        return sequence.camera_to_world[0]
    if not _are_numbers(given):
        return read_pose(given)
    numbers = np.array([float(word) for word in given.replace(",", " ").split()])
    if len(numbers) != 6 or not np.isfinite(numbers).all():
        raise ValueError(
            f"--start needs six finite numbers, X Y Z in metres and ROLL PITCH YAW in degrees, or a file; got {given!r}"
        )
    start = np.linalg.inv(rotation_to_z_up(up)) @ optical_pose(np.concatenate([np.zeros(3), np.deg2rad(numbers[3:])]))
    start[:3, 3] = numbers[:3]
    return start
