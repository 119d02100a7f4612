"""A room photographed by a rig, as a recording, with the exact boxes of its objects."""

import json
from pathlib import Path

import numpy as np
from numpy.random import Generator

from course_lib.spherical_stereo.detection.colour import Box
from courseware.simulation.room.stereo_recording import POSES_FILE, VERSION, TrueObject
from courseware.simulation.sensors.panorama_renderer import BACKGROUND, PanoramaRenderer
from courseware.simulation.sensors.panorama_rig import PanoramaCameraModel, RigPose, write_photograph


def object_boxes(renderer: PanoramaRenderer, state: np.ndarray) -> list[TrueObject]:
    """The boxes of all objects that show in the picture from `state` `(6,)`, in the order of `room.objects`."""
    numbers = renderer.render_objects(state)
    scale = numbers.shape[1] / renderer.width
    boxes = []
    for number in np.flatnonzero(np.bincount(numbers.ravel(), minlength=BACKGROUND + 1)[:BACKGROUND]):
        visible = numbers == number
        whole = renderer.render_alone(state, int(number)) | visible  # as if nothing stood before it
        label, share = renderer.room.objects[number].label, float(visible.sum() / whole.sum())
        boxes.append(TrueObject(int(number), label, box_around(visible, scale), box_around(whole, scale), share))
    return boxes


def box_entries(renderer: PanoramaRenderer, state: np.ndarray) -> list[dict]:
    """`object_boxes` for JSON, to a hundredth of a pixel."""
    return [
        {
            "object": one.number,
            "label": one.label,
            "visible_box": [round(value, 2) for value in one.visible_box],
            "unoccluded_box": [round(value, 2) for value in one.unoccluded_box],
            "visible_fraction": round(one.visible_fraction, 4),
        }
        for one in object_boxes(renderer, state)
    ]


def box_around(mask: np.ndarray, scale: float = 1.0) -> Box:
    """The narrowest box around the True pixels of a panorama, across the seam too; scale: of the mask."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    width = mask.shape[1]
    # The box leaves out the widest run of empty columns on the circle.
    widest = int(np.argmax(np.diff(columns, append=columns[0] + width)))
    u_min = columns[(widest + 1) % len(columns)]
    u_max = columns[widest] + 1
    if u_max <= u_min:
        u_max += width
    return (float(u_min / scale), float(rows[0] / scale), float(u_max / scale), float((rows[-1] + 1) / scale))


def photograph_pair(
    renderer: PanoramaRenderer, rig: RigPose, folder: Path, name: str, camera: PanoramaCameraModel, rng: Generator
) -> dict:
    """Write both panoramas of a rig, NAME_upper.jpg and NAME_lower.jpg; return their entry of poses.json."""
    entry = {"name": name, "rig": rig.as_dict()}
    for side, state in zip(("upper", "lower"), rig.camera_states(), strict=True):
        file = f"{name}_{side}.jpg"
        write_photograph(folder / file, renderer.render(state), camera, rng)
        entry[side] = {"file": file, "objects": box_entries(renderer, state)}
    return entry


def write_poses(folder: Path, seed: int, width: int, baseline: float, entries: list[dict]) -> None:
    """The poses.json of a recording. width: of the panoramas, pixels. baseline: metres, as told to the method."""
    size = {"width": width, "height": width // 2}
    content = {"version": VERSION, "seed": seed, **size, "baseline": baseline, "pairs": entries}
    (folder / POSES_FILE).write_text(json.dumps(content) + "\n")
