"""The formats that a user hands over: where the sample lies, which reader takes it, and which errors that one names."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from course_lib.classroom.submissions import SubmissionError
from course_lib.depth_mcl.poses import SequenceError
from course_lib.depth_mcl.scene_map import SceneMapError
from course_lib.fuzzing import explanations, readings
from course_lib.fuzzing.mesh_explanation import of_map
from course_lib.fuzzing.readings import Reading
from course_lib.spherical_stereo.detection.boxes import DetectionError
from course_lib.spherical_stereo.detection.darknet_cfg import DetectorError
from course_lib.spherical_stereo.panorama import PanoramaError
from course_lib.spherical_stereo.semantic_map.semantic_map import SemanticMapError


@dataclass(frozen=True)
class Format:
    """One format."""

    name: str
    """As in `--formats`."""
    file: str
    """The sample, below the folder of samples."""
    traits: frozenset[str]
    """What is in it, which decides what can be done to it: text, numbers, json, ply, png, floats, ..."""
    read: Callable[[Path], Reading]
    """The commands' own reader."""
    errors: tuple[type[Exception], ...]
    """Those that its documentation names."""
    explain: Callable[[bytes | None, Reading, Reading], str | None]
    """Why a changed result is right; None: it is not (`explanations`)."""
    slow: bool = False
    """Its reader starts a process of its own: fewer files of it are tried."""


def _format(name: str, file: str, traits: str, read: Callable, errors: object, explain: Callable) -> Format:
    """errors: an error, or several; what is missing may always be told as `FileNotFoundError`."""
    kinds = errors if isinstance(errors, tuple) else (errors,)
    words = frozenset(traits.split())
    return Format(name, file, words - {"slow"}, read, (*kinds, FileNotFoundError), explain, "slow" in words)


def _map(name: str, file: str, traits: str) -> Format:
    kind = Path(file).suffix[1:]
    return _format(name, f"maps/{file}", traits, readings.read_map, SceneMapError, partial(of_map, kind=kind))


def _recording(name: str, file: str, traits: str, explain: Callable) -> Format:
    return _format(name, file, traits, readings.read_recording, SequenceError, explain)


def _detector(name: str, file: str, traits: str, explain: Callable) -> Format:
    return _format(name, f"detector/{file}", traits, readings.read_detector, DetectorError, explain)


FORMATS: dict[str, Format] = {
    one.name: one
    for one in (
        _map("ply", "room.ply", "ply floats"),
        _map("ply-ascii", "ascii.ply", "text numbers ply"),
        _map("obj", "room.obj", "text numbers"),
        _map("stl", "room.stl", "stl floats"),
        _map("stl-ascii", "ascii.stl", "text numbers"),
        _map("glb", "room.glb", "glb floats slow"),
        _map("off", "room.off", "text numbers"),
        _recording("depth-png", "sequence/depth/000002.png", "png", explanations.of_depth_image),
        _recording("poses", "sequence/poses.txt", "text numbers", explanations.optional(explanations.of_poses)),
        _recording("intrinsics", "sequence/intrinsics.txt", "text numbers", explanations.of_intrinsics),
        _recording("up", "sequence/up.txt", "text", explanations.optional(explanations.of_up)),
        _recording(
            "gravity", "sequence/gravity.txt", "text numbers", explanations.optional(explanations.of_numbers("gravity"))
        ),
        _recording(
            "floor",
            "sequence/path_on_floor.txt",
            "text numbers",
            explanations.optional(explanations.of_numbers("path_on_floor")),
        ),
        _recording(
            "times", "sequence/groundtruth.txt", "text numbers", explanations.optional(explanations.of_trajectory)
        ),
        _recording("tum", "tum/groundtruth.txt", "text numbers", explanations.optional(explanations.of_trajectory)),
        _recording("tum-images", "tum/depth.txt", "text numbers", explanations.optional(explanations.of_image_list)),
        _format("start", "pose/start.txt", "text numbers", readings.read_start, SequenceError, explanations.of_start),
        _format(
            "panorama-png", "panoramas/upper.png", "png", readings.read_picture, PanoramaError, explanations.of_picture
        ),
        _format(
            "panorama-jpeg",
            "panoramas/upper.jpg",
            "jpeg",
            readings.read_picture,
            PanoramaError,
            explanations.of_picture,
        ),
        _format(
            "stereo", "stereo/poses.json", "text json", readings.read_stereo, PanoramaError, explanations.of_stereo
        ),
        _format(
            "semantic-json",
            "semantic/map.json",
            "text json",
            readings.read_objects,
            SemanticMapError,
            explanations.of_objects_json,
        ),
        _format(
            "semantic-csv",
            "semantic/map.csv",
            "text numbers",
            readings.read_objects,
            SemanticMapError,
            explanations.of_objects_csv,
        ),
        _format("boxes", "boxes/boxes.json", "text json", readings.read_boxes, DetectionError, explanations.of_boxes),
        _detector("cfg", "net.cfg", "text numbers", explanations.of_cfg),
        _detector("weights", "net.weights", "floats", explanations.of_weights),
        _detector("names", "net.names", "text", explanations.of_names),
        _detector("training", "training.json", "text json", explanations.optional(explanations.of_training)),
        _format("onnx", "onnx/net.onnx", "onnx floats slow", readings.read_onnx, DetectorError, explanations.of_onnx),
        _format(
            "notebook",
            f"notebook/alice/{readings.LESSON}.ipynb",
            "text json",
            readings.read_handed_in,
            SubmissionError,
            explanations.of_notebook,
        ),
        _format(
            "python",
            f"python/bob/{readings.LESSON}.py",
            "text",
            readings.read_handed_in,
            SubmissionError,
            explanations.of_python,
        ),
    )
}
"""By name, in the order of the table."""
