"""A valid file of each format, small, with the files that belong to it: the same bytes every time."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import trimesh

from course_lib.depth_mcl.sequence import write_sequence
from course_lib.fuzzing.onnx_file import model, node
from course_lib.geometry import optical_pose
from course_lib.spherical_stereo.semantic_map.semantic_map import Landmark, SemanticMap
from course_lib.writing import write_at_once

ROOM = (6.0, 5.0, 3.0)
"""Metres: the room of the meshes, its middle at the zero."""
PANORAMA = (128, 64)
NETWORK_INPUT = (64, 32)
"""(width, height) in pixels of the panoramas and of the small networks' input."""
NETWORK_CLASSES = ("sofa", "chair")

CFG = """[net]
width=64
height=32
channels=3

[convolutional]
batch_normalize=1
filters=4
size=3
stride=2
pad=1
activation=leaky

[maxpool]
size=2
stride=2

[upsample]
stride=2

[route]
layers=-1,-3

[convolutional]  # anchors * (5 + classes)
filters=21
size=1
stride=1
pad=1
activation=linear

[yolo]
mask=0,1,2
anchors=10,14, 23,27, 37,58
classes=2
num=3
"""


def write_samples(folder: Path) -> None:
    """Writes every sample into `folder`, at the places that `formats` names."""
    _write_meshes(folder / "maps")
    _write_recordings(folder)
    _write_panoramas(folder / "panoramas")
    _write_stereo_recording(folder / "stereo")
    _write_semantic_maps(folder / "semantic")
    _write_boxes(folder / "boxes")
    _write_networks(folder)
    _write_notebooks(folder)


def room_mesh() -> trimesh.Trimesh:
    """A room with a table in it, in triangles of about a metre and a half."""
    room = trimesh.creation.box(ROOM).subdivide().subdivide()
    table = trimesh.creation.box((1.2, 0.8, 0.75)).apply_translation((1.5, -1.0, -1.125))
    return trimesh.util.concatenate([room, table])


def _write_meshes(folder: Path) -> None:
    folder.mkdir(parents=True)
    mesh = room_mesh()
    for name in ("room.obj", "room.stl", "room.glb"):
        mesh.export(folder / name)
    mesh.export(folder / "ascii.stl", file_type="stl_ascii")
    coloured = mesh.copy()
    coloured.visual.vertex_colors = np.arange(4 * len(mesh.vertices)).reshape(-1, 4) % 256
    coloured.export(folder / "room.ply", encoding="binary")
    # Squares, as other programs write them: a reader has to cut them.
    corners, squares = _squares()
    points = "\n".join(" ".join(f"{value:.4f}" for value in corner) for corner in corners)
    faces = "\n".join(f"4 {a} {b} {c} {d}" for a, b, c, d in squares)
    header = (
        f"ply\nformat ascii 1.0\ncomment a room in squares\nelement vertex {len(corners)}\nproperty float x\n"
        f"property float y\nproperty float z\nelement face {len(squares)}\nproperty list uchar int vertex_indices\n"
    )
    write_at_once(folder / "ascii.ply", f"{header}end_header\n{points}\n{faces}\n")
    write_at_once(folder / "room.off", f"OFF\n{len(corners)} {len(squares)} 0\n{points}\n{faces}\n")


def _squares() -> tuple[np.ndarray, np.ndarray]:
    """The room's walls, each in four by four squares: corners `(V, 3)`, and of each square four of them `(F, 4)`."""
    corners, squares = [], []
    steps = np.linspace(-0.5, 0.5, 5)
    for axis in range(3):
        for side in (-0.5, 0.5):
            start = len(corners)
            others = [other for other in range(3) if other != axis]
            for a in steps:
                for b in steps:
                    corner = np.zeros(3)
                    corner[axis], corner[others[0]], corner[others[1]] = side, a, b
                    corners.append(corner * ROOM)
            squares += [
                (start + 5 * i + j, start + 5 * i + j + 1, start + 5 * i + j + 6, start + 5 * i + j + 5)
                for i in range(4)
                for j in range(4)
            ]
    return np.array(corners), np.array(squares)


