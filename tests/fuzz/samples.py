"""A small valid file of each format that a user hands over, with the files that belong to it, and its public reader."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np
import trimesh

from course_lib.depth_mcl import SceneMap, read_sequence
from course_lib.depth_mcl.sequence import write_sequence
from course_lib.geometry import optical_pose
from course_lib.spherical_stereo import SemanticMap, YoloDetector
from course_lib.spherical_stereo.drawn_boxes import read_stereo_boxes
from course_lib.spherical_stereo.panorama import read_panorama
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark
from courseware.simulation.room.stereo_recording import read_stereo_recording
from tests.spherical_stereo.detection.blob_networks import GREEN, INPUT_SIZE, RED, blob_onnx, panorama, write_darknet

PICTURE = panorama(np.random.default_rng(3), (100, 50, RED), (245, 20, GREEN))
WIDTH, HEIGHT = 256, 128


def read_depth_images(path: Path) -> np.ndarray:
    """All images of a recording. path: any file in its folder, or in the depth/ below."""
    found = read_sequence(path.parent.parent if path.parent.name == "depth" else path.parent)
    found.camera()
    return np.stack([found.depth(index) for index in range(len(found))])


def read_stereo_images(path: Path) -> np.ndarray:
    """All panoramas of a stereo recording, by its poses.json."""
    return np.stack([image for pair in read_stereo_recording(path.parent).pairs for image in pair.images()])


def detect(path: Path) -> list:
    """What a Darknet network, by any of its files, finds on a picture."""
    return YoloDetector.load(path.parent).detect(PICTURE)


def detect_with_onnx(path: Path) -> list:
    """The same of an ONNX network."""
    names = path.parent / "blobs.names"
    return YoloDetector.from_onnx(path, names, layout="yolov8", input_size=INPUT_SIZE).detect(PICTURE)


class Format(NamedTuple):
    """Where the sample lies, what reads it, and what is in it: "text", "json" or "bytes"."""

    file: str
    read: Callable[[Path], object]
    kind: str = "text"


FORMATS = {
    "ply": Format("maps/room.ply", SceneMap.load, "bytes"),
    "ply in text": Format("maps/ascii.ply", SceneMap.load),
    "obj": Format("maps/room.obj", SceneMap.load),
    "stl": Format("maps/room.stl", SceneMap.load, "bytes"),
    "stl in text": Format("maps/ascii.stl", SceneMap.load),
    "off": Format("maps/room.off", SceneMap.load),
    "depth image": Format("sequence/depth/000002.png", read_depth_images, "bytes"),
    "poses": Format("sequence/poses.txt", read_depth_images),
    "intrinsics": Format("sequence/intrinsics.txt", read_depth_images),
    "up": Format("sequence/up.txt", read_depth_images),
    "gravity": Format("sequence/gravity.txt", read_depth_images),
    "path on the floor": Format("sequence/path_on_floor.txt", read_depth_images),
    "TUM trajectory": Format("tum/groundtruth.txt", read_depth_images),
    "TUM images": Format("tum/depth.txt", read_depth_images),
    "panorama, PNG": Format("panoramas/upper.png", lambda path: read_panorama(path).image, "bytes"),
    "panorama, JPEG": Format("panoramas/upper.jpg", lambda path: read_panorama(path).image, "bytes"),
    "stereo recording": Format("stereo/poses.json", read_stereo_images, "json"),
    "semantic map": Format("semantic/map.json", SemanticMap.load, "json"),
    "semantic map, CSV": Format("semantic/map.csv", SemanticMap.load),
    "boxes": Format("boxes/boxes.json", read_stereo_boxes, "json"),
    "cfg": Format("detector/blobs.cfg", detect),
    "weights": Format("detector/blobs.weights", detect, "bytes"),
    "names": Format("detector/blobs.names", detect),
    "training": Format("detector/training.json", detect, "json"),
    "onnx": Format("onnx/blobs.onnx", detect_with_onnx, "bytes"),
}


def write_samples(folder: Path) -> None:
    """Write every sample below `folder`: the same bytes every time."""
    for name in {Path(one.file).parts[0] for one in FORMATS.values()}:
        (folder / name).mkdir(parents=True)
    _write_meshes(folder / "maps")
    _write_recordings(folder)
    _write_panoramas(folder)
    landmarks = [Landmark("sofa", 1.5, 0.4, 210.0, 55.0), Landmark("chair", -0.75, 2.25, float("nan"), 3.5)]
    landmarks += [Landmark("table, round", 0.25, -0.5, 30.0, 40.0)]
    walls = np.array([[-3.0, -2.5], [3.0, -2.5], [3.0, 2.5], [-3.0, 2.5]])
    SemanticMap(landmarks, walls, "café").save(folder / "semantic" / "map.json")
    SemanticMap(landmarks).save(folder / "semantic" / "map.csv")
    write_darknet(folder / "detector")
    (folder / "detector" / "training.json").write_text(json.dumps({"score_threshold": 0.4, "epochs": 3, "seed": 1}))
    write_darknet(folder / "onnx")
    (folder / "onnx" / "blobs.onnx").write_bytes(blob_onnx())


def _write_meshes(folder: Path) -> None:
    """A room of 6 x 5 x 3 m: eight corners, six walls; in text as squares, which a reader has to cut."""
    corners = np.array([[x, y, z] for x in (-3.0, 3.0) for y in (-2.5, 2.5) for z in (-1.5, 1.5)])
    walls = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    mesh = trimesh.Trimesh(corners, np.concatenate([walls[:, [0, 1, 2]], walls[:, [0, 2, 3]]]), process=False)
    for name in ("room.obj", "room.stl", "room.ply"):
        mesh.export(folder / name)
    mesh.export(folder / "ascii.stl", file_type="stl_ascii")
    rows = [" ".join(f"{value:.4f}" for value in corner) for corner in corners]
    rows += [f"4 {a} {b} {c} {d}" for a, b, c, d in walls]
    coordinates = "".join(f"property float {axis}\n" for axis in "xyz")
    header = f"ply\nformat ascii 1.0\ncomment a room in squares\nelement vertex 8\n{coordinates}element face 6\n"
    header += "property list uchar int vertex_indices\nend_header\n"
    (folder / "ascii.ply").write_text(header + "\n".join(rows) + "\n")
    (folder / "room.off").write_text("OFF\n8 6 0\n" + "\n".join(rows) + "\n")


def _write_recordings(folder: Path) -> None:
    """One recording as in 7-Scenes, and one as in the TUM dataset."""
    poses = optical_pose(np.array([[0.1 * step, 0.02 * step, 0.0, 0.01, 0.02, 0.1 * step] for step in range(3)]))
    depths = [1.0 + np.random.default_rng(step).uniform(0, 2, (12, 16)) for step in range(3)]
    depths[1][2:5, 3:9] = np.nan
    matrix = np.array([[20.0, 0, 7.5], [0, 21.0, 5.5], [0, 0, 1]])
    path = np.column_stack([np.linspace(0, 1, 6), np.zeros(6), np.zeros(6)])
    times = 100.0 + np.arange(3) / 10
    write_sequence(folder / "sequence", matrix, [1, 2, 3], depths, poses, times, "z", path)
    np.savetxt(folder / "sequence" / "gravity.txt", [[frame, 0.1, 9.7, 0.3] for frame in (1, 2, 3)], fmt="%.4f")
    write_sequence(folder / "tum", matrix, [1, 2, 3], depths, poses, times)
    (folder / "tum" / "poses.txt").unlink()
    rows = [f"{time:.4f} depth/{frame:06d}.png\n" for frame, time in enumerate(times, start=1)]
    (folder / "tum" / "depth.txt").write_text("# depth maps\n" + "".join(rows))


def _write_panoramas(folder: Path) -> None:
    sides = {}
    for side, shift in (("upper", 3), ("lower", 0)):
        cv2.imwrite(str(folder / "panoramas" / f"{side}.jpg"), PICTURE)
        for name in ("panoramas", "stereo"):
            cv2.imwrite(str(folder / name / f"{side}.png"), np.roll(PICTURE, shift, axis=0))
        box = [50.0, 20.0 + shift, 70.0, 40.0 + shift]
        known = {"object": 7, "label": "sofa", "visible_box": box, "unoccluded_box": box, "visible_fraction": 0.9}
        sides[side] = {"file": f"{side}.png", "objects": [known]}
    size = {"version": 1, "width": WIDTH, "height": HEIGHT}
    rig = {"x": 0.5, "y": 0.25, "heading": 0.1, "upper_height": 1.32}
    stereo = size | {"seed": 3, "baseline": 0.3, "pairs": [{"name": "pose_0", "rig": rig, **sides}]}
    chair = {"label": "chair", "box": [30.5, 20.0, 42.0, 44.0], "name": "chair by the window"}
    boxes = size | {"upper": [chair], "lower": [chair, {"label": "couch", "box": [240.0, 25.0, 270.0, 50.0]}]}
    (folder / "stereo" / "poses.json").write_text(json.dumps(stereo, indent=1))
    (folder / "boxes" / "boxes.json").write_text(json.dumps(boxes, indent=1))
