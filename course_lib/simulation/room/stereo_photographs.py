"""A room photographed by a rig: pairs of panoramas with exact boxes, written as a recording that the methods read."""

from __future__ import annotations

import json
from pathlib import Path

from numpy.random import Generator

from course_lib.simulation.room.object_boxes import object_boxes
from course_lib.simulation.sensors.panorama_camera import PanoramaCameraModel, photograph, write_photograph
from course_lib.simulation.sensors.panorama_renderer import PanoramaRenderer
from course_lib.simulation.sensors.panorama_rig import RigPose
from course_lib.spherical_stereo.recording import POSES_FILE, VERSION


def photograph_pair(
    renderer: PanoramaRenderer, rig: RigPose, folder: Path, name: str, camera: PanoramaCameraModel, rng: Generator
) -> dict:
    """Both panoramas of a rig, written to the folder as NAME_upper.jpg and NAME_lower.jpg; returns their entry.

    The entry is what poses.json says of a pair: where the rig really stood, and the boxes of all that can be seen.
    """
    entry = {"name": name, "rig": rig.as_dict()}
    for side, state in zip(("upper", "lower"), rig.camera_states(), strict=True):
        file = f"{name}_{side}.jpg"
        write_photograph(folder / file, photograph(renderer.render(state), camera, rng), camera, rng)
        entry[side] = {"file": file, "objects": [box.as_dict() for box in object_boxes(renderer, state)]}
    return entry


def write_poses(folder: Path, seed: int, width: int, baseline: float, entries: list[dict]) -> None:
    """The poses.json of a recording. width: of the panoramas, pixels. baseline: metres, as told to the method."""
    content = {
        "version": VERSION,
        "seed": seed,
        "width": width,
        "height": width // 2,
        "baseline": baseline,
        "pairs": entries,
    }
    (folder / POSES_FILE).write_text(json.dumps(content) + "\n")
