"""What a reader of the commands makes of a file: arrays, numbers and texts by name, so that two can be compared.

Each function takes the path of the file that may be damaged; what belongs to it lies beside it, whole.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from course_lib.classroom.needed_code import needed_code
from course_lib.classroom.submissions import SubmissionError, collect, read_cells
from course_lib.depth_mcl.poses import read_pose
from course_lib.depth_mcl.scene_map import SceneMap
from course_lib.depth_mcl.sequence import read_sequence
from course_lib.fuzzing.samples import NETWORK_INPUT, PANORAMA
from course_lib.spherical_stereo.detection.boxes_file import read_stereo_boxes
from course_lib.spherical_stereo.detection.darknet_cfg import read_cfg
from course_lib.spherical_stereo.detection.detector import YoloDetector
from course_lib.spherical_stereo.panorama import read_panorama
from course_lib.spherical_stereo.recording import read_stereo_recording
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMap

Reading = dict[str, object]
"""By name: an array, a number, a text, None, or a list of such."""


def same(one: object, other: object) -> bool:
    """Whether two readings, or parts of them, are the same to the last bit; NaN is NaN."""
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        equal_nan = one.dtype.kind == "f" and other.dtype.kind == "f"
        return one.shape == other.shape and np.array_equal(one, other, equal_nan=equal_nan)
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(value, other[name]) for name, value in one.items())
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return False
    return one == other


def read_map(path: Path) -> Reading:
    """A mesh, as `localize` reads its map."""
    found = SceneMap.load(path)
    return {"vertices": np.array(found.vertices), "faces": np.array(found.faces)}


def read_recording(path: Path) -> Reading:
    """A depth recording with all its images. path: any file in its folder, or in the depth/ below."""
    found = read_sequence(path.parent.parent if path.parent.name == "depth" else path.parent)
    found.camera()
    return {
        "frames": list(found.frames),
        "files": [file.name for file in found.files],
        "poses": found.camera_to_world if found.has_poses else None,
        "intrinsics": found.intrinsics,
        "times": found.times,
        "up": found.up,
        "path_on_floor": found.path_on_floor,
        "gravity": found.gravity,
        "depth": np.stack([found.depth(index) for index in range(len(found))]),
    }


def read_start(path: Path) -> Reading:
    """One pose, as `localize --start` reads it."""
    return {"pose": read_pose(path)}


def read_picture(path: Path) -> Reading:
    """A panorama, as `locate` and `stereo` read it."""
    return {"pixels": read_panorama(path)}


def read_stereo(path: Path) -> Reading:
    """A folder of stereo panoramas by its poses.json, with all images."""
    found = read_stereo_recording(path.parent)
    return {
        "rig": np.array([found.rig.baseline, found.rig.upper_height]),
        "size": (found.width, found.height),
        "seed": found.seed,
        "names": [pair.name for pair in found.pairs],
        "files": [file.name for pair in found.pairs for file in (pair.upper_file, pair.lower_file)],
        "poses": np.array([pair.pose for pair in found.pairs]),
        "objects": [
            (one.number, one.label, *one.visible_box, *one.unoccluded_box, one.visible_fraction)
            for pair in found.pairs
            for one in (*pair.upper_objects, *pair.lower_objects)
        ],
        "pixels": np.stack([image for pair in found.pairs for image in pair.images()]),
    }


def read_objects(path: Path) -> Reading:
    """A semantic map."""
    found = SemanticMap.load(path)
    return {
        "labels": list(found.labels),
        "positions": np.array(found.positions),
        "hues": np.array(found.hues),
        "saturations": np.array(found.saturations),
        "walls": None if found.walls is None else np.array(found.walls),
        "name": found.name,
    }


def read_boxes(path: Path) -> Reading:
    """Boxes drawn by hand."""
    found = read_stereo_boxes(path)
    items = [*found.upper, *found.lower]
    return {
        "size": (found.width, found.height),
        "counts": (len(found.upper), len(found.lower)),
        "labels": [item.label for item in items],
        "names": [item.name for item in items],
        "boxes": np.array([item.box for item in items]).reshape(-1, 4),
    }


def read_detector(path: Path) -> Reading:
    """A folder with a Darknet network by any of its files, loaded, and run on a picture."""
    found = YoloDetector.load(path.parent)
    sections = read_cfg(path.parent / "net.cfg")
    return {
        "sections": [(section.kind, tuple(section.options.items())) for section in sections],
        **_network_reading(found),
    }


def read_onnx(path: Path) -> Reading:
    """An ONNX network, loaded, and run on a picture."""
    found = YoloDetector.from_onnx(path, path.parent / "net.names", layout="yolov8", input_size=NETWORK_INPUT)
    return _network_reading(found)


def _network_reading(detector: YoloDetector) -> Reading:
    width, height = detector.input_size
    picture = np.linspace(0, 1, 3 * width * height, dtype=np.float32).reshape(1, 3, height, width)
    boxes, scores = detector._network.infer(picture)
    column, row = np.meshgrid(np.arange(PANORAMA[0]), np.arange(PANORAMA[1]))
    panorama = np.stack([column * 2, row * 4, column + row], axis=2).astype(np.uint8)
    return {
        "input": (width, height),
        "labels": detector.labels,
        "threshold": detector.score_threshold,
        "boxes": np.array(boxes),
        "scores": np.array(scores),
        "found": [(one.label, one.score, *one.box) for one in detector.detect(panorama)],
    }


LESSON = "06_likelihood_and_weights"


def read_handed_in(path: Path) -> Reading:
    """What a student handed in, as `grade` reads it, up to where code would run. Raises `SubmissionError`."""
    collection = collect(path.parent.parent, [LESSON])
    for refused in collection.not_read:
        raise SubmissionError(f"{refused.name} {refused.why}")
    if not collection.submissions:
        raise SubmissionError(f"{path} is missing")
    cells = read_cells(collection.submissions[0].path)
    code = needed_code(cells, "weights")
    return {"cells": cells, "needed": [list(cell) for cell in code.cells], "problems": list(code.problems)}