def _write_recordings(folder: Path) -> None:
    """One recording as in 7-Scenes, and one as in the TUM dataset."""
    rng = np.random.default_rng(1)
    states = np.array([[0.1 * step, 0.02 * step, 0.0, 0.01, 0.02 * step, 0.1 * step] for step in range(4)])
    poses = optical_pose(states)
    depths = [1.0 + 0.1 * step + rng.uniform(0, 2, (24, 32)) for step in range(4)]
    for depth in depths:
        depth[2:5, 3:9] = np.nan
    matrix = np.array([[40.0, 0, 15.5], [0, 42.0, 11.5], [0, 0, 1]])
    path = np.column_stack([np.linspace(0, 1, 6), np.zeros(6), np.zeros(6)])
    times = 100.0 + np.arange(4) / 10
    write_sequence(folder / "sequence", matrix, [1, 2, 3, 4], depths, poses, times, "z", path)
    np.savetxt(folder / "sequence" / "gravity.txt", [[frame, 0.1, 9.7, 0.3] for frame in (1, 2, 3, 4)], fmt="%.4f")
    write_sequence(folder / "tum", matrix, [1, 2, 3, 4], depths, poses, times)
    (folder / "tum" / "poses.txt").unlink()
    rows = [f"{time:.4f} depth/{frame:06d}.png\n" for frame, time in enumerate(times, start=1)]
    write_at_once(folder / "tum" / "depth.txt", "# depth maps\n" + "".join(rows))
    (folder / "pose").mkdir()
    np.savetxt(folder / "pose" / "start.txt", poses[1], fmt="%.9f")


def _panorama(shift: int) -> np.ndarray:
    width, height = PANORAMA
    column, row = np.meshgrid(np.arange(width), np.arange(height))
    image = np.stack([(column * 2) % 256, (row * 4) % 256, (column + row) % 256], axis=2)
    image[20 + shift : 40 + shift, 50:70] = (20, 40, 200)
    return image.astype(np.uint8)


def _write_panoramas(folder: Path) -> None:
    folder.mkdir()
    for name in ("upper.png", "upper.jpg"):
        write_at_once(folder / name, cv2.imencode(Path(name).suffix, _panorama(0))[1].tobytes())


def _write_stereo_recording(folder: Path) -> None:
    folder.mkdir()
    pairs = []
    for number in range(2):
        sides = {}
        for side, shift in (("upper", 3), ("lower", 0)):
            file = f"pose_{number}_{side}.png"
            write_at_once(folder / file, cv2.imencode(".png", _panorama(shift))[1].tobytes())
            box = [50.0, 20.0 + shift, 70.0, 40.0 + shift]
            known = {"object": 7, "label": "sofa", "visible_box": box, "unoccluded_box": box, "visible_fraction": 0.9}
            sides[side] = {"file": file, "objects": [known]}
        rig = {"x": 0.5 * number, "y": 0.25, "heading": 0.1 * number, "upper_height": 1.32}
        pairs.append({"name": f"pose_{number}", "rig": rig, **sides})
    width, height = PANORAMA
    content = {"version": 1, "seed": 3, "width": width, "height": height, "baseline": 0.3, "pairs": pairs}
    write_at_once(folder / "poses.json", json.dumps(content, indent=1))


def _write_semantic_maps(folder: Path) -> None:
    folder.mkdir()
    landmarks = [
        Landmark("sofa", 1.5, 0.4, 210.0, 55.0),
        Landmark("chair", -0.75, 2.25, float("nan"), 3.5),
        Landmark("potted plant", 2.0, -1.5, 118.5, 61.25),
        Landmark("table, round", 0.25, -0.5, 30.0, 40.0),
    ]
    walls = np.array([[-3.0, -2.5], [3.0, -2.5], [3.0, 2.5], [-3.0, 2.5]])
    SemanticMap(landmarks, walls, "café").save(folder / "map.json")
    SemanticMap(landmarks).save(folder / "map.csv")


def _write_boxes(folder: Path) -> None:
    folder.mkdir()
    width, height = PANORAMA
    sides = {
        side: [
            {"label": "chair", "box": [30.5, 20.0 + shift, 42.0, 44.0], "name": "chair by the window"},
            {"label": "couch", "box": [120.0, 25.0 + shift, 140.0, 50.0]},
        ]
        for side, shift in (("upper", 2), ("lower", 0))
    }
    write_at_once(
        folder / "boxes.json", json.dumps({"version": 1, "width": width, "height": height, **sides}, indent=1)
    )


def _write_networks(folder: Path) -> None:
    rng = np.random.default_rng(2)
    (folder / "detector").mkdir()
    write_at_once(folder / "detector" / "net.cfg", CFG)
    first = [rng.normal(0, 0.1, 4), rng.uniform(0.5, 1, 4), rng.normal(0, 0.1, 4), rng.uniform(0.5, 1, 4)]
    floats = np.concatenate([*first, rng.normal(0, 0.3, 4 * 27), rng.normal(0, 0.3, 21), rng.normal(0, 0.3, 21 * 8)])
    header = np.array([0, 2, 5, 0, 0], dtype="<i4").tobytes()
    write_at_once(folder / "detector" / "net.weights", header + floats.astype("<f4").tobytes())
    names = "\n".join(NETWORK_CLASSES) + "\n"
    write_at_once(folder / "detector" / "net.names", names)
    write_at_once(folder / "detector" / "training.json", json.dumps({"score_threshold": 0.4, "epochs": 3, "seed": 1}))
    width, height = NETWORK_INPUT
    cells = (width // 8) * (height // 8)
    constants = {
        "kernels": rng.normal(0, 0.2, (6, 3, 8, 8)),
        "biases": rng.normal(0, 0.2, 6),
        "shape": np.array([1, 6, cells], dtype=np.int64),
    }
    nodes = [
        node("Conv", ["image", "kernels", "biases"], "map", kernel_shape=[8, 8], strides=[8, 8]),
        node("Sigmoid", ["map"], "shares"),
        node("Reshape", ["shares", "shape"], "output"),
    ]
    (folder / "onnx").mkdir()
    network = model(nodes, constants, {"image": (1, 3, height, width)}, {"output": (1, 6, cells)})
    write_at_once(folder / "onnx" / "net.onnx", network)
    write_at_once(folder / "onnx" / "net.names", names)


ANSWER = '''"""Weights."""
import numpy as np

BETA = 0.1


def weights(l_normalized, beta=BETA):
    """Equations (10) and (11)."""
    w = np.exp(-((l_normalized - 1) ** 2) / beta**2)
    return w / w.sum()
'''


def _write_notebooks(folder: Path) -> None:
    for part in ("notebook/alice", "python/bob"):
        (folder / part).mkdir(parents=True)
    sources = [
        "%matplotlib inline\nimport numpy as np\n",
        ANSWER,
        "print(weights(np.linspace(0, 1, 5)))\n",
        "x = 1 +\n",
    ]
    cells: list[dict] = [{"cell_type": "markdown", "metadata": {}, "source": ["# Likelihood\n", "and weights\n"]}]
    for number, source in enumerate(sources):
        cells.append(
            {
                "cell_type": "code",
                "execution_count": number,
                "id": f"cell-{number}",
                "metadata": {},
                "outputs": [{"name": "stdout", "output_type": "stream", "text": ["[0. 0. 1.]\n"]}],
                "source": source.splitlines(keepends=True),
            }
        )
    notebook = {"cells": cells, "metadata": {"kernelspec": {"name": "python3"}}, "nbformat": 4, "nbformat_minor": 5}
    path = folder / "notebook" / "alice" / "06_likelihood_and_weights.ipynb"
    write_at_once(path, json.dumps(notebook, indent=1, ensure_ascii=False))
    write_at_once(folder / "python" / "bob" / "06_likelihood_and_weights.py", ANSWER)
